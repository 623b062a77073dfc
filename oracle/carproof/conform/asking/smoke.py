"""The smoke cases: small questions, each about one thing that planners get wrong."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

from carp_spec import (
    AfterGoal,
    Carp,
    Instance,
    Neighbourhood,
    Plan,
    Resource,
    ResourceGraph,
    Robot,
    RobotId,
    Solution,
    Visit,
)
from carp_spec.model import Group
from carproof.conform.cases import Case
from carproof.conform.levels import Level

Stay = tuple[str, int, int | None]


def row(
    robots: Sequence[Robot],
    after_goal: AfterGoal = "vanish",
    cells: str = "abcd",
    capacity: str = "",
    duration: str = "",
) -> Instance:
    """An instance: cells in a row; the capacities and durations given as digits, 1 where none exists."""
    resources = tuple(
        Resource(cell, int(capacity[x : x + 1] or 1), int(duration[x : x + 1] or 1), x, 0)
        for x, cell in enumerate(cells)
    )
    return Instance(ResourceGraph(resources, tuple(pairwise(cells))), tuple(robots), after_goal)


def passing_place(robots: Sequence[Robot], after_goal: AfterGoal = "vanish") -> Instance:
    """An instance: cells a, b, c, d in a row and a cell p beside b."""
    resources = (*(Resource(cell, 1, 1, x, 0) for x, cell in enumerate("abcd")), Resource("p", 1, 1, 1, 1))
    edges = (("a", "b"), ("b", "c"), ("c", "d"), ("b", "p"))
    return Instance(ResourceGraph(resources, edges), tuple(robots), after_goal)


def grouped(instance: Instance, *groups: Group) -> Instance:
    """The instance with groups."""
    return replace(instance, graph=replace(instance.graph, groups=groups))


def committed(instance: Instance, **plans: Sequence[Stay]) -> Solution:
    """The solution with these plans, in the order given."""
    made = tuple(Plan(robot, tuple(Visit(*stay) for stay in stays)) for robot, stays in plans.items())
    return Solution(made, tuple(plans), tuple(robot for robot in instance.robot if robot not in plans))


def _query(name: str, instance: Instance, solution: Solution, robot: RobotId, now: int = 0) -> Case:
    return Case("smoke", name, "query", instance, solution, robot, now)


EAST, WEST = Robot("new", "a", "d"), Robot("new", "d", "a")
FIRST = Robot("first", "a", "d")
FIRST_GOES: Sequence[Stay] = (("a", 0, 1), ("b", 1, 2), ("c", 2, 3), ("d", 3, 4))


def _alone() -> Iterator[Case]:
    nobody = Solution((), (), ("new",))
    yield _query("alone", row([EAST]), nobody, "new")
    yield _query("start is goal, vanish", row([Robot("new", "b", "b")]), nobody, "new")
    yield _query("start is goal, park", row([Robot("new", "b", "b")], "park"), nobody, "new")
    yield _query("released later", row([Robot("new", "a", "d", release=3)]), nobody, "new")
    yield _query("durations", row([EAST], duration="1231"), nobody, "new")
    yield _query("pace", row([Robot("new", "a", "d", pace=2)], duration="1211"), nobody, "new")
    yield _query("added under way, after its release", row([EAST]), nobody, "new", now=3)
    islands = Instance(ResourceGraph((Resource("a"), Resource("b")), ()), (Robot("new", "a", "b"),))
    yield _query("goal out of reach", islands, nobody, "new")
    oneway = Instance(ResourceGraph((Resource("a"), Resource("b")), (("b", "a"),), directed=True), islands.robots)
    yield _query("only against a directed move", oneway, nobody, "new")


def _with_others() -> Iterator[Case]:
    for after_goal in ("vanish", "park"):
        stay = None if after_goal == "park" else 4
        goes: Sequence[Stay] = [*FIRST_GOES[:3], ("d", 3, stay)]
        behind = row([FIRST, Robot("new", "b", "d")], after_goal)
        yield _query(f"goal after the other's, {after_goal}", behind, committed(behind, first=goes), "new")
        against = passing_place([FIRST, WEST], after_goal)
        yield _query(f"aside for the other, {after_goal}", against, committed(against, first=goes), "new")
    head_on = row([FIRST, WEST], capacity="2222")
    yield _query("no exchange, whatever the capacities", head_on, committed(head_on, first=FIRST_GOES), "new")
    shared = row([FIRST, EAST], capacity="2222")
    yield _query("room for two", shared, committed(shared, first=FIRST_GOES), "new")
    start_taken = row([FIRST, EAST])
    yield _query("start taken at the release", start_taken, committed(start_taken, first=FIRST_GOES), "new")
    slow = row([Robot("first", "b", "d"), EAST], duration="1311")
    slowly = [("b", 0, 3), ("c", 3, 4), ("d", 4, 5)]
    yield _query("behind a slow one", slow, committed(slow, first=slowly), "new")
    passed = row([Robot("first", "a", "d", release=2), Robot("new", "b", "c")], "park")
    later = [("a", 2, 3), ("b", 3, 4), ("c", 4, 5), ("d", 5, None)]
    yield _query("goal passed by another later", passed, committed(passed, first=later), "new")
    blocked = row([Robot("first", "b", "b"), EAST], "park")
    yield _query("way parked in for ever", blocked, committed(blocked, first=[("b", 0, None)]), "new")
    back_to_back = row([Robot("first", "b", "b"), Robot("second", "b", "b", release=1), EAST])
    plans = committed(back_to_back, first=[("b", 0, 1)], second=[("b", 1, 2)])
    yield _query("no window of no ticks", back_to_back, plans, "new")


def _under_way() -> Iterator[Case]:
    alone = row([EAST])
    goes = committed(alone, new=FIRST_GOES)
    for now in range(5):
        yield _query(f"replanned at {now}", alone, goes, "new", now)
    stands = row([EAST, Robot("other", "b", "b")])
    stayed = committed(stands, other=[("b", 0, 1)])
    yield _query("has stood at its start", stands, stayed, "new", now=2)
    long = row([Robot("new", "b", "b")])
    yield _query("stood at its goal too long to vanish there", long, Solution((), (), ("new",)), "new", now=3)


def _whole(planner: Carp | None) -> Iterator[Case]:
    """Whole instances; without a planner the choice is the program's."""
    instances = {
        "nobody": row([]),
        "one robot": row([EAST]),
        "one behind the other": row([FIRST, Robot("new", "b", "d")]),
        "head-on": passing_place([FIRST, WEST]),
        "head-on, park": passing_place([Robot("first", "a", "c"), Robot("new", "d", "b")], "park"),
        "one must make room for the other, park": passing_place(
            [Robot("first", "a", "c"), Robot("new", "c", "a")], "park"
        ),
        "goal on the other's way, park": row([Robot("first", "b", "c"), EAST], "park"),
        "ids 1 and '1'": row([Robot(1, "a", "b"), Robot("1", "c", "d")]),
        "ids of resources are numbers": Instance(
            ResourceGraph((Resource(1), Resource("1"), Resource(0)), ((1, "1"), ("1", 0))), (Robot(0, 1, 0),)
        ),
        "pace": row([FIRST, Robot("new", "b", "d", pace=3)]),
        "better the other one first": row([Robot("slow", "c", "b", pace=2), Robot("new", "a", "b", release=1)]),
        "better the last one first": passing_place(
            [Robot("first", "c", "b"), Robot("second", "p", "c", release=2), Robot("third", "d", "a", release=1)]
        ),
    }
    for name, instance in instances.items():
        yield Case("smoke", f"plan: {name}", "plan", instance, planner=planner)


def _checks() -> Iterator[Case]:
    instance = row([FIRST, Robot("new", "c", "a")])
    right = committed(instance, first=FIRST_GOES)
    plans = {
        "right": right,
        "hurries": committed(instance, first=[("a", 0, 1), ("b", 1, 1), ("c", 1, 2), ("d", 2, 3)]),
        "exchange": committed(instance, first=FIRST_GOES, new=[("c", 0, 2), ("b", 2, 3), ("a", 3, 4)]),
        "together": committed(instance, first=FIRST_GOES, new=[("c", 0, 3), ("b", 3, 4), ("a", 4, 5)]),
        "nobody named": Solution((), ()),
    }
    for name, solution in plans.items():
        yield Case("smoke", f"check: {name}", "check", instance, solution)


def _additions() -> Iterator[Case]:
    instance = passing_place([FIRST, WEST])
    before = committed(instance, first=FIRST_GOES)
    for now in (0, 2):
        yield Case("smoke", f"add at {now}", "add", instance, before, "new", now, Neighbourhood())


def _polishes() -> Iterator[Case]:
    """Plans that can be better, plans to keep, and robots to plan."""
    waits = [("a", 0, 4), ("b", 4, 5), ("c", 5, 6), ("d", 6, 7)]
    slowly = [("d", 0, 4), ("c", 4, 5), ("b", 5, 6), ("a", 6, 7)]
    alone = row([FIRST])
    meeting = passing_place([FIRST, WEST])
    blocked = row([FIRST, WEST])
    plans = {
        "waits for nothing": (alone, committed(alone, first=waits)),
        "as good as can be": (alone, committed(alone, first=FIRST_GOES)),
        "one has no plan": (meeting, committed(meeting, first=FIRST_GOES)),
        "nobody has a plan": (meeting, committed(meeting)),
        "the slow one has a plan": (meeting, committed(meeting, new=slowly)),
        "not all can have plans": (blocked, committed(blocked, first=waits)),
        "nobody": (row([]), committed(row([]))),
    }
    for name, (instance, solution) in plans.items():
        yield Case("smoke", f"polish: {name}", "polish", instance, solution)


BLOCK = Group("block", ("b", "c"))
"""The two cells in the middle of a row, for one robot at a time."""


def _through_groups() -> Iterator[Case]:
    yield _query("moves within a group", grouped(row([EAST]), BLOCK), Solution((), (), ("new",)), "new")
    before = row([Robot("first", "b", "d"), EAST])
    slowly: Sequence[Stay] = [("b", 0, 2), ("c", 2, 4), ("d", 4, 5)]
    for what, groups in {
        "the whole group is taken": (BLOCK,),
        "a group has room for two": (replace(BLOCK, capacity=2),),
        "groups overlap": (BLOCK, Group("end", ("c", "d"))),
    }.items():
        yield _query(what, grouped(before, *groups), committed(before, first=slowly), "new")
    turning = _turning()
    goes: Sequence[Stay] = [("p", 0, 1), ("c", 1, 2), ("d", 2, 3)]
    yield _query("no exchange with a resource of the same group", turning, committed(turning, first=goes), "new")
    for name, instance, plans in (
        (
            "two in a group",
            grouped(before, BLOCK),
            {"first": slowly, "new": [("a", 0, 2), ("b", 2, 4), ("c", 4, 5), ("d", 5, 6)]},
        ),
        (
            "exchange with a resource of the same group",
            turning,
            {"first": goes, "new": [("c", 0, 1), ("b", 1, 2), ("a", 2, 3)]},
        ),
        (
            "one after the other through a group",
            turning,
            {"first": goes, "new": [("c", 0, 2), ("b", 2, 3), ("a", 3, 4)]},
        ),
    ):
        yield Case("smoke", f"check: {name}", "check", instance, committed(instance, **plans))


def _turning() -> Instance:
    """A row whose second cell is split in two, b and p; each is joined to the third, which has room for two."""
    resources = tuple(
        Resource(each, 1 + (each == "c"), 1, x, 0) for each, x in zip("abpcd", (0, 1, 1, 2, 3), strict=True)
    )
    graph = ResourceGraph(
        resources, (("a", "b"), ("b", "c"), ("p", "c"), ("c", "d")), groups=(Group("cell", ("b", "p")),)
    )
    return Instance(graph, (Robot("first", "p", "d"), Robot("new", "c", "a")))


def _whole_with_groups(planner: Carp | None) -> Iterator[Case]:
    instances = {
        "one behind the other through a group": grouped(row([FIRST, Robot("new", "b", "d")]), BLOCK),
        "head-on beside a group": grouped(passing_place([FIRST, WEST]), Group("middle", ("b", "c"), 2)),
        "a cell is split": _turning(),
    }
    for name, instance in instances.items():
        yield Case("smoke", f"plan: {name}", "plan", instance, planner=planner)


def smoke_cases(ops: Sequence[str], level: Level, whole: bool, groups: bool = False) -> Iterator[Case]:
    """The smoke cases; `whole`: of a program that plans whole instances by a planner of its own."""
    if whole:
        yield from _whole(None)
        yield from _whole_with_groups(None) if groups else ()
        return
    with_groups = (*_through_groups(), *_whole_with_groups(Carp())) if groups else ()
    each = (
        *_alone(),
        *_with_others(),
        *_under_way(),
        *_whole(Carp()),
        *_checks(),
        *_additions(),
        *_polishes(),
        *with_groups,
    )
    yield from (case for case in each if case.op in ops)
    if "bound" in ops:
        yield from (Case("smoke", f"bound: {case.name[6:]}", "bound", case.instance) for case in _whole(None))
    if "optimum" in ops and level >= Level.COMPLETE:
        yield from (Case("smoke", f"optimum: {case.name[6:]}", "optimum", case.instance) for case in _whole(None))
