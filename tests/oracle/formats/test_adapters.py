"""Other planners' files: what is right in them is judged right, and what is wrong by the right rule."""

from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.formats.foreign_files import (
    COLUMNS,
    CORRECT,
    INSTANCE,
    LACAM,
    MAP,
    MOVES,
    ROWS,
    SCENARIO,
    SCHEDULE,
    TABLE,
)
from tests.oracle.running import Run
from tests.profiles import draws

from carp_spec import Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Visit, judge
from carproof import judge_log, read_foreign_solution, write_foreign_solution, write_instance, write_solution
from carproof.formats import ADAPTERS, walks
from carproof.formats.logs import read_log
from carproof.formats.walks import instance_has_walks
from carproof.generate.grid import cell_edges, cell_id
from carproof.testing.strategies import PlannedInstance, Sizes, instances, planned_instances

SOLUTION = Solution(
    (
        Plan("r1", (Visit("0,0", 0, 1), Visit("1,0", 1, 2), Visit("2,0", 2, None))),
        Plan("r2", (Visit("3,2", 0, 2), Visit("3,1", 2, 3), Visit("3,0", 3, None))),
    ),
    ("r1", "r2"),
)


def read(text: str, format: str | None = None, instance: Instance = INSTANCE) -> Solution:
    return read_foreign_solution(text.encode(), instance, "file", format)


def broken_rules(text: str) -> list[str]:
    return [violation.rule for violation in judge(INSTANCE, read(text)).violations]


@pytest.mark.parametrize("format", CORRECT)
def test_a_correct_file_is_read_and_its_format_found(format: str) -> None:
    assert read(CORRECT[format]) == read(CORRECT[format], format) == SOLUTION
    assert judge(INSTANCE, SOLUTION).cost == 5


def test_the_trackers_table_is_read_too() -> None:
    assert read(TABLE) == SOLUTION
    assert read('path\n"rr\nwdd"\n') == SOLUTION


def test_a_file_with_the_other_system_s_line_ends_is_read() -> None:
    assert all(read(text.replace("\n", "\r\n")) == SOLUTION for text in (*CORRECT.values(), TABLE))


@pytest.mark.parametrize(
    ("text", "rules"),
    [
        (LACAM.replace("1:(1,0),(3,2)", "1:(0,0),(3,2)"), ["plan/move"]),
        (LACAM.replace("1:(1,0),(3,2)", "1:(1,1),(3,2)"), ["plan/resource"]),
        (LACAM.replace("1:(1,0),(3,2)", "1:(-1,0),(3,2)"), ["plan/resource"]),
        (LACAM.replace("4:(2,0),(3,0)", "4:(2,0),(3,1)"), ["plan/goal"]),
        (LACAM.replace("4:(2,0),(3,0)", "4:(2,0),(2,0)"), ["plan/goal", "joint/capacity"]),
        (LACAM + "5:(3,0),(2,0)\n6:(2,0),(3,0)\n", ["joint/exchange", "joint/exchange"]),
        (LACAM.replace("0:(0,0),(3,2)", "0:(0,1),(3,2)"), ["plan/start", "plan/move"]),
        (SCHEDULE.replace("x: 2, y: 0, t: 2", "x: 2, y: 2, t: 2"), ["plan/goal", "plan/move"]),
        (SCHEDULE.replace("y: 2, t: 0", "y: 2, t: 1"), ["plan/start"]),
        (MOVES.replace("2r", "r"), ["plan/goal"]),
        (MOVES.replace("2r", "d2r"), ["plan/goal", "plan/resource"] + ["plan/resource"] * 2),
        (MOVES.replace("2r", "2rd"), ["plan/goal", "plan/resource"]),
        (COLUMNS.replace("->(1,0)->", "->"), ["plan/move"]),
        (ROWS.replace("(1,3)->(0,3)", "(1,3)->(0,3)->(0,2)->(0,3)"), ["joint/capacity"]),
    ],
)
def test_a_broken_solution_is_read_and_judged_by_the_right_rules(text: str, rules: list[str]) -> None:
    assert broken_rules(text) == rules


def test_waiting_at_the_goal_is_one_visit_for_ever() -> None:
    assert read(MOVES.replace("2d", "2d999999999w")) == SOLUTION


@pytest.mark.parametrize(
    ("format", "text"),
    [
        ("lacam", "agents=2\nsolved=0\nsolution=\n"),
        ("libmultirobotplanning", "schedule: {}\n"),
        ("paths-x-y", "\n"),
    ],
)
def test_a_file_without_plans_leaves_all_robots_unplanned(format: str, text: str) -> None:
    assert read(text, format) == Solution((), (), ("r1", "r2"))


def test_an_agent_without_a_line_is_unplanned() -> None:
    only_second = Solution(SOLUTION.plans[1:], ("r2",), ("r1",))
    assert read(COLUMNS.splitlines()[1]) == only_second
    assert read("schedule:\n" + SCHEDULE[SCHEDULE.index("  agent1") :]) == only_second
    assert read("schedule:\n  r2:" + SCHEDULE.partition("agent1:")[2]) == only_second
    assert read("schedule:\n  agent0:\n    []\n" + SCHEDULE[SCHEDULE.index("  agent1") :]) == only_second
    assert read(write_foreign_solution(INSTANCE, only_second, "libmultirobotplanning").decode()) == only_second
    assert read(write_foreign_solution(INSTANCE, only_second, "paths-x-y").decode()) == only_second


@pytest.mark.parametrize(
    ("format", "text", "place"),
    [
        ("lacam", "", "file:1"),
        ("lacam", "solution=\n0:(0,0);(3,2)", "file:2"),
        ("lacam", LACAM.replace("3:(", "5:("), "file:12"),
        ("lacam", LACAM + "5:(2,0)", "file:14"),
        ("paths-x-y", "\nAgent 2: (0,0)->", "file:2"),
        ("paths-x-y", COLUMNS + "Agent 0: (0,0)", "file:3"),
        ("mapf-tracker", "rr\nwdx\n", "file:2"),
        ("mapf-tracker", "rr\n", "file:1"),
        ("mapf-tracker", "999999999r\nwdd\n", "file"),
        ("mapf-tracker", 'path,solution_plan\n"rr","rr"', "file:1"),
        ("mapf-tracker", '"agents","path"\n"2","rr\nwd?"\n', "file:3"),
        ("libmultirobotplanning", "", "file:1"),
        ("libmultirobotplanning", "a: [1, {b: 2}]", "file:2"),
        ("libmultirobotplanning", "schedule: {}\nschedule: {}", "file:2"),
        ("libmultirobotplanning", "schedule:\n  agent0: []\n  agent0: []", "file:3"),
        ("libmultirobotplanning", "schedule:\n  agent0: [{x: 1}]", "file:2"),
        ("libmultirobotplanning", "schedule:\n  agent0: [{x: 1.5}]", "file:2"),
        ("libmultirobotplanning", "schedule:\n  agent2: []", "file:2"),
        ("libmultirobotplanning", SCHEDULE + "  agent1:\n    - {x: 3, y: 2, t: 0}", "file:16"),
        ("libmultirobotplanning", SCHEDULE.replace("t: 2}", "t: 0}"), "file:11"),
        ("libmultirobotplanning", "schedule:\n  agent0: *x", "file:2"),
        ("libmultirobotplanning", "schedule: \x00", "file:1"),
        ("libmultirobotplanning", "schedule: " + "[" * 100_000, "file:1"),
        ("carproof", "{}", "file: $.format"),
        ("csv", "robot,resource,enter\n", "file:1"),
        ("csv", 'robot,resource,enter,leave\nr1,"0,0",0,1\nr1,"1,0",1.5,\n', "file:3"),
        ("csv", 'robot,resource,enter,leave\nr1,"0,0"\n', "file:2"),
        ("csv", "robot,resource,enter,leave\nr1,,0,1\n", "file:2"),
    ],
)
def test_a_malformed_file_is_refused_with_file_and_line(format: str, text: str, place: str) -> None:
    with pytest.raises(Refusal) as refused:
        read(text, format)
    assert str(refused.value).startswith(f"{place}: ")


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ("", "it looks like none of carproof, lacam"),
        ("plan: nothing", "it looks like none of"),
        ("Agent 0: (1,1)->(1,2)->", "it could be paths-row-column, paths-x-y"),
        ("Agent 0: (0,0)->(0,1)->", "it could be paths-row-column, paths-x-y"),
        (LACAM + "schedule: {}", "it could be lacam, libmultirobotplanning"),
    ],
)
def test_a_format_that_is_not_clear_is_to_be_named(text: str, error: str) -> None:
    with pytest.raises(Refusal, match="the format must be named by --from") as refused:
        read(text)
    assert error in str(refused.value)


@pytest.mark.parametrize("position", ["(0,0)", "(1,1)"])
def test_a_format_need_not_be_named_where_it_makes_no_difference(position: str) -> None:
    text = f"Agent 0: {position}->\n"
    solution = read(text)
    assert solution == read(text, "paths-row-column") == read(text, "paths-x-y")


@pytest.mark.parametrize(
    "instance",
    [
        replace(INSTANCE, after_goal="vanish"),
        replace(INSTANCE, robots=(Robot("r1", "0,0", "2,0", release=1),)),
        Instance(ResourceGraph((Resource("a"), Resource("b")), ()), (), "park"),
        Instance(ResourceGraph((Resource("a", x=1, y=1), Resource("b", x=1, y=1)), ()), (), "park"),
    ],
)
def test_an_instance_that_has_no_walks_is_refused(instance: Instance) -> None:
    assert not instance_has_walks(instance)
    for format in CORRECT:
        with pytest.raises(Refusal, match="adapter/instance"):
            read(CORRECT[format], format, replace(INSTANCE, after_goal="vanish"))
        with pytest.raises(Refusal, match="adapter/instance"):
            write_foreign_solution(instance, Solution((), (), ("r1",)), format)


def test_what_a_format_cannot_hold_is_not_written() -> None:
    half = Solution(SOLUTION.plans[:1], ("r1",), ("r2",))
    wrong = replace(SOLUTION, order=("r1",))
    for format in ("lacam", "mapf-tracker"):
        with pytest.raises(Refusal, match="unplanned"):
            write_foreign_solution(INSTANCE, half, format)
        with pytest.raises(Refusal, match=r"it breaks a rule: \[solution/order\]"):
            write_foreign_solution(INSTANCE, wrong, format)
    far = Instance(
        ResourceGraph((Resource("a", x=0, y=0), Resource("b", x=2, y=0)), (("a", "b"),)),
        (Robot("r1", "a", "b"),),
        "park",
    )
    jump = Solution((Plan("r1", (Visit("a", 0, 1), Visit("b", 1, None))),), ("r1",))
    assert read(write_foreign_solution(far, jump, "lacam").decode(), "lacam", far) == jump
    with pytest.raises(Refusal, match="is not to a cell beside"):
        write_foreign_solution(far, jump, "mapf-tracker")


def test_walks_that_do_not_fit_in_memory_are_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walks, "MOST_CELLS", 6)
    with pytest.raises(Refusal, match="at most 6 cells together, and have 7"):
        write_foreign_solution(INSTANCE, SOLUTION, "lacam")
    assert write_foreign_solution(INSTANCE, SOLUTION, "mapf-tracker") == b"2r\nw2d\n"


@st.composite
def grids(draw: st.DrawFn) -> ResourceGraph:
    """Grids of up to 3 x 3 cells with some of the edges; cells and edges are in random order."""
    width, height = draw(st.integers(1, 3)), draw(st.integers(1, 3))
    cells = draw(st.permutations([(x, y) for x in range(width) for y in range(height)]))
    numbers = st.integers(1, 2)
    resources = tuple(Resource(cell_id(x, y), draw(numbers), draw(numbers), x, y) for x, y in cells)
    return ResourceGraph(resources, tuple(edge for edge in cell_edges(cells) if draw(st.booleans())))


def planned_grids() -> st.SearchStrategy[PlannedInstance]:
    """Grids with robots that park, all of them planned."""
    sizes = Sizes(release=0)
    parking = instances(sizes, grids()).map(lambda instance: replace(instance, after_goal="park"))

    def only_planned(planned: PlannedInstance) -> PlannedInstance:
        robots = tuple(robot for robot in planned.instance.robots if robot.id in planned.solution.order)
        instance, plans = (
            replace(planned.instance, robots=robots),
            {plan.robot: plan for plan in planned.solution.plans},
        )
        return PlannedInstance(instance, Solution.of(instance, [plans[robot.id] for robot in robots]))

    return planned_instances(sizes, parking).map(only_planned)


@pytest.mark.parametrize("format", [each for each in ADAPTERS if each != "csv"])
@settings(max_examples=draws(150))
@given(planned=planned_grids())
def test_every_solution_on_a_grid_survives_the_way_there_and_back(format: str, planned: PlannedInstance) -> None:
    data = write_foreign_solution(planned.instance, planned.solution, format)
    assert read_foreign_solution(data, planned.instance, "file", format) == planned.solution


@settings(max_examples=draws(300))
@given(planned=planned_grids(), format=st.sampled_from([*CORRECT]))
def test_a_format_that_is_found_is_the_right_one_or_means_the_same(planned: PlannedInstance, format: str) -> None:
    data = write_foreign_solution(planned.instance, planned.solution, format)
    try:
        found = read_foreign_solution(data, planned.instance)
    except Refusal as refusal:
        assert refusal.rule == "adapter/format"  # noqa: PT017 - the refusal is one of two right answers
    else:
        assert found == planned.solution


@given(
    pieces=st.lists(
        st.sampled_from(
            [*"0123456789(),:->{}[]lrudw \n\"'&*#|", "solution=", "schedule:", "agent0:", "Agent 0:", "x: 1"]
        )
        | st.characters(),
        max_size=40,
    ),
    format=st.sampled_from([None, *ADAPTERS]),
)
def test_any_text_is_read_or_refused(pieces: list[str], format: str | None) -> None:
    try:
        solution = read_foreign_solution("".join(pieces).encode(errors="surrogatepass"), INSTANCE, "file", format)
    except Refusal as refusal:
        assert str(refusal).startswith("file")  # noqa: PT017 - the refusal is one of two right answers
    else:
        judge(INSTANCE, solution)


@pytest.fixture
def benchmark(elsewhere: Path) -> Path:
    """A folder to be in, with a map, a scenario, the instance that they are, and plans in every format."""
    files = {"m.map": MAP, "m.scen": SCENARIO, "m.json": write_instance(INSTANCE).decode(), **CORRECT}
    for name, text in files.items():
        (elsewhere / name).write_text(text)
    return elsewhere


MAPS = "--map m.map --scen m.scen"


@pytest.mark.usefixtures("benchmark")
@pytest.mark.parametrize("format", CORRECT)
def test_check_judges_a_file_against_an_instance_or_a_benchmark(carproof: Run, format: str) -> None:
    for arguments in (f"m.json {format}", f"{MAPS} {format} --from {format}", f"{MAPS} --agents 2 -"):
        outcome = carproof(f"check {arguments}", stdin=CORRECT[format].encode())
        assert outcome.stdout == "no rule is broken: total cost 5, unplanned robots 0\n"


HALFWAY = {
    "lacam": "solution=\n0:(0,0),(3,2),\n1:(1,0),(3,2),\n2:(2,0),(3,2),\n",
    "libmultirobotplanning": SCHEDULE[: SCHEDULE.index("    - {x: 3, y: 1")],
    "paths-x-y": "Agent 0: (0,0)->(1,0)->(2,0)->\nAgent 1: (3,2)->(3,2)->\n",
    "carproof": write_solution(
        replace(SOLUTION, plans=(SOLUTION.plans[0], Plan("r2", SOLUTION.plans[1].visits[:1])))
    ).decode(),
}


@pytest.mark.parametrize(
    ("format", "name"),
    [("libmultirobotplanning", "agent1"), ("paths-x-y", "Agent 1"), ("lacam", "r2"), ("carproof", "r2")],
)
def test_agents_of_a_benchmark_are_called_as_the_solution_calls_them(
    carproof: Run, benchmark: Path, format: str, name: str
) -> None:
    (benchmark / "broken").write_text(HALFWAY[format])
    outcome = carproof(f"check {MAPS} broken")
    assert outcome.code == 1
    assert f": robot {name} (" in outcome.stdout.splitlines()[0]
    assert ": robot r2 (" in carproof("check m.json broken").stdout.splitlines()[0]
    assert f'"{name}"' in carproof(f"view {MAPS} broken").stdout


def test_a_table_is_read_and_says_which_stops_are_served() -> None:
    table = write_foreign_solution(INSTANCE, SOLUTION, "csv").decode()
    assert [row.split(",")[-1] for row in table.splitlines()] == ["serves", "", "", "1", "", "", "1"]
    assert read(table) == read(table, "csv") == SOLUTION
    assert broken_rules(table.replace('"1,0"', '"1,1"')) == ["plan/resource"] * 1
    for id in ("1", "", "c\rd"):
        ids = Instance(ResourceGraph((Resource(1), Resource(id)), ()), (Robot("r", 1, 1),), "park")
        with pytest.raises(Refusal, match="adapter/csv"):
            write_foreign_solution(ids, Solution.of(ids, [Plan("r", (Visit(1, 0, None),))]), "csv")


def test_a_cell_without_a_resource_is_never_one_that_is_called_like_it() -> None:
    resources = Resource("0,0", x=0, y=0), Resource("1,0", x=0, y=1), Resource("1,1", x=1, y=1)
    graph = ResourceGraph(resources, (("0,0", "1,0"), ("1,0", "1,1")))
    instance = Instance(graph, (Robot("r", "0,0", "1,1"),), "park")
    around = read_foreign_solution(b"solution=\n0:(0,0),\n1:(0,1),\n2:(1,1),\n", instance)
    through = read_foreign_solution(b"solution=\n0:(0,0),\n1:(1,0),\n2:(1,1),\n", instance)
    assert judge(instance, around).valid
    assert "plan/resource" in {each.rule for each in judge(instance, through).violations}
    log = read_log(b'{"start": [[0, 0, "E"]], "actualPaths": ["F,R,F"]}', instance, "league")
    assert "plan/resource" in {each.rule for each in judge_log(instance, log).violations}


def test_a_table_keeps_blanks_of_ids() -> None:
    blank = Instance(ResourceGraph((Resource(" a"), Resource("b")), ((" a", "b"),)), (Robot("r ", "b", " a"),), "park")
    solution = Solution.of(blank, [Plan("r ", (Visit("b", 0, 1), Visit(" a", 1, None)))])
    table = write_foreign_solution(blank, solution, "csv")
    assert read_foreign_solution(table, blank) == solution
    assert read_foreign_solution(table.replace(b"b,0", b" b ,0"), blank) == solution


@given(planned_instances(Sizes(groups=2, stops=2, service=2)))
@settings(max_examples=draws(300))
def test_a_table_holds_the_plans_of_every_instance_whose_ids_print_differently(planned: PlannedInstance) -> None:
    instance, solution = planned.instance, planned.solution
    if any(len({*map(str, ids)}) < len(ids) for ids in (instance.robot, instance.graph.index)):
        with pytest.raises(Refusal, match="adapter/csv"):
            write_foreign_solution(instance, solution, "csv")
        return
    table = write_foreign_solution(instance, solution, "csv")
    plans = {plan.robot: plan for plan in solution.plans}
    assert read_foreign_solution(table, instance, "file", "csv") == Solution.of(
        instance, [plans[robot] for robot in solution.order]
    )
