"""The viewer's page in headless Chromium: it loads without errors, plays, and answers keys and clicks."""

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.wait import WebDriverWait
from tests.oracle.browser import Page, chromium, logged
from tests.oracle.viewing import COLLIDING, CORRIDOR, HOSTILE, SVG, picture_of

from carp_reference import plan
from carp_spec import Carp, Instance, Plan, Robot, Solution, Visit, read_instance, read_solution
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.viewer.page import page
from carproof.viewer.stills import map_still

LATER = 30
CHART_IS_DRAWN = "return document.getElementById('chart').width > 400"


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chrome]:
    with chromium(tmp_path_factory.mktemp("profile")) as started:
        yield started


def opened(driver: Chrome, folder: Path, instance: Instance, solution: Solution, width: int = 1280) -> Page:
    file = folder / "page.html"
    file.write_bytes(page(instance, solution, "town.json"))
    return Page(driver, file, width)


@pytest.fixture
def collision(driver: Chrome, tmp_path: Path) -> Page:
    """Robots r1 and r2 in a corridor; r1 runs into r2 at tick 1 in b and at tick 2 in c."""
    instance, solution = json.dumps(CORRIDOR).encode(), json.dumps(COLLIDING).encode()
    return opened(driver, tmp_path, read_instance(instance), read_solution(solution))


@pytest.fixture(scope="module")
def town() -> tuple[Instance, Solution]:
    """A hundred robots on 20 x 20 cells, some with room for two."""
    instance = grid_instance(Grid(), Fleet(robots=100), Traits(capacity=Range(1, 2), duration=Range(1, 2)))
    return instance, plan(instance, Carp())


def wait_for(shown: Page, body: str) -> None:
    WebDriverWait(shown.driver, LATER).until(lambda _: shown.script(body))


def requests(driver: Chrome) -> list[str]:
    events = [json.loads(message)["message"] for message in logged(driver, "performance")]
    return [each["params"]["request"]["url"] for each in events if each["method"] == "Network.requestWillBeSent"]


def test_the_page_loads_without_complaint_and_asks_for_nothing_else(
    driver: Chrome, tmp_path: Path, town: tuple[Instance, Solution]
) -> None:
    shown = opened(driver, tmp_path, *town)
    assert shown.text("verdict") == "✓ no rule is broken"
    assert shown.count("#robots button") == 100
    assert logged(driver, "browser") == []
    assert {url.partition(":")[0] for url in requests(driver)} <= {"file", "data"}


def test_the_page_and_the_still_agree_at_every_tick(
    driver: Chrome, tmp_path: Path, town: tuple[Instance, Solution]
) -> None:
    shown = opened(driver, tmp_path, *town)
    for tick in (0, 1, 7, 15):
        still = picture_of(map_still(*town, tick, "town").decode())
        expected = {each.findtext(f"{SVG}title"): each.get("transform", "").replace("e-2", "") for each in still[-1]}
        drawn = shown.robots()
        assert {name: places(at) for name, at in drawn.items()} == {
            name: places(at, percent=True) for name, at in expected.items()
        }
        shown.script("document.getElementById('forward').click()")
        for _ in range({0: 0, 1: 5, 7: 7, 15: 0}[tick]):
            shown.script("document.getElementById('forward').click()")


def places(transform: str, *, percent: bool = False) -> tuple[float, ...]:
    x, y, scale = transform.replace("translate(", "").replace("scale(", "").replace(")", "").split()
    return float(x), float(y), float(scale) / (100 if percent else 1)


def slider(shown: Page) -> int:
    return int(shown.script("return document.getElementById('slider').value"))


def test_it_plays_and_pauses_by_key_and_robots_move_between_resources(
    driver: Chrome, tmp_path: Path, town: tuple[Instance, Solution]
) -> None:
    shown = opened(driver, tmp_path, *town)
    before = shown.robots()
    shown.press(Keys.SPACE)
    assert shown.text("play") == "Pause"
    wait_for(shown, "return document.getElementById('slider').value >= 1")
    assert shown.robots() != before
    shown.press(Keys.SPACE)
    assert shown.text("play") == "Play"
    stopped = slider(shown), shown.robots()
    assert (slider(shown), shown.robots()) == stopped


def test_it_stops_at_the_end_and_begins_anew(driver: Chrome, tmp_path: Path, town: tuple[Instance, Solution]) -> None:
    shown = opened(driver, tmp_path, *town)
    shown.press("+", "+", "+", "+", "+", "+", Keys.SPACE)
    wait_for(shown, "return document.getElementById('play').textContent === 'Play'")
    last = slider(shown)
    assert shown.tick == f"tick {last} of {last}"
    shown.press("-", "-", "-", "-", "-", "-", Keys.SPACE)
    assert shown.text("play") == "Pause"
    assert slider(shown) < last


def test_keys_step_jump_and_change_the_speed(collision: Page) -> None:
    seen = []
    for keys in ([Keys.ARROW_RIGHT], [Keys.ARROW_RIGHT, Keys.ARROW_LEFT], [Keys.END], [Keys.ARROW_RIGHT], [Keys.HOME]):
        collision.press(*keys)
        seen.append(collision.tick)
    assert seen == [f"tick {tick} of 5" for tick in (1, 1, 5, 5, 0)]
    collision.press("+")
    assert collision.text("speed") == "2 ticks/s"
    collision.press("-", "-")
    assert collision.text("speed") == "0.5 ticks/s"


def test_a_key_works_after_an_entry_was_clicked(collision: Page) -> None:
    collision.click("#robots button", "r1")
    collision.press(Keys.SPACE)
    assert collision.text("play") == "Pause"


def test_a_planted_collision_is_counted_listed_and_marked_at_its_tick(collision: Page) -> None:
    assert collision.text("verdict") == "✗ 2 violations"
    assert collision.text("violations").startswith("joint/capacity 2\nAt no tick do more robots")
    marks = []
    for _ in range(4):
        marks.append((collision.count(".map .marks .violation"), collision.count(".robot.blamed")))
        collision.press(Keys.ARROW_RIGHT)
    assert marks == [(0, 0), (1, 2), (1, 2), (0, 0)]
    assert collision.robots()


def test_a_click_on_a_violation_goes_to_its_tick_and_robots(collision: Page) -> None:
    collision.click("#violations button", "resource c")
    assert collision.tick == "tick 2 of 5"
    assert [each[:2] for each in collision.chosen("robots")] == ["r1", "r2"]
    assert collision.text("about").startswith("joint/capacity: resource c in [2,3): robots r1, r2")
    assert collision.count(".robot.chosen") == 2
    collision.press("n")
    assert collision.tick == "tick 1 of 5"


def test_a_click_on_a_robot_chooses_it_in_map_list_and_chart(collision: Page) -> None:
    collision.press(Keys.END, Keys.ARROW_LEFT)
    assert list(collision.robots()) == ["r2"]
    collision.click("#robots button", "r1")
    assert collision.tick == "tick 0 of 5"
    assert collision.text("about") == "robot r1: released at 0, arrives at 2, cost 2, now in a [0, 1)"
    assert collision.count(".map .trail path") == 2
    collision.script("document.querySelectorAll('.map .robot')[1].dispatchEvent(new Event('click', {bubbles: true}))")
    assert [each[:2] for each in collision.chosen("robots")] == ["r2"]
    collision.press(Keys.ESCAPE)
    assert collision.chosen("robots") == []


def test_a_click_in_the_chart_goes_to_its_tick_and_robot(collision: Page) -> None:
    wait_for(collision, CHART_IS_DRAWN)
    collision.script(
        "const box = document.getElementById('chart').getBoundingClientRect();"
        "const width = (box.width - 86) / 6;"
        "document.getElementById('chart').dispatchEvent(new MouseEvent('click',"
        "{clientX: box.x + 78 + 3.5 * width, clientY: box.y + 22 + 4 * 17 + 2 * 13 - 12, bubbles: true}))"
    )
    assert collision.tick == "tick 3 of 5"
    assert [each[:2] for each in collision.chosen("robots")] == ["r2"]


def test_the_chart_draws_windows_stays_and_violations(collision: Page) -> None:
    wait_for(collision, CHART_IS_DRAWN)
    colours = set(
        collision.script(
            "const canvas = document.getElementById('chart');"
            "const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;"
            "const seen = new Set();"
            "for (let at = 0; at < data.length; at += 4) seen.add(`${data[at]},${data[at + 1]},${data[at + 2]}`);"
            "return [...seen]"
        )
    )
    window, first, second, wrong = "220,235,220", "0,114,178", "230,159,0", "193,18,31"
    assert {window, first, second, wrong} <= colours


def test_robots_are_found_by_name(collision: Page) -> None:
    collision.click("#find")
    collision.press("2")
    assert collision.script("return document.querySelectorAll('#robots button:not([hidden])').length") == 1
    collision.press(Keys.SPACE)
    assert collision.text("play") == "Play"


def test_robots_without_a_plan_are_listed_first(driver: Chrome, tmp_path: Path) -> None:
    solution = Solution((Plan("r1", (Visit("a", 0, 1), Visit("b", 1, 2), Visit("c", 2, 3))),), ("r1",), ("r2",))
    shown = opened(driver, tmp_path, read_instance(json.dumps(CORRIDOR).encode()), solution)
    assert shown.text("facts").startswith("2 robots, 1 unplanned")
    assert shown.text("robots").splitlines()[:2] == ["without a plan 1", "r2 b → e · unplanned"]


def test_hostile_ids_are_only_text(driver: Chrome, tmp_path: Path) -> None:
    instance = read_instance(json.dumps(CORRIDOR).encode())
    instance = Instance(instance.graph, (Robot(HOSTILE, "a", "b"),))
    shown = opened(driver, tmp_path, instance, Solution((Plan(HOSTILE, (Visit("b", 0, 1),)),), (HOSTILE,)))
    assert "<script>alert('1')" in shown.text("robots")
    assert logged(driver, "browser") == []


def test_a_narrow_screen_needs_no_scrolling_sideways(
    driver: Chrome, tmp_path: Path, town: tuple[Instance, Solution]
) -> None:
    shown = opened(driver, tmp_path, *town, width=380)
    assert shown.script("return document.documentElement.scrollWidth") <= 380
    assert logged(driver, "browser") == []
