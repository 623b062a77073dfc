"""The smoke cases: small questions, each about one thing that planners get wrong."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import pairwise

from carp_spec import (
    AfterGoal,
    Carp,
    Instance,
    Neighbourhood,
    Plan,
    Planner,
    Resource,
    ResourceGraph,
    Robot,
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
    made = (Plan(robot, tuple(Visit(*stay) for stay in stays)) for robot, stays in plans.items())
    return Solution.of(instance, made)


def _query(name: str, instance: Instance, now: int = 0, **plans: Sequence[Stay]) -> Case:
    return Case("smoke", name, "query", instance, committed(instance, **plans), "new", now)


def _cases_of(op: str, plans: Mapping[str, tuple[Instance, Mapping[str, Sequence[Stay]]]]) -> Iterator[Case]:
    """A case of an op about each of these plans."""
    for name, (instance, made) in plans.items():
        yield Case("smoke", f"{op}: {name}", op, instance, committed(instance, **made))


EAST, WEST = Robot("new", "a", "d"), Robot("new", "d", "a")
FIRST = Robot("first", "a", "d")
FIRST_GOES: Sequence[Stay] = (("a", 0, 1), ("b", 1, 2), ("c", 2, 3), ("d", 3, 4))


def _alone() -> Iterator[Case]:
    yield _query("alone", row([EAST]))
    yield _query("start is goal, vanish", row([Robot("new", "b", "b")]))
    yield _query("start is goal, park", row([Robot("new", "b", "b")], "park"))
    yield _query("released later", row([Robot("new", "a", "d", release=3)]))
    yield _query("durations", row([EAST], duration="1231"))
    yield _query("pace", row([Robot("new", "a", "d", pace=2)], duration="1211"))
    yield _query("added under way, after its release", row([EAST]), now=3)
    islands = Instance(ResourceGraph((Resource("a"), Resource("b")), ()), (Robot("new", "a", "b"),))
    yield _query("goal out of reach", islands)
    oneway = Instance(ResourceGraph((Resource("a"), Resource("b")), (("b", "a"),), directed=True), islands.robots)
    yield _query("only against a directed move", oneway)


def _with_others() -> Iterator[Case]:
    for after_goal in ("vanish", "park"):
        stay = None if after_goal == "park" else 4
        goes: Sequence[Stay] = [*FIRST_GOES[:3], ("d", 3, stay)]
        yield _query(
            f"goal after the other's, {after_goal}", row([FIRST, Robot("new", "b", "d")], after_goal), first=goes
        )
        yield _query(f"aside for the other, {after_goal}", passing_place([FIRST, WEST], after_goal), first=goes)
    yield _query("no exchange, whatever the capacities", row([FIRST, WEST], capacity="2222"), first=FIRST_GOES)
    yield _query("room for two", row([FIRST, EAST], capacity="2222"), first=FIRST_GOES)
    yield _query("start taken at the release", row([FIRST, EAST]), first=FIRST_GOES)
    slow = row([Robot("first", "b", "d"), EAST], duration="1311")
    yield _query("behind a slow one", slow, first=[("b", 0, 3), ("c", 3, 4), ("d", 4, 5)])
    passed = row([Robot("first", "a", "d", release=2), Robot("new", "b", "c")], "park")
    yield _query("goal passed by another later", passed, first=[("a", 2, 3), ("b", 3, 4), ("c", 4, 5), ("d", 5, None)])
    yield _query("way parked in for ever", row([Robot("first", "b", "b"), EAST], "park"), first=[("b", 0, None)])
    back_to_back = row([Robot("first", "b", "b"), Robot("second", "b", "b", release=1), EAST])
    yield _query("no window of no ticks", back_to_back, first=[("b", 0, 1)], second=[("b", 1, 2)])


def _under_way() -> Iterator[Case]:
    for now in range(5):
        yield _query(f"replanned at {now}", row([EAST]), now, new=FIRST_GOES)
    yield _query("has stood at its start", row([EAST, Robot("other", "b", "b")]), now=2, other=[("b", 0, 1)])
    yield _query("stood at its goal too long to vanish there", row([Robot("new", "b", "b")]), now=3)


INSTANCES = {
    "nobody": row([]),
    "one robot": row([EAST]),
    "one behind the other": row([FIRST, Robot("new", "b", "d")]),
    "head-on": passing_place([FIRST, WEST]),
    "head-on, park": passing_place([Robot("first", "a", "c"), Robot("new", "d", "b")], "park"),
    "one must make room for the other, park": passing_place([Robot("first", "a", "c"), Robot("new", "c", "a")], "park"),
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
"""Whole instances to plan."""


def _wholes(op: str, instances: Mapping[str, Instance], planner: Planner | None = None) -> Iterator[Case]:
    """Whole instances; without a planner the choice is the program's."""
    for name, instance in instances.items():
        yield Case("smoke", f"{op}: {name}", op, instance, planner=planner)


def _checks() -> Iterator[Case]:
    instance = row([FIRST, Robot("new", "c", "a")])
    plans: dict[str, dict[str, Sequence[Stay]]] = {
        "right": {"first": FIRST_GOES},
        "hurries": {"first": [("a", 0, 1), ("b", 1, 1), ("c", 1, 2), ("d", 2, 3)]},
        "exchange": {"first": FIRST_GOES, "new": [("c", 0, 2), ("b", 2, 3), ("a", 3, 4)]},
        "together": {"first": FIRST_GOES, "new": [("c", 0, 3), ("b", 3, 4), ("a", 4, 5)]},
    }
    yield from _cases_of("check", {name: (instance, made) for name, made in plans.items()})
    yield Case("smoke", "check: nobody named", "check", instance, Solution((), ()))


def _additions() -> Iterator[Case]:
    instance = passing_place([FIRST, WEST])
    before = committed(instance, first=FIRST_GOES)
    for now in (0, 2):
        yield Case("smoke", f"add at {now}", "add", instance, before, "new", now, Neighbourhood())


def _polishes() -> Iterator[Case]:
    """Plans that can be better, plans to keep, and robots to plan."""
    waits = [("a", 0, 4), ("b", 4, 5), ("c", 5, 6), ("d", 6, 7)]
    slowly = [("d", 0, 4), ("c", 4, 5), ("b", 5, 6), ("a", 6, 7)]
    meeting = passing_place([FIRST, WEST])
    yield from _cases_of(
        "polish",
        {
            "waits for nothing": (row([FIRST]), {"first": waits}),
            "as good as can be": (row([FIRST]), {"first": FIRST_GOES}),
            "one has no plan": (meeting, {"first": FIRST_GOES}),
            "nobody has a plan": (meeting, {}),
            "the slow one has a plan": (meeting, {"new": slowly}),
            "not all can have plans": (row([FIRST, WEST]), {"first": waits}),
            "nobody": (row([]), {}),
        },
    )


BLOCK = Group("block", ("b", "c"))
"""The two cells in the middle of a row, for one robot at a time."""


def _through_groups() -> Iterator[Case]:
    yield _query("moves within a group", grouped(row([EAST]), BLOCK))
    before = row([Robot("first", "b", "d"), EAST])
    slowly: Sequence[Stay] = [("b", 0, 2), ("c", 2, 4), ("d", 4, 5)]
    yield _query("the whole group is taken", grouped(before, BLOCK), first=slowly)
    yield _query("a group has room for two", grouped(before, replace(BLOCK, capacity=2)), first=slowly)
    yield _query("groups overlap", grouped(before, BLOCK, Group("end", ("c", "d"))), first=slowly)
    turning = _turning()
    goes: Sequence[Stay] = [("p", 0, 1), ("c", 1, 2), ("d", 2, 3)]
    behind = [("a", 0, 2), ("b", 2, 4), ("c", 4, 5), ("d", 5, 6)]
    exchanges, follows = ([("c", 0, tick), ("b", tick, tick + 1), ("a", tick + 1, tick + 2)] for tick in (1, 2))
    yield _query("no exchange with a resource of the same group", turning, first=goes)
    yield from _cases_of(
        "check",
        {
            "two in a group": (grouped(before, BLOCK), {"first": slowly, "new": behind}),
            "exchange with a resource of the same group": (turning, {"first": goes, "new": exchanges}),
            "one after the other through a group": (turning, {"first": goes, "new": follows}),
        },
    )


def _turning() -> Instance:
    """A row whose second cell is split in two, b and p; each is joined to the third, which has room for two."""
    resources = tuple(
        Resource(each, 1 + (each == "c"), 1, x, 0) for each, x in zip("abpcd", (0, 1, 1, 2, 3), strict=True)
    )
    graph = ResourceGraph(
        resources, (("a", "b"), ("b", "c"), ("p", "c"), ("c", "d")), groups=(Group("cell", ("b", "p")),)
    )
    return Instance(graph, (Robot("first", "p", "d"), Robot("new", "c", "a")))


def smoke_cases(ops: Sequence[str], level: Level, whole: bool, groups: bool = False) -> Iterator[Case]:
    """The smoke cases; `whole`: of a program that plans whole instances by a planner of its own."""
    with_groups = {
        "one behind the other through a group": grouped(row([FIRST, Robot("new", "b", "d")]), BLOCK),
        "head-on beside a group": grouped(passing_place([FIRST, WEST]), Group("middle", ("b", "c"), 2)),
        "a cell is split": _turning(),
    }
    more = with_groups if groups else {}
    if whole:
        yield from _wholes("plan", {**INSTANCES, **more})
        return
    each = (
        *_alone(),
        *_with_others(),
        *_under_way(),
        *_wholes("plan", INSTANCES, Carp()),
        *_checks(),
        *_additions(),
        *_polishes(),
        *(_through_groups() if groups else ()),
        *_wholes("plan", more, Carp()),
    )
    yield from (case for case in each if case.op in ops)
    if "bound" in ops:
        yield from _wholes("bound", INSTANCES)
    if "optimum" in ops and level >= Level.COMPLETE:
        yield from _wholes("optimum", INSTANCES)
