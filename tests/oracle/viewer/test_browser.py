"""The viewer's page in headless Chromium: it loads without errors, plays, and answers keys and clicks."""

import json
import re
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import TypeAlias

import pytest
from selenium.webdriver import Chrome
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.wait import WebDriverWait
from tests.oracle.viewer.browser import Page, chromium, logged, processor_seconds
from tests.oracle.viewer.viewing import COLLIDING, CORRIDOR, HOSTILE, SVG, picture_of, plant

from carp_reference import plan
from carp_spec import Carp, Instance, Plan, Resource, ResourceGraph, Robot, Solution, Visit
from carproof import Settings, Trace, import_layout, read_instance, read_solution
from carproof.generate import Fleet, Grid, Range, Traits, grid_instance
from carproof.viewer.map_picture import ROBOT_RADIUS
from carproof.viewer.page import view
from carproof.viewer.stills import view_map

LATER = 30
READABLE = 8
"""The least height of a name, in pixels."""
FEWEST_FRAMES = 30
FRAMES = 30
CHART_IS_DRAWN = "return document.getElementById('chart').width > 400"


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Chrome]:
    with chromium(tmp_path_factory.mktemp("profile")) as started:
        yield started


Case: TypeAlias = tuple[Instance, Solution]
Opener: TypeAlias = Callable[..., Page]


@pytest.fixture
def opened(driver: Chrome, tmp_path: Path) -> Opener:
    """Open the page of an instance and, if given, its plans."""

    def open_page(*shown: object, width: int = 1280, trace: Trace | None = None) -> Page:
        (tmp_path / "page.html").write_bytes(view(*shown, title="town.json", trace=trace))  # type: ignore[arg-type]
        return Page(driver, tmp_path / "page.html", width)

    return open_page


@pytest.fixture
def collision(opened: Opener) -> Page:
    """Robots r1 and r2 in a corridor; r1 runs into r2 at tick 1 in b and at tick 2 in c."""
    instance, solution = json.dumps(CORRIDOR).encode(), json.dumps(COLLIDING).encode()
    return opened(read_instance(instance), read_solution(solution))


@pytest.fixture(scope="module")
def town() -> Case:
    """A hundred robots on 20 x 20 cells, some with room for two."""
    instance = grid_instance(Grid(), Fleet(robots=100), Traits(capacity=Range(1, 2), duration=Range(1, 2)))
    return instance, plan(instance, Carp())


@pytest.fixture(scope="module")
def warehouse() -> Case:
    """450 robots on 120 x 30 cells, fifteen in a row, that drive a hundred cells to the right one behind the other."""
    resources = tuple(Resource(f"{x},{y}", x=x, y=y) for y in range(30) for x in range(120))
    edges = tuple((f"{x},{y}", f"{x + 1},{y}") for y in range(30) for x in range(119))
    starts = [(x, y) for y in range(30) for x in range(15)]
    robots = tuple(Robot(f"r{at}", f"{x},{y}", f"{x + 100},{y}") for at, (x, y) in enumerate(starts))
    instance = Instance(ResourceGraph(resources, edges), robots)
    plans = [
        Plan(f"r{at}", tuple(Visit(f"{x + tick},{y}", tick, tick + 1) for tick in range(101)))
        for at, (x, y) in enumerate(starts)
    ]
    return instance, Solution.of(instance, plans)


def moving_at_once(grid: Grid, *moves: tuple[str, str]) -> Case:
    """A robot for each move, which it makes at tick 1."""
    robots = tuple(Robot(f"r{at}", *ends) for at, ends in enumerate(moves, start=1))
    instance = Instance(grid_instance(grid).graph, robots)
    plans = [Plan(each.id, (Visit(each.start, 0, 1), Visit(each.goal, 1, 2))) for each in robots]
    return instance, Solution.of(instance, plans)


def wait_for(shown: Page, body: str) -> None:
    WebDriverWait(shown.driver, LATER).until(lambda _: shown.script(body))


def requests(driver: Chrome) -> list[str]:
    events = [json.loads(message)["message"] for message in logged(driver, "performance")]
    return [each["params"]["request"]["url"] for each in events if each["method"] == "Network.requestWillBeSent"]


def test_the_page_loads_without_complaint_and_asks_for_nothing_else(opened: Opener, town: Case) -> None:
    shown = opened(*town)
    assert shown.text("verdict") == "✓ no rule is broken"
    assert shown.count("#robots button") == 100
    assert logged(shown.driver, "browser") == []
    assert {url.partition(":")[0] for url in requests(shown.driver)} <= {"file", "data"}


def test_the_page_and_the_still_agree_at_every_tick(opened: Opener, town: Case) -> None:
    shown = opened(*town)
    for tick in (0, 1, 7, 15):
        still = picture_of(view_map(*town, at=tick, title="town").decode())
        assert shown.robots() == {each.findtext(f"{SVG}title"): placed(each.get("transform", "")) for each in still[-1]}
        shown.script("document.getElementById('forward').click()")
        for _ in range({0: 0, 1: 5, 7: 7, 15: 0}[tick]):
            shown.script("document.getElementById('forward').click()")


def test_the_page_and_the_still_agree_on_a_plant(opened: Opener) -> None:
    shown = opened(*plant())
    for tick in range(14):
        still = picture_of(view_map(*plant(), at=tick, title="plant").decode())
        (drawn,) = shown.robots().values()
        assert drawn == pytest.approx(placed(still[-1][0].get("transform", "")), abs=1)
        shown.script("document.getElementById('forward').click()")
    assert logged(shown.driver, "browser") == []


def test_names_of_a_plant_are_readable_where_it_is_drawn_small_and_none_is_over_another(opened: Opener) -> None:
    shown = opened(*row_of_bays(24))
    boxes = shown.script(
        "return [...document.querySelectorAll('.point-name')].map((name) => name.getBoundingClientRect())"
        ".map((box) => [box.left, box.right, box.height])"
    )
    assert len(boxes) == 24
    assert all(height > READABLE for _, _, height in boxes)
    assert all(one[1] <= other[0] for one, other in pairwise(sorted(boxes)))


def row_of_bays(count: int) -> Case:
    """Points in a row, with a lane from each to the next."""
    nodes = [{"id": f"bay-{number}", "x": 4 * number, "y": number % 2} for number in range(count)]
    links = [{"source": f"bay-{number}", "target": f"bay-{number + 1}"} for number in range(count - 1)]
    row = json.dumps({"directed": True, "nodes": nodes, "links": links})
    return import_layout(row.encode(), settings=Settings(robots=0)).instance, Solution((), ())


def placed(transform: str) -> tuple[float, ...]:
    """The place and the radius of a robot in a still."""
    x, y, hundredths, _ = map(int, re.findall(r"-?\d+", transform))
    return x, y, hundredths / ROBOT_RADIUS


def slider(shown: Page) -> int:
    return int(shown.script("return document.getElementById('slider').value"))


def test_it_plays_and_pauses_by_key_and_robots_move_between_resources(opened: Opener, town: Case) -> None:
    shown = opened(*town)
    before = shown.robots()
    shown.press(Keys.SPACE)
    assert shown.text("play") == "Pause"
    wait_for(shown, "return document.getElementById('slider').value >= 1")
    assert shown.robots() != before
    shown.press(Keys.SPACE)
    assert shown.text("play") == "Play"
    stopped = slider(shown), shown.robots()
    assert (slider(shown), shown.robots()) == stopped


def test_it_stops_at_the_end_and_begins_anew(opened: Opener, town: Case) -> None:
    shown = opened(*town)
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


def test_a_planted_collision_is_counted_listed_and_marked_at_its_tick(collision: Page) -> None:
    assert collision.text("verdict") == "✗ 2 violations"
    assert collision.text("violations").startswith("joint/capacity 2\nAt no tick do more robots")
    marks = []
    for _ in range(4):
        marks.append((collision.number("viewer.map.broken.length"), collision.number("viewer.map.blamed.size")))
        collision.press(Keys.ARROW_RIGHT)
    assert marks == [(0, 0), (1, 2), (1, 2), (0, 0)]
    assert collision.robots()


def test_both_resources_of_an_exchange_are_red_while_robots_pass_each_other(opened: Opener) -> None:
    shown = opened(*moving_at_once(Grid(2, 1), ("0,0", "1,0"), ("1,0", "0,0")))

    def red(time: float) -> object:
        shown.script(f"viewer.clock.set({time})")
        return shown.number("[...new Set(viewer.map.broken.flatMap((each) => each.places))].sort()")

    assert [red(time) for time in (0, 0.5, 1, 1.5, 2)] == [[], [0, 1], [0, 1], [0, 1], []]


def test_a_click_on_a_violation_goes_to_its_tick_and_robots(collision: Page) -> None:
    collision.click("#violations button", "resource c")
    assert collision.tick == "tick 2 of 5"
    assert [each[:2] for each in collision.chosen("robots")] == ["r1", "r2"]
    assert collision.text("about").startswith("joint/capacity: resource c in [2,3): robots r1, r2")
    assert collision.number("viewer.map.chosen") == [0, 1]
    collision.press("n")
    assert collision.tick == "tick 1 of 5"


def test_a_click_on_a_robot_chooses_it_in_map_list_and_chart(collision: Page) -> None:
    collision.press(Keys.END, Keys.ARROW_LEFT)
    assert list(collision.robots()) == ["r2"]
    collision.click("#robots button", "r1")
    assert collision.tick == "tick 0 of 5"
    assert collision.text("about") == "robot r1: released at 0, arrives at 2, cost 2, now in a [0, 1)"
    at_robot(collision, "r2", "pointerdown", "pointerup")
    assert [each[:2] for each in collision.chosen("robots")] == ["r2"]
    collision.press(Keys.ESCAPE)
    assert collision.chosen("robots") == []


def at_robot(shown: Page, name: str, *events: str, right: int = 0) -> None:
    """Dispatch pointer events where the map shows a robot, and the last of them some pixels to the right of it."""
    x, y, _ = shown.robots()[name]
    for event in events:
        shown.script(
            "const [kind, x, y] = arguments, { map } = viewer, { left, top } = map.view.getBoundingClientRect();"
            "map.view.dispatchEvent(new PointerEvent(kind, { pointerId: 1, clientX: left + x, clientY: top + y }))",
            event,
            shown.number(f"viewer.map.px({x})") + (0 if event == events[0] else right),
            shown.number(f"viewer.map.py({y})"),
        )


VIEW = "[viewer.map.x, viewer.map.y, viewer.map.scale]"


def test_choosing_a_robot_zooms_to_it_and_keeps_it_in_sight(opened: Opener, warehouse: Case) -> None:
    shown = opened(*warehouse)
    assert shown.number("viewer.map.isWhole")
    small = shown.number("viewer.map.scale")
    shown.script("document.querySelectorAll('#robots button')[7].click()")
    assert shown.number("viewer.map.scale") > 2 * small
    for _ in range(12):
        shown.press(Keys.ARROW_RIGHT)
        x, y, _ = shown.robots()["r7"]
        at = shown.number(f"[viewer.map.px({x}), viewer.map.py({y}), viewer.map.size.width, viewer.map.size.height]")
        assert 0 <= at[0] <= at[2]
        assert 0 <= at[1] <= at[3]
    shown.press("0")
    assert shown.number("viewer.map.scale") == small


def test_the_map_moves_by_dragging_and_keys_and_zooms_by_wheel_pinch_and_keys(opened: Opener, warehouse: Case) -> None:
    shown = opened(*warehouse)
    views = [shown.number(VIEW)]
    shown.press("i", "i", "i")
    views.append(shown.number(VIEW))
    assert views[-1][2] == pytest.approx(views[0][2] * 1.5**3)
    at_robot(shown, "r1", "pointerdown", "pointermove", "pointerup", right=-60)
    views.append(shown.number(VIEW))
    assert shown.number("viewer.map.chosen") == []
    assert views[-1][0] == pytest.approx(views[-2][0] + 60 / views[-2][2])
    shown.press("a", "w")
    assert shown.number(VIEW)[0] < views[-1][0]
    shown.press("o")
    assert shown.number(VIEW)[2] == pytest.approx(views[-1][2] / 1.5)
    before = shown.number(VIEW)[2]
    shown.script("viewer.map.view.dispatchEvent(new WheelEvent('wheel', { deltaY: -100, clientX: 300, clientY: 200 }))")
    wheeled = shown.number(VIEW)[2]
    assert wheeled > before
    for kind, pointer, x in (("down", 1, 300), ("down", 2, 400), ("move", 2, 500), ("up", 1, 300), ("up", 2, 500)):
        shown.script(
            "viewer.map.view.dispatchEvent(new PointerEvent(arguments[0],"
            "{ pointerId: arguments[1], clientX: arguments[2], clientY: 200 }))",
            f"pointer{kind}",
            pointer,
            x,
        )
    assert shown.number(VIEW)[2] == pytest.approx(min(4, 2 * wheeled))


def test_an_instance_alone_is_a_map_without_a_clock(opened: Opener, town: Case) -> None:
    shown = opened(town[0])
    assert shown.text("verdict") == "an instance without plans"
    assert shown.script("return document.querySelector('footer').clientHeight") == 0
    assert shown.count("#robots button") == 100
    assert logged(shown.driver, "browser") == []


def test_robots_are_where_the_trace_says_and_rings_where_they_were_to_be(opened: Opener) -> None:
    instance, solution = moving_at_once(Grid(2, 2), *pairwise(["0,0", "1,0", "1,1", "0,1", "0,0"]))
    happened = Trace(1, tuple(Plan(plan.robot, (Visit(plan.visits[0].resource, 0, None),)) for plan in solution.plans))
    shown = opened(instance, solution, trace=happened)
    start = shown.robots()
    shown.press(Keys.ARROW_RIGHT, "l")
    assert shown.robots() == start
    ghosts = shown.number("viewer.map.ghosts.map((ghost) => [ghost.x, ghost.y])")
    places = [list(pose[:2]) for pose in start.values()]
    assert ghosts == [*places[1:], places[0]]
    assert "4 of them in a circle" in shown.text("about")
    assert logged(shown.driver, "browser") == []


@pytest.mark.ci
def test_450_robots_play_at_30_frames_a_second_on_the_processor(opened: Opener, warehouse: Case) -> None:
    shown = opened(*warehouse)
    shown.press(Keys.SPACE)
    assert shown.text("play") == "Pause"
    assert seconds_of_a_frame(shown) <= 1 / FEWEST_FRAMES


def seconds_of_a_frame(shown: Page) -> float:
    """The processor time of the browser for a frame; its share of a busy machine does not count."""
    shown.driver.set_script_timeout(LATER)
    began = processor_seconds(shown.driver)
    shown.driver.execute_async_script(
        "const finish = arguments[1]; let frames = 0;"
        "const count = () => { frames += 1; if (frames < arguments[0]) requestAnimationFrame(count); else finish(); };"
        "requestAnimationFrame(count)",
        FRAMES,
    )
    return (processor_seconds(shown.driver) - began) / FRAMES


def test_a_click_in_the_chart_goes_to_its_tick_and_robot(collision: Page) -> None:
    wait_for(collision, CHART_IS_DRAWN)
    collision.script(
        "const box = document.getElementById('chart').getBoundingClientRect();"
        "const width = viewer.chart.pixels;"
        "document.getElementById('chart').dispatchEvent(new MouseEvent('click',"
        "{clientX: box.x + 78 + 3.5 * width, clientY: box.y + 22 + 4 * 17 + 2 * 13 - 12, bubbles: true}))"
    )
    assert collision.tick == "tick 3 of 5"
    assert [each[:2] for each in collision.chosen("robots")] == ["r2"]


def test_a_key_works_after_an_entry_was_clicked(collision: Page) -> None:
    collision.click("#robots button", "r1")
    collision.press(Keys.SPACE)
    assert collision.text("play") == "Pause"


def test_robots_are_found_by_name(collision: Page) -> None:
    collision.click("#find")
    collision.press("2")
    assert collision.script("return document.querySelectorAll('#robots button:not([hidden])').length") == 1
    collision.press(Keys.SPACE)
    assert collision.text("play") == "Play"


def test_hostile_ids_are_only_text(opened: Opener) -> None:
    instance = read_instance(json.dumps(CORRIDOR).encode())
    instance = Instance(instance.graph, (Robot(HOSTILE, "a", "b"),))
    shown = opened(instance, Solution((Plan(HOSTILE, (Visit("b", 0, 1),)),), (HOSTILE,)))
    assert "<script>alert('1')" in shown.text("robots")
    assert logged(shown.driver, "browser") == []


def test_a_narrow_screen_needs_no_scrolling_sideways(opened: Opener, town: Case) -> None:
    shown = opened(*town, width=380)
    assert shown.script("return document.documentElement.scrollWidth") <= 380
    assert logged(shown.driver, "browser") == []
