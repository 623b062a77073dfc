"""Examples of every rule, by its id: what keeps it, and what breaks it.

An example holds the arguments of the rule's predicate. Where the predicate makes a choice or a figure, `claimed`
is the answer that somebody claims.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final, TypeAlias

from tests.spec.making import PARKED, PARKING, SOLVED, VANISHING, Stay, instance_on, line, plan_of, solution_of

from carp_spec import Carp, FixedPaths, Instance, Neighbourhood, Resource, ResourceGraph, Robot, Shuffled, Solution
from carp_spec.documents import INSTANCE_FORMAT, InstanceDocument
from carp_spec.permutations import splitmix64
from carp_spec.traces import Trace
from carp_spec.windows import Window

Stays: TypeAlias = tuple[Stay, ...]
NOTHING_CLAIMED: Final = object()


@dataclass(frozen=True)
class Example:
    arguments: tuple[Any, ...]
    claimed: Any = NOTHING_CLAIMED


def example(*arguments: object) -> Example:
    return Example(arguments)


def claim(claimed: object, *arguments: object) -> Example:
    return Example(arguments, claimed)


@dataclass(frozen=True)
class Examples:
    valid: tuple[Example, ...]
    invalid: tuple[Example, ...]


def with_resource(**fields: Any) -> Example:  # noqa: ANN401 - nonsense too
    graph = ResourceGraph((Resource("a"), replace(Resource("b"), **fields)), ())
    return example(Instance(graph, ()))


def with_robot(**fields: Any) -> Example:  # noqa: ANN401 - nonsense too
    return example(instance_on(line("ab"), Robot("r1", "a", "b"), replace(Robot("r2", "b", "a"), **fields)))


def with_edges(*edges: tuple[str, str], directed: bool = False) -> Example:
    return example(Instance(ResourceGraph((Resource("a"), Resource("b")), edges, directed), ()))


def first_visits(*stays: tuple[str, int, int | None]) -> Example:
    return example(VANISHING, plan_of("r1", *stays))


def second_plan(*stays: tuple[str, int, int | None]) -> Example:
    return example(VANISHING, [SOLVED[0], plan_of("r2", *stays)])


def whole(**fields: Any) -> Example:  # noqa: ANN401 - fields by name
    return example(VANISHING, replace(solution_of(SOLVED), **fields))


DOCUMENT = b'{"format":"carproof-instance/1","graph":{"nodes":[],"edges":[]},"after_goal":"park","robots":[]}'
FREE = [(2, 4), (3, 6), (8, None)]
ROW = instance_on(line("abcde"), Robot("r1", "a", "c"), Robot("r2", "e", "d", release=1))
WALK = plan_of("r1", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3))
STEP = plan_of("r2", ("e", 1, 2), ("d", 2, 3))
FREE_TICKS = replace(VANISHING, following="forbidden")
FOLLOWED = (plan_of("r1", ("a", 0, 1), ("c", 1, 3), ("d", 3, 4)), plan_of("r2", ("e", 0, 1), ("a", 1, 2)))
A_NOW: Stays = (("a", 0, None),)
E_NOW: Stays = (("e", 1, None),)
CROSSED = (
    instance_on(line("abcd"), Robot("r1", "b", "d"), Robot("r2", "a", "c")),
    solution_of(
        [
            plan_of("r1", ("b", 0, 1), ("c", 1, 2), ("d", 2, 3)),
            plan_of("r2", ("a", 0, 1), ("b", 1, 2), ("c", 2, 3)),
        ]
    ),
)
FREE_CROSSED = solution_of([CROSSED[1].plans[0], plan_of("r2", ("a", 0, 2), ("b", 2, 3), ("c", 3, 4))])
ROOMY = ResourceGraph((Resource("a", capacity=2), Resource("b", capacity=2)), (("a", "b"),))
EXCHANGED = (
    instance_on(ROOMY, Robot("r1", "a", "b"), Robot("r2", "b", "a")),
    solution_of([plan_of("r1", ("a", 0, 1), ("b", 1, 2)), plan_of("r2", ("b", 0, 2), ("a", 2, 3))]),
)
RING = ResourceGraph(line("abc").resources, (("a", "b"), ("b", "c"), ("c", "a")))
TURNING = (
    (Robot("r1", "a", "b"), Robot("r2", "b", "c"), Robot("r3", "c", "a")),
    tuple(plan_of(robot, (at, 0, 1), (to, 1, 2)) for robot, at, to in (("r1", *"ab"), ("r2", *"bc"), ("r3", *"ca"))),
)


def traced_on(planned: tuple[Instance, Solution], now: int, **done: Stays) -> Example:
    trace = Trace(now, tuple(plan_of(robot, *stays) for robot, stays in done.items()))
    return example(*planned, trace)


def traced(now: int, **done: Stays) -> Example:
    return traced_on((ROW, solution_of([WALK, STEP])), now, **done)


LEFT = traced(9, r1=(("a", 0, 1), ("b", 1, None)), r2=E_NOW)
LATER = traced_on(CROSSED, 5, r1=(("b", 0, 4), ("c", 4, None)), r2=(("a", 0, 4), ("b", 4, None)))

EXAMPLES: Mapping[str, Examples] = {
    "document/json": Examples(
        (example(DOCUMENT), example(b" 1e300\n"), example('"ř"'.encode()), example(b"1" * 100)),
        (
            example(b""),
            example(DOCUMENT[:-1]),
            example(DOCUMENT + b"{}"),
            example(b'"\xff"'),
            example(b"\xef\xbb\xbf1"),
            example(b'{"a":1,"a":1}'),
            example(b"-" + b"1" * 101),
            example(b"NaN"),
            example(b"1e400"),
            example(b"[" * 100_000),
            example(b'"\\ud800"'),
        ),
    ),
    "document/format": Examples(
        (example(DOCUMENT, INSTANCE_FORMAT), example(b'{"format":"x"}', "x")),
        (example(DOCUMENT, "carproof-solution/1"), example(b"{}", "x"), example(b"[]", "x"), example(b"{", "x")),
    ),
    "document/shape": Examples(
        (example(DOCUMENT, InstanceDocument),),
        (
            example(DOCUMENT.replace(b'"robots"', b'"fleet"'), InstanceDocument),
            example(DOCUMENT.replace(b"[]", b"{}"), InstanceDocument),
            example(DOCUMENT.replace(b'"park"', b"null"), InstanceDocument),
            example(b'"\xff"', InstanceDocument),
        ),
    ),
    "instance/resource-id": Examples(
        (with_resource(id=""), with_resource(id=-1)),
        (with_resource(id="a"), with_resource(id=None), with_resource(id=True), with_resource(id=1.0)),
    ),
    "instance/capacity": Examples(
        (with_resource(capacity=1), with_resource(capacity=10**30)),
        (with_resource(capacity=0), with_resource(capacity=True), with_resource(capacity=2.0)),
    ),
    "instance/duration": Examples(
        (with_resource(duration=1), with_resource(duration=7)),
        (with_resource(duration=0), with_resource(duration=-1), with_resource(duration="1")),
    ),
    "instance/position": Examples(
        (with_resource(), with_resource(x=0, y=-3)),
        (with_resource(x=1), with_resource(y=1), with_resource(x=1.0, y=1), with_resource(x=False, y=0)),
    ),
    "instance/edge": Examples(
        (with_edges(), with_edges(("a", "b")), with_edges(("a", "b"), ("b", "a"), directed=True)),
        (
            with_edges(("a", "x")),
            with_edges(("x", "b")),
            with_edges(("a", "a")),
            with_edges(("a", "b"), ("b", "a")),
            with_edges(("a", "b"), ("a", "b"), directed=True),
        ),
    ),
    "instance/robot-id": Examples(
        (with_robot(), with_robot(id=1)),
        (with_robot(id="r1"), with_robot(id=False), with_robot(id=())),
    ),
    "instance/endpoint": Examples(
        (with_robot(), with_robot(goal="b")),
        (with_robot(start="x"), with_robot(goal="x"), with_robot(goal=None)),
    ),
    "instance/release": Examples(
        (with_robot(release=0), with_robot(release=9)),
        (with_robot(release=-1), with_robot(release=None), with_robot(release=False)),
    ),
    "instance/pace": Examples(
        (with_robot(pace=1), with_robot(pace=3)),
        (with_robot(pace=0), with_robot(pace=1.5), with_robot(pace=True)),
    ),
    "instance/after-goal": Examples(
        (example(VANISHING), example(PARKING)),
        (example(replace(PARKING, after_goal="stay")), example(replace(PARKING, after_goal=None))),  # type: ignore[arg-type]
    ),
    "instance/following": Examples(
        (example(VANISHING), example(replace(VANISHING, following="forbidden"))),
        (example(replace(VANISHING, following=True)), example(replace(VANISHING, following=""))),  # type: ignore[arg-type]
    ),
    "solution/covers": Examples(
        (whole(), whole(plans=SOLVED[:2], unplanned=("r3",)), example(VANISHING, Solution((), (), ("r3", "r2", "r1")))),
        (
            whole(plans=SOLVED[:2]),
            whole(plans=(*SOLVED, SOLVED[0])),
            whole(unplanned=("r1",)),
            whole(unplanned=("r9",)),
            whole(plans=(*SOLVED, plan_of("r9"))),
        ),
    ),
    "solution/order": Examples(
        (whole(), whole(order=("r3", "r1", "r2"))),
        (whole(order=("r1", "r2")), whole(order=("r1", "r2", "r3", "r1")), whole(plans=SOLVED[:2])),
    ),
    "plan/start": Examples(
        (example(VANISHING, SOLVED[0]), first_visits(("a", 0, None))),
        (first_visits(), first_visits(("a", 1, 2)), first_visits(("b", 0, 1))),
    ),
    "plan/goal": Examples(
        (example(VANISHING, SOLVED[0]), example(PARKING, PARKED[0]), first_visits(("d", 3, 4))),
        (
            first_visits(),
            first_visits(("d", 3, 5)),
            first_visits(("d", 3, None)),
            first_visits(("e", 3, 4)),
            example(PARKING, SOLVED[0]),
        ),
    ),
    "plan/resource": Examples((first_visits(), first_visits(("e", 9, 0))), (first_visits(("x", 0, 1)),)),
    "plan/move": Examples(
        (first_visits(("a", 0, 1), ("b", 5, 6), ("a", 6, 7)), first_visits(("a", 0, 1), ("x", 1, 2))),
        (
            first_visits(("a", 0, 1), ("c", 1, 3)),
            first_visits(("a", 0, 1), ("a", 1, 2)),
            example(
                instance_on(line("ab", directed=True), Robot("r1", "b", "a")), plan_of("r1", ("b", 0, 1), ("a", 1, 2))
            ),
        ),
    ),
    "plan/contiguous": Examples(
        (first_visits(("a", 0, 1), ("d", 1, 2)), first_visits(("a", 0, 1))),
        (
            first_visits(("a", 0, 1), ("b", 2, 3)),
            first_visits(("a", 0, 2), ("b", 1, 3)),
            first_visits(("a", 0, None), ("b", 1, 3)),
        ),
    ),
    "plan/duration": Examples(
        (first_visits(("a", 0, 1), ("c", 0, 2)), first_visits(("c", 0, None)), first_visits(("x", 0, 0))),
        (
            first_visits(("a", 0, 0)),
            first_visits(("c", 0, 1)),
            example(instance_on(line("a"), Robot("r1", "a", "a", pace=2)), plan_of("r1", ("a", 0, 1))),
        ),
    ),
    "joint/capacity": Examples(
        (example(VANISHING, SOLVED), second_plan(("b", 2, 9)), second_plan(("a", 2, None)), second_plan(("x", 0, 9))),
        (
            second_plan(("a", 1, 2)),
            second_plan(("c", 2, 4)),
            second_plan(("d", 0, None)),
            example(VANISHING, [plan_of(robot, ("b", 0, 9)) for robot in ("r1", "r2", "r3")]),
        ),
    ),
    "joint/exchange": Examples(
        (
            example(VANISHING, SOLVED),
            second_plan(("b", 0, 3), ("a", 3, 4)),
            second_plan(("e", 1, 2), ("b", 2, 3), ("c", 3, 4)),
        ),
        (second_plan(("b", 0, 2), ("a", 2, 3)), second_plan(("c", 1, 3), ("b", 3, 4))),
    ),
    "joint/following": Examples(
        (
            example(VANISHING, FOLLOWED),
            example(FREE_TICKS, FOLLOWED[:1]),
            example(FREE_TICKS, [FOLLOWED[0], plan_of("r2", ("e", 0, 5), ("d", 5, 6))]),
        ),
        (
            example(FREE_TICKS, FOLLOWED),
            example(FREE_TICKS, [FOLLOWED[0], plan_of("r2", ("a", 1, 2))]),
            example(FREE_TICKS, [FOLLOWED[0], plan_of("r2", ("c", 3, 5))]),
        ),
    ),
    "cost/robot": Examples(
        (example(VANISHING, SOLVED[0], 5), example(VANISHING, SOLVED[1], 3), example(VANISHING, SOLVED[2], 0)),
        (example(VANISHING, SOLVED[0], 6), example(VANISHING, SOLVED[0], 4)),
    ),
    "cost/total": Examples(
        (example(VANISHING, SOLVED, 8), example(VANISHING, (), 0)),
        (example(VANISHING, SOLVED, 9), example(VANISHING, SOLVED, 7)),
    ),
    "window/free": Examples(
        (
            example([Window(0, 2), Window(6, 8)], FREE, 1),
            example([Window(0, 3), Window(4, None)], FREE, 2),
            example([Window(0, None)], FREE, 3),
            example([], [(0, None)], 1),
            example([Window(0, 1)], FREE, 1, 1),
            example([Window(0, 2), Window(5, None)], FREE, 2, 1),
        ),
        (
            example([Window(0, 2)], FREE, 1),
            example([Window(0, 2), Window(6, 7), Window(7, 8)], FREE, 1),
            example([Window(0, 2), Window(4, 4), Window(6, 8)], FREE, 1),
            example([Window(0, None)], FREE, 2),
            example([Window(4, None), Window(0, 3)], FREE, 2),
            example([Window(0, 2), Window(7, 8)], FREE, 1, 1),
            example([Window(0, 1), Window(7, 7)], FREE, 1, 1),
            example([Window(0, 1), Window(6, 7)], FREE, 1, 1),
        ),
    ),
    "window/fits": Examples(
        (
            example(Window(2, 5), 2, 5, 3),
            example(Window(2, 5), 2, 4, 2),
            example(Window(2, None), 7, 9, 2),
            example(Window(2, None), 2, None, 9),
        ),
        (
            example(Window(2, 5), 1, 4, 3),
            example(Window(2, 5), 3, 6, 3),
            example(Window(2, 5), 2, 4, 3),
            example(Window(2, 5), 2, None, 3),
        ),
    ),
    "query/sound": Examples(
        (example(VANISHING, SOLVED[:1], SOLVED[1]), example(VANISHING, (), SOLVED[2])),
        (
            example(VANISHING, SOLVED[:1], plan_of("r2", ("e", 1, 2), ("b", 2, 3), ("a", 3, 5))),
            example(VANISHING, [plan_of("r1", ("a", 4, 9))], SOLVED[1]),
        ),
    ),
    "query/optimal": Examples(
        (
            example(ROW, (), WALK, [WALK, plan_of("r1", ("c", 0, 1))]),
            example(ROW, [plan_of("r2", ("a", 1, 2))], WALK, []),
        ),
        (example(ROW, (), plan_of("r1", ("a", 0, 2), ("b", 2, 3), ("c", 3, 4)), [STEP, WALK]),),
    ),
    "query/complete": Examples(
        (
            example(ROW, (), []),
            example(ROW, (), [plan_of("r1", ("c", 0, 1))]),
            example(ROW, [plan_of("r2", ("e", 1, 2), ("d", 2, 3), ("c", 2, 3))], [WALK]),
        ),
        (example(ROW, (), [WALK]), example(ROW, [STEP], [plan_of("r1"), WALK])),
    ),
    "query/ties": Examples(
        (
            claim(True, (5, 3, 0, 0), (6, 4, 0, 0)),
            claim(True, (5, 4, 9, 9), (5, 3, 0, 0)),
            claim(True, (5, 3, 1, 9), (5, 3, 2, 0)),
            claim(True, (5, 3, 1, 2), (5, 3, 1, 4)),
        ),
        (claim(True, (5, 3, 0, 0), (5, 4, 1, 1)), claim(True, (5, 3, 1, 1), (5, 3, 1, 0))),
    ),
    "neighbourhood/baseline": Examples(
        (claim(True, True, 3), claim(True, False, 0), claim(False, False, 1)),
        (claim(True, False, 3), claim(False, True, 1), claim(False, False, 0)),
    ),
    "neighbourhood/nearest": Examples(
        (
            claim(1, [[Fraction(3), Fraction(2)], [Fraction(9), Fraction(1)]]),
            claim(0, [[Fraction(1)], [Fraction(1)]]),
        ),
        (
            claim(0, [[Fraction(3), Fraction(2)], [Fraction(9), Fraction(1)]]),
            claim(1, [[Fraction(1)], [Fraction(1)]]),
        ),
    ),
    "neighbourhood/distance": Examples(
        (
            claim(Fraction(2**16 * (4 + 3 + 1), 3), ROW, WALK, STEP),
            claim(Fraction(0), ROW, WALK, WALK),
        ),
        (claim(Fraction(2**16 * (4 + 3 + 1), 2), ROW, WALK, STEP), claim(Fraction(8, 3), ROW, WALK, STEP)),
    ),
    "neighbourhood/replan": Examples((claim(2, 2, 5), claim(1, 4, 1)), (claim(5, 2, 5), claim(4, 4, 1))),
    "neighbourhood/orders": Examples(
        (
            claim([(0, 1), (1, 0)], 2, None, iter(())),
            claim([(0, 1), (1, 0)], 2, 2, iter(())),
            claim([(1, 2, 0), (2, 0, 1)], 3, 2, iter([1, 0, 0, 0])),
        ),
        (
            claim([(1, 0), (0, 1)], 2, None, iter(())),
            claim([(2, 0, 1), (1, 2, 0)], 3, 2, iter([1, 0, 0, 0])),
            claim([(0, 1, 2)], 3, 2, splitmix64(0)),
        ),
    ),
    "neighbourhood/best": Examples(
        (example(7, None), example(6, 7)),
        (example(7, 7), example(8, 7), example(1, 0)),
    ),
    "neighbourhood/update": Examples(
        (claim(WALK, STEP, WALK), claim(STEP, STEP, None)),
        (claim(STEP, STEP, WALK), claim(None, STEP, None)),
    ),
    "polish/draws": Examples(
        (claim(["c", "a"], "abc", 2, iter([2, 1])), claim([], "abc", 0, iter(()))),
        (claim(["a", "c"], "abc", 2, iter([2, 1])), claim(["b", "a"], "abc", 2, iter([2, 1]))),
    ),
    "polish/kind": Examples(
        (
            claim("repair", 0, 1, 5, iter(())),
            claim("repair", 1, 1, 0, iter(())),
            claim("contested", 1, 1, 5, iter([18])),
            claim(None, 2, 0, 0, iter(())),
        ),
        (claim("repair", 1, 1, 5, iter([0])), claim("near", 0, 0, 5, iter([8])), claim("delayed", 0, 1, 5, iter([0]))),
    ),
    "polish/pivot": Examples(
        (claim(2, [2, 0, 3], iter([7])), claim(0, [2, 0, 3], iter([6]))),
        (claim(1, [2, 0, 3], iter([2])), claim(2, [2, 0, 3], iter([1]))),
    ),
    "polish/members": Examples(
        (
            claim(["p", "c", "a", "b"], "p", "cabd", "abcdp", iter([0])),
            claim(["p", "c", "b", "a"], "p", "c", "abcp", iter([6, 1, 0])),
        ),
        (
            claim(["p", "a", "b", "c"], "p", "cabd", "abcdp", iter([0])),
            claim(["p", "c"], "p", "c", "abcp", iter([0] * 3)),
        ),
    ),
    "polish/way": Examples(
        (
            claim(True, {"b": (2, 4)}, plan_of("r", ("a", 0, 4), ("b", 4, 9))),
            claim(True, {"b": (2, None)}, plan_of("r", ("b", 0, 2))),
            claim(False, {"b": (2, 4)}, plan_of("r", ("b", 0, 1), ("a", 1, 5), ("b", 5, None))),
        ),
        (
            claim(False, {"b": (2, 4)}, plan_of("r", ("b", 0, None))),
            claim(True, {"b": (2, 4)}, plan_of("r", ("a", 0, 9), ("c", 9, 10))),
        ),
    ),
    "polish/contested": Examples(
        (
            claim(1, WALK.visits[1], plan_of("r", ("b", 0, 1), ("c", 1, 7), ("b", 7, 8))),
            claim(None, WALK.visits[1], plan_of("r", ("a", 0, 1))),
        ),
        (
            claim(6, WALK.visits[1], plan_of("r", ("b", 0, 1), ("c", 1, 7), ("b", 7, 8))),
            claim(0, WALK.visits[1], plan_of("r", ("a", 0, 1))),
        ),
    ),
    "polish/near": Examples(
        (claim([1, 0, 2], [Fraction(2), Fraction(1), Fraction(2)]), claim([], [])),
        (claim([1, 2, 0], [Fraction(2), Fraction(1), Fraction(2)]), claim([0, 1], [Fraction(2), Fraction(1)])),
    ),
    "polish/order": Examples(
        (
            claim(("p", "b", "a"), "pab", True, iter([0])),
            claim(("p", "b", "a"), "pab", False, iter([4, 0])),
            claim(("b", "a", "p"), "pab", False, iter([1, 0, 1])),
        ),
        (claim(("b", "p", "a"), "pab", True, iter([0])), claim(("p", "a", "b"), "pab", False, iter([1, 0, 1]))),
    ),
    "polish/kept": Examples(
        (example((1, 5), (0, 9)), example((0, 5), (0, 5)), example((0, 5), (0, 4))),
        (example((0, 5), (1, 1)), example((0, 5), (0, 6))),
    ),
    "polish/options": Examples(
        (example(None, None, 0), example(0, None, 2**64 - 1), example(None, 0.5, 7)),
        (
            example(1, 1, 0),
            example(-1, None, 0),
            example(True, None, 0),
            example(None, 0, 0),
            example(None, float("inf"), 0),
            example(None, None, -1),
        ),
    ),
    "fleet/history": Examples(
        (
            example(SOLVED[0], SOLVED[0], 3),
            example(SOLVED[0], plan_of("r1", ("a", 0, 2), ("b", 2, 9), ("e", 9, 10)), 2),
            example(SOLVED[0], plan_of("r1", ("a", 0, 1)), 1),
            example(SOLVED[0], plan_of("r1"), -1),
            example(SOLVED[0], SOLVED[0], 99),
        ),
        (
            example(SOLVED[0], plan_of("r1", ("a", 0, 1), ("b", 1, 3)), 2),
            example(SOLVED[0], plan_of("r1", ("a", 0, 1), ("b", 1, 2)), 3),
            example(SOLVED[0], plan_of("r1", ("c", 0, 2)), 0),
            example(SOLVED[0], plan_of("r1"), 0),
            example(SOLVED[0], plan_of("r1", ("a", 0, 2), ("b", 2, 2)), 3),
            example(SOLVED[2], plan_of("r3", ("f", 0, 1), ("c", 1, 3)), 1),
        ),
    ),
    "trace/robots": Examples(
        (traced(0, r1=A_NOW, r2=()), traced(2, r2=E_NOW, r1=A_NOW)),
        (traced(0, r1=A_NOW), traced(2, r1=A_NOW, r2=E_NOW, r3=()), example(*traced(2, r2=E_NOW).arguments)),
    ),
    "trace/prefix": Examples(
        (traced(2, r1=(("a", 0, 1), ("b", 1, None)), r2=E_NOW),),
        (
            traced(2, r1=(("b", 0, None),), r2=E_NOW),
            traced(9, r1=A_NOW, r2=(("e", 1, 2), ("d", 2, 3), ("e", 3, None))),
        ),
    ),
    "trace/ticks": Examples(
        (
            traced(2, r1=(("a", 1, 2), ("b", 2, None)), r2=E_NOW),
            traced(9, r1=A_NOW, r2=(("e", 1, 2), ("d", 2, 3))),
        ),
        (
            traced(2, r1=A_NOW, r2=(("e", 0, None),)),
            traced(2, r1=(("a", 0, 1), ("b", 2, None)), r2=E_NOW),
            traced(2, r1=(("a", 0, None), ("b", 1, None)), r2=E_NOW),
            traced(2, r1=(("a", 0, 3),), r2=E_NOW),
            traced(2, r1=(("a", 0, 2),), r2=E_NOW),
            traced(2, r1=(("a", 3, None),), r2=E_NOW),
            traced(4, r1=(("a", 2, 1), ("b", 1, None)), r2=E_NOW),
            example(replace(ROW, after_goal="park"), *traced(9, r2=(("e", 1, 2), ("d", 2, 3))).arguments[1:]),
        ),
    ),
    "execution/duration": Examples(
        (traced(9, r1=(("a", 0, 5), ("b", 5, None)), r2=E_NOW),),
        (
            example(replace(ROW, robots=(replace(ROW.robots[0], pace=2), ROW.robots[1])), *LEFT.arguments[1:]),
            traced(9, r1=A_NOW, r2=(("e", 1, 2), ("d", 2, 2))),
        ),
    ),
    "execution/order": Examples(
        (LATER, traced_on(CROSSED, 2, r1=(("b", 0, 1), ("c", 1, 2), ("d", 2, None)), r2=(("a", 0, 1), ("b", 1, None)))),
        (
            traced_on(CROSSED, 2, r1=(("b", 0, None),), r2=(("a", 0, 2), ("b", 2, None))),
            traced_on(CROSSED, 3, r1=(("b", 0, 2), ("c", 2, None)), r2=(("a", 0, 1), ("b", 1, None))),
            example(replace(LATER.arguments[0], following="forbidden"), FREE_CROSSED, LATER.arguments[2]),
        ),
    ),
    "execution/exchange": Examples(
        (
            traced_on(EXCHANGED, 5, r1=(("a", 0, 3), ("b", 3, None)), r2=(("b", 0, 4), ("a", 4, None))),
            traced_on(EXCHANGED, 5, r1=(("a", 0, None),), r2=(("b", 0, None),)),
        ),
        (
            traced_on(EXCHANGED, 5, r1=(("a", 0, 3), ("b", 3, None)), r2=(("b", 0, 3), ("a", 3, None))),
            traced_on(EXCHANGED, 5, r1=(("a", 0, None),), r2=(("b", 0, 3), ("a", 3, None))),
            traced_on(EXCHANGED, 5, r1=(("a", 0, 4), ("b", 4, None)), r2=(("b", 0, 3), ("a", 3, None))),
        ),
    ),
    "execution/acyclic": Examples(
        (
            example(VANISHING, solution_of(SOLVED)),
            example(VANISHING, solution_of(PARKED)),
            example(*CROSSED),
            example(*EXCHANGED),
        ),
        (
            example(instance_on(RING, *TURNING[0]), solution_of(TURNING[1])),
            example(instance_on(RING, *TURNING[0], after_goal="park"), solution_of(TURNING[1])),
        ),
    ),
    "planner/options": Examples(
        (
            example(Carp()),
            example(Shuffled(attempts=1, seed=2**64 - 1)),
            example(Neighbourhood(m=1, sample=1_000_000, fallback=1, baseline=False)),
            example(FixedPaths(k=1, paths="disjoint")),
        ),
        (
            example(Shuffled(attempts=0)),
            example(Shuffled(seed=2**64)),
            example(Shuffled(seed=-1)),
            example(Neighbourhood(m=True)),
            example(Neighbourhood(sample=1_000_001)),
            example(Neighbourhood(baseline=1)),  # type: ignore[arg-type]
            example(Neighbourhood(m=None)),  # type: ignore[arg-type]
            example(FixedPaths(paths="long")),  # type: ignore[arg-type]
        ),
    ),
}
