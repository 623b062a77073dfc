"""`carproof view`: what the page and the stills hold, for sound, broken and hostile solutions."""

import re
from collections import Counter
from pathlib import Path
from subprocess import run

import pytest
from PIL import Image
from tests.oracle.running import EAST, EAST_PLAN, TWO_PLANNED, Document, Run, corridor, save, solution, town
from tests.oracle.viewer.viewing import (
    COLLIDING,
    CORRIDOR,
    HOSTILE,
    SVG,
    drawn,
    picture_of,
    plant,
    scene_of,
)
from tests.programs import require_programs

from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, Solution, Visit
from carp_spec.model import Group
from carproof.viewer import limits
from carproof.viewer.colours import LIGHT, LOOKS
from carproof.viewer.page import view
from carproof.viewer.placement import UNIT, placement
from carproof.viewer.samples import FOLDER, sample_pictures

pytestmark = pytest.mark.usefixtures("elsewhere")

FEWEST_PIXELS = 30
OUTSIDE = re.compile(r"""(?:src|href|url|action)\s*[=(]\s*["']?(?!#|data:)[a-z]*:?//""", re.IGNORECASE)


def test_the_page_is_one_file_that_names_no_address_outside(carproof: Run) -> None:
    page = drawn(carproof, CORRIDOR, COLLIDING)
    assert not OUTSIDE.search(page)
    assert "default-src 'none'" in page
    assert not re.search(r"<(?:link|script|img)[^>]*(?:src|href)=\"(?!data:)", page)


def test_equal_input_gives_equal_bytes(process: Run, elsewhere: Path) -> None:
    save(town=town("ab bc cd de", CORRIDOR["robots"]), plans=COLLIDING)  # without positions
    assert process("view town.json plans.json -o one").code == process("view town.json plans.json -o two").code == 0
    assert (elsewhere / "one").read_bytes() == (elsewhere / "two").read_bytes()


def test_the_scene_has_every_free_window(carproof: Run) -> None:
    scene = scene_of(drawn(carproof, CORRIDOR, solution({"r1": EAST_PLAN, "r2": [["b", 2, 4]]})))
    assert [place["windows"] for place in scene["places"][:2]] == [[[1, None]], [[0, 1], [4, None]]]
    assert (scene["first"], scene["last"]) == (0, 4)
    forbidden = scene_of(drawn(carproof, {**CORRIDOR, "following": "forbidden"}, solution({"r2": [["b", 2, 4]]})))
    assert forbidden["places"][1]["windows"] == [[0, 1], [5, None]], "a tick lies between robots"


def test_ids_cannot_leave_their_text(carproof: Run) -> None:
    robot = {**EAST, "id": HOSTILE}
    instance = corridor([robot])
    instance["graph"]["nodes"][0]["id"] = instance["graph"]["edges"][0]["source"] = robot["start"] = HOSTILE
    plans = solution({HOSTILE: [[HOSTILE, 0, 1], *EAST_PLAN[1:]]})
    page = drawn(carproof, instance, plans)
    assert page.count("<script") == page.count("</script") == 2
    shown = "</script><script>alert('1')</script>&\"\\u2028é漢字🤖\\u202e"
    assert scene_of(page)["tracks"][0]["label"] == shown
    for options in (("--at", "0"), ("--chart",)):
        texts = [each.text for each in picture_of(drawn(carproof, instance, plans, *options)).iter()]
        assert shown in texts


def test_the_still_of_the_map_marks_the_violations_of_its_tick(carproof: Run) -> None:
    def marked(tick: int) -> tuple[int, int]:
        still = drawn(carproof, CORRIDOR, COLLIDING, "--at", str(tick))
        return len(picture_of(still).findall(f".//{SVG}path[@class='violation']")), still.count(" blamed")

    assert [marked(tick) for tick in range(4)] == [(0, 0), (1, 2), (1, 2), (0, 0)]


def test_the_still_of_the_chart_has_rows_windows_stays_and_violations(carproof: Run) -> None:
    picture = picture_of(drawn(carproof, CORRIDOR, COLLIDING, "--chart"))
    count = {
        kind: len(picture.findall(f".//{SVG}{tag}[@class='{kind}']"))
        for tag, kind in (("text", "row-name"), ("path", "window"), ("path", "bar"), ("path", "violation"))
    }
    assert count == {"row-name": 5, "window": 5, "bar": 7, "violation": 2}


def test_a_stay_of_no_ticks_in_a_group_is_drawn_and_its_rule_named() -> None:
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),), groups=(Group("g", ("a", "b")),))
    instance = Instance(graph, (Robot("r", "a", "b"),))
    plans = Solution((Plan("r", (Visit("a", 0, 0), Visit("b", 0, 1))),), ("r",))
    assert b"plan/duration" in view(instance, plans)


def test_one_way_moves_are_arrows(carproof: Run) -> None:
    instance = corridor([EAST])
    instance["graph"]["directed"] = True
    instance["graph"]["edges"].append({"source": "b", "target": "a"})
    picture = picture_of(drawn(carproof, instance, solution({"r1": EAST_PLAN}), "--at", "0"))
    paths = {each.get("class"): each.get("d", "") for each in picture.iter(f"{SVG}path")}
    assert "edge" not in paths
    assert paths["joint"].count("M") == 4
    assert paths["one-way"].count("M") == paths["one-way head"].count("z") == 3


def test_a_plant_has_its_lanes_groups_stops_and_headings() -> None:
    instance, plans = plant()
    scene = scene_of(view(instance, plans, title="plant").decode())
    places = {place["label"]: place for place in scene["places"]}
    (ax, ay), (bx, by), (cx, cy) = (places[each]["at"] for each in "abc")
    assert ax < bx == cx
    assert cy < by == ay, "north is above"
    assert [name for name, place in places.items() if place["way"]] == ["ab", "bc", "bc (reverse)"]
    east, north = places["ab"]["way"], places["bc"]["way"]
    assert ax < east[0][0] < east[1][0] < bx
    assert (east[0][1], east[1][1]) == (ay, ay)
    assert north[0][0] == north[1][0] > bx > places["bc (reverse)"]["way"][0][0], "traffic keeps to the right"
    assert by > north[0][1] > north[1][1] > cy
    assert [outline["label"] for outline in scene["outlines"]] == ["corner"], "a point with its lanes is seen anyway"
    corners = scene["outlines"][0]["corners"]
    assert all(min(x for x, _ in corners) < x < max(x for x, _ in corners) for (x, _) in (*east, *north))
    (track,) = scene["tracks"]
    assert (len(track["stop_marks"]), track["stops"]) == (1, [[1, 4], [2, 6]])
    assert track["services"] == [[4, 8], [12, 18]]
    assert places["b"]["windows"] == [[0, 1], [12, None]], "who is on a lane holds its ends"


def test_own_positions_are_kept_and_others_are_laid_out_apart() -> None:
    row = tuple(Resource(name, x=1000 * at, y=0) for at, name in enumerate("abc"))
    edges = (("a", "b"), ("b", "c"))
    assert [x for x, _ in placement(ResourceGraph(row, edges)).points.values()] == [26, 66, 106]
    uneven = tuple(Resource(name, x=x, y=0) for name, x in zip("abc", (0, 1, 4), strict=True))
    assert [x for x, _ in placement(ResourceGraph(uneven, edges)).points.values()] == [26, 66, 186]
    for lacking in (
        tuple(Resource(each.id) for each in row),
        (*row[:2], Resource("c")),
        (*row[:2], Resource("c", x=0, y=0)),
        (*row[:2], Resource("c", x=10**30, y=0)),
        (*row, Resource("lonely")),
    ):
        placed = placement(ResourceGraph(lacking, edges))
        points = list(placed.points.values())
        assert placed.computed
        assert all(
            max(abs(one[0] - two[0]), abs(one[1] - two[1])) >= UNIT * 4 // 5
            for at, one in enumerate(points)
            for two in points[:at]
        )


def test_large_graphs_without_positions_are_laid_out_in_rows() -> None:
    many = tuple(Resource(number) for number in range(900))
    placed = placement(ResourceGraph(many, tuple((number, number + 1) for number in range(899))))
    assert (placed.width, placed.height) == (29 * UNIT + 52, 29 * UNIT + 52)


def test_both_resources_of_an_exchange_are_marked(carproof: Run) -> None:
    west = {"id": "r2", "start": "b", "goal": "a"}
    plans = solution({"r1": [["a", 0, 1], ["b", 1, 2]], "r2": [["b", 0, 1], ["a", 1, 2]]})
    instance = corridor([{**EAST, "goal": "b"}, west])
    still = picture_of(drawn(carproof, instance, plans, "--at", "1"))
    assert len(still.findall(f".//{SVG}path[@class='violation']")) == 2
    chart = picture_of(drawn(carproof, instance, plans, "--chart"))
    assert len(chart.findall(f".//{SVG}path[@class='violation']")) == 2


def test_an_instance_alone_is_shown_with_its_starts_and_goals(carproof: Run) -> None:
    save(town=CORRIDOR)
    outcome = carproof("view town.json")
    scene = scene_of(outcome.stdout)
    assert (outcome.code, scene["alone"], scene["violations"]) == (0, True, [])
    assert all(track["start_mark"] and track["goal_mark"] for track in scene["tracks"])
    assert carproof("view town.json -o town.svg").code == 0
    picture = picture_of(Path("town.svg").read_text())
    assert len(picture.findall(f".//{SVG}circle[@class='start']")) == 2
    refused = carproof("view town.json --at 0")
    assert (refused.code, "give SOLUTION" in refused.stderr) == (2, True)


def test_an_instance_without_resources_or_robots_is_drawn(carproof: Run) -> None:
    instance = {**corridor([]), "graph": {"nodes": [], "edges": []}}
    for options in ((), ("--at", "0"), ("--chart",)):
        assert drawn(carproof, instance, solution({}), *options)


@pytest.mark.parametrize(
    ("name", "what"),
    [("resources", "5 "), ("edges", "4 "), ("robots", "2 "), ("visits", "7 "), ("bytes", "")],
)
def test_what_is_too_large_is_refused_with_the_limit(
    carproof: Run, folder: Path, monkeypatch: pytest.MonkeyPatch, name: str, what: str
) -> None:
    monkeypatch.setitem(limits._MOST, name, 1)
    outcome = carproof("view town.json broken.json -o out.html")
    assert outcome.code == 2
    assert f"a picture shows at most 1 {name}, and this one would have {what}" in outcome.stderr.replace("\n", " \n")
    assert outcome.stderr.endswith("[view/size]\n")
    assert not (folder / "out.html").exists()


def trace(now: int, *behind: list[object]) -> Document:
    """The visits of r1 and of r2 by a tick."""
    plans = {"r1": [["a", 0, 2], ["b", 2, None]], "r2": behind}
    return {
        "format": "carproof-trace/1",
        "now": now,
        "plans": [{"robot": each, "visits": plans[each]} for each in plans],
    }


def test_a_trace_is_shown_beside_the_plans(carproof: Run) -> None:
    save(trace=trace(6, ["b", 0, 1], ["c", 1, None]))
    scene = scene_of(drawn(carproof, CORRIDOR, TWO_PLANNED, "--trace", "trace.json"))
    done = [
        [(scene["places"][scene["stands"][stand]["place"]]["label"], *ticks) for stand, *ticks in track["done"]]
        for track in scene["tracks"]
    ]
    assert done == [[("a", 0, 2), ("b", 2, None)], [("b", 0, 1), ("c", 1, None)]]
    assert [track["note"] for track in scene["tracks"]] == ["late by 1", ""]
    assert (scene["now"], scene["last"], scene["violations"]) == (6, 6, [])
    assert [place["lanes_done"] for place in scene["places"]] == [1, 1, 1, 0, 0]


def test_the_rules_that_a_trace_breaks_are_listed_where_the_plans_break_none(carproof: Run) -> None:
    save(trace=trace(6, ["b", 0, None]))
    option = ("--trace", "trace.json")
    scene = scene_of(drawn(carproof, CORRIDOR, TWO_PLANNED, *option))
    assert [rule["id"] for rule in scene["rules"]] == ["execution/order"]
    assert scene["violations"][0]["tracks"] == [0]
    scene = scene_of(drawn(carproof, CORRIDOR, COLLIDING, *option))
    assert [rule["id"] for rule in scene["rules"]] == ["joint/capacity"]


def test_only_the_first_of_very_many_violations_are_listed(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("carproof.viewer.scene_builder.MOST_LISTED", 1)
    scene = scene_of(drawn(carproof, CORRIDOR, COLLIDING))
    assert len(scene["violations"]) == 1
    assert scene["rules"][0]["count"] == 2


@pytest.mark.parametrize("name", ["map.svg", "chart.svg", "dependencies.svg"])
def test_the_pictures_of_the_project_are_drawn_by_it(name: str) -> None:
    assert (FOLDER / name).read_bytes() == sample_pictures()[name], "run: make generated"


@pytest.mark.parametrize(
    ("name", "robots", "ground"),
    [("map.svg", 8, ("wall", "floor")), ("chart.svg", 8, ("window",)), ("dependencies.svg", 8, ("way", "line"))],
)
def test_pictures_have_their_colours_outside_a_browser(
    tmp_path: Path, name: str, robots: int, ground: tuple[str, ...]
) -> None:
    seen = rendered(sample_pictures()[name], tmp_path)
    wanted = {LIGHT[each] for each in ("paper", *ground)} | {look.fill for look in LOOKS[:robots]}
    assert {each for each in wanted if seen[each] < FEWEST_PIXELS} == set()
    assert seen["#000000"] < sum(seen.values()) // 20


def rendered(still: bytes, folder: Path) -> Counter[str]:
    """How many pixels of each colour the picture has where `rsvg-convert` draws it."""
    require_programs("rsvg-convert")
    (folder / "still.svg").write_bytes(still)
    run(["rsvg-convert", "-z", "2", folder / "still.svg", "-o", folder / "still.png"], check=True, timeout=60)  # noqa: S607
    with Image.open(folder / "still.png") as image:
        pixels = image.convert("RGB").tobytes()
    return Counter(f"#{pixels[at : at + 3].hex()}" for at in range(0, len(pixels), 3))
