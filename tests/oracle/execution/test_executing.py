"""The commands about executions: `check-trace`, `dependencies`, `execute`, `retime`, `untangle`."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from tests.oracle.running import Document, Run, line, save, solution, town
from tests.oracle.viewer.viewing import SVG, picture_of
from tests.profiles import draws

import carproof
from carp_spec import judge
from carp_spec.execution.execution_rules import is_acyclic
from carproof import Delay, drive, give_way, read_instance, read_solution, read_trace, retime
from carproof.engines import engine_named
from carproof.execution.simulation import execute
from carproof.execution.untangling import untangle
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances

SIZES = Sizes(resources=5, robots=5, stops=3, service=4)


TRAIN = ["bc", "ab"]
RING = ["ab", "bc", "cd", "da"]


def moves(robots: list[str], edges: str = "ab bc cd da ae") -> Document:
    """Cells in a ring and one beside it, with robots that go one cell on."""
    return town(edges, [{"id": f"r{number}", "start": a, "goal": b} for number, (a, b) in enumerate(map(list, robots))])


def steps(robots: list[str]) -> Document:
    """Each robot moves at tick 1."""
    return solution({f"r{number}": [[a, 0, 1], [b, 1, 2]] for number, (a, b) in enumerate(map(list, robots))})


def trace(second: list[list[object]]) -> Document:
    """By tick 3 the first robot of the train has moved; the visits of the second."""
    first = {"robot": "r0", "visits": [["b", 0, 3], ["c", 3, None]]}
    return {"format": "carproof-trace/1", "now": 3, "plans": [first, {"robot": "r1", "visits": second}]}


@pytest.fixture(autouse=True)
def _train_and_ring(elsewhere: Path) -> None:
    del elsewhere
    save(train=moves(TRAIN), plans=steps(TRAIN), ring=moves(RING), turning=steps(RING))
    save(trace=trace([["a", 0, None]]), delays=[["r0", 0, 4]])


def test_a_trace_that_breaks_a_rule_is_told(carproof: Run) -> None:
    assert carproof("execution check train.json plans.json trace.json").code == 0
    save(wrong=trace([["a", 0, 2], ["b", 2, None]]))
    outcome = carproof("execution check train.json plans.json wrong.json")
    assert outcome.code == 1
    assert outcome.stdout.startswith("[execution/order] resource b in [2,for ever): robot r1")


def test_robots_of_a_rotation_stand_where_dependencies_name_it(carproof: Run) -> None:
    for delays in ([], [["r2", 0, 5]]):
        save(delays=delays)
        named = json.loads(carproof("execution dependencies ring.json turning.json --json").stdout)["cycle"]
        outcome = carproof(
            "execution simulate ring.json turning.json --driver order --delays delays.json --trace end.json --json"
        )
        assert outcome.code == 1
        assert sorted(json.loads(outcome.stdout)["standing"]) == sorted(named["robots"]) == ["r0", "r1", "r2", "r3"]
        plans = json.loads(Path("end.json").read_bytes())["plans"]
        assert [plan["visits"] for plan in plans] == [[[way[0], 0, None]] for way in RING]
        assert carproof("execution check ring.json turning.json end.json").code == 0


def test_the_results_of_all_drivers_are_one_document(carproof: Run) -> None:
    results = json.loads(carproof("execution simulate train.json plans.json --json").stdout)
    assert [each["driver"] for each in results] == ["clock", "order", "switching"]
    assert json.loads(carproof("execution simulate train.json plans.json --driver order --json").stdout) == results[1]


def test_a_picture_shows_a_rotation_as_a_circle_of_arrows(carproof: Run, elsewhere: Path) -> None:
    for name, waits, cycle in (("ring.json turning.json", 0, 4), ("train.json plans.json", 1, 0)):
        carproof(f"execution dependencies {name} --svg graph.svg")
        picture = picture_of((elsewhere / "graph.svg").read_text())
        arrows = {
            kind: "".join(
                each.get("d", "") for each in picture.findall(f".//{SVG}g[@class='{kind}']/{SVG}path[@class='arrow']")
            ).count("M")
            for kind in ("waits", "cycle")
        }
        assert arrows == {"waits": waits, "cycle": cycle}


def test_what_a_trace_tells_stays_where_plans_change_from_the_next_tick_on(carproof: Run, elsewhere: Path) -> None:
    carproof("generate grid --width 4 --height 1 --map 3 --robots 1 --seed 1 -o row.json")
    carproof("plan row.json -o plans.json")
    robot, visits = json.loads(Path("plans.json").read_bytes())["plans"][0].values()
    told = {"robot": robot, "visits": [[visits[0][0], 0, None]]}
    save(trace={"format": "carproof-trace/1", "now": 2, "plans": [told]})
    outcome = carproof("execution retime row.json plans.json trace.json -o late.json")
    assert outcome.stdout.splitlines()[-1].startswith("add, assign, query and polish go on with --now 3: ")
    left = []
    for now in (2, 3):
        assert carproof(f"polish row.json late.json --now {now} --iterations 9 -o better.json").code == 0
        left.append(read_solution((elsewhere / "better.json").read_bytes()).plans[0].visits[0].leave)
    assert left == [2, 3]


def test_a_rotation_is_untangled_at_least_cost_or_named(carproof: Run, elsewhere: Path) -> None:
    out = elsewhere / "in-order.json"
    outcome = carproof("execution untangle ring.json turning.json -o in-order.json --engine reference")
    assert outcome.code == 0
    assert outcome.stdout.splitlines()[2].split() == ["4", "1", "6", "2"]
    instance, ordered = read_instance(line(**moves(RING))), read_solution(out.read_bytes())
    assert judge(instance, ordered).valid
    assert not list(is_acyclic(instance, ordered))
    save(closed=moves(RING, "ab bc cd da"))
    out.unlink()
    outcome = carproof("execution untangle closed.json turning.json -o in-order.json --engine reference")
    assert (outcome.code, outcome.stdout, out.exists()) == (1, "", False)
    assert outcome.stderr.startswith("Out of the rotation of the robots ")


def test_a_rotation_over_a_place_with_room_for_any_number_is_untangled() -> None:
    instance, turning = read_instance(line(**moves(RING))), read_solution(line(**steps(RING)))
    for capacity in (len(RING), 10**9):
        wide = (replace(instance.graph.resources[0], capacity=capacity), *instance.graph.resources[1:])
        found = untangle(
            replace(instance, graph=replace(instance.graph, resources=wide)), turning, engine_named("reference")
        )
        assert (found.extra, found.rotation) == (1, ())


def test_a_rotation_in_a_zone_that_it_fills_is_untangled() -> None:
    instance, turning = read_instance(line(**moves(RING))), read_solution(line(**steps(RING)))
    zone = (carproof.Group("zone", tuple("abcde"), len(RING)),)
    found = carproof.untangle(replace(instance, graph=replace(instance.graph, groups=zone)), turning)
    assert (found.extra, found.rotation) == (2, ())


def test_a_rotation_that_there_is_no_time_for_stays(carproof: Run) -> None:
    assert carproof("execution untangle ring.json turning.json --seconds 0").code == 2
    for seconds, ticks in ((1e-9, 0), (60, 2)):
        asked = line(id=1, op="untangle", instance=moves(RING), solution=steps(RING), seconds=seconds)
        found = json.loads(carproof("serve", stdin=asked).stdout)["result"]
        assert (found["extra"], found["undecided"]) == (ticks, not ticks)


@settings(max_examples=draws(60), deadline=None)
@given(planned_instances(SIZES))
def test_untangled_plans_are_lawful_and_can_be_followed_in_order(case: PlannedInstance) -> None:
    found = untangle(case.instance, case.solution, engine_named("reference"))
    assert judge(case.instance, found.solution).valid
    if not found.rotation:
        assert not list(is_acyclic(case.instance, found.solution))
        assert judge(case.instance, found.solution).cost == judge(case.instance, case.solution).cost + found.extra


def test_nobody_switches_to_park_in_the_way() -> None:
    robots = [{"id": "r0", "start": "a", "goal": "c"}, {"id": "r1", "start": "d", "goal": "b"}]
    instance = read_instance(line(**town("ab bc db", robots, "park")))
    plans = {"r0": [["a", 0, 1], ["b", 1, 2], ["c", 2, None]], "r1": [["d", 0, 2], ["b", 2, None]]}
    late = execute(instance, read_solution(line(**solution(plans))), "switching", (Delay("r0", 0, 5),))
    assert (late.switches, late.collisions, late.late) == (0, (), {"r0": 5, "r1": 5})


def test_python_has_what_the_commands_about_executions_have() -> None:
    instance, plans = read_instance(Path("train.json").read_bytes()), read_solution(Path("plans.json").read_bytes())
    done = read_trace(json.dumps(trace([["a", 0, None]])).encode())
    assert drive(instance, plans, done, ["r1"]) == ("r1",)
    assert drive(instance, plans, done, []) == ()
    assert retime(instance, plans, done) == engine_named("reference").retime(instance, plans, done)
    ring, turning = read_instance(Path("ring.json").read_bytes()), read_solution(Path("turning.json").read_bytes())
    assert not list(is_acyclic(ring, carproof.untangle(ring, turning).solution))
    assert carproof.untangle(ring, turning, 1e-9).undecided
    assert give_way(ring, turning, "r0").is_first
