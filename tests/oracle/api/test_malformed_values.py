"""Every public function refuses what the reader of its document refuses, by the same rule and at the same path."""

import cProfile
import json
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial, reduce
from inspect import isfunction, signature
from pathlib import Path
from typing import Any

import pytest
from msgspec import structs

import carp_optimized
import carp_reference
import carp_spec
import carproof
from carp_optimum.sat.proving import write_proof
from carp_spec import (
    Carp,
    FixedPaths,
    Instance,
    Neighbourhood,
    Plan,
    Refusal,
    Resource,
    ResourceGraph,
    Robot,
    Shuffled,
    Solution,
    Stop,
    Visit,
)
from carp_spec.documents.instances import digest, read_instance, write_instance
from carp_spec.documents.query_certificates import QUERY_FORMAT, QueryCertificateDocument
from carp_spec.documents.solutions import read_solution, write_solution, write_trace
from carp_spec.execution.traces import Trace
from carp_spec.inputs.values import RECENT
from carp_spec.shapes import of_shape
from carp_verify.certificate import certify
from carp_verify.optimum.joint_search import least_total_cost
from carproof import Delay
from carproof.formats import named_as, write_foreign_solution
from carproof.generate import Fleet, Grid, Range, Traits, Warehouse, grid_instance, warehouse_instance

UNLOOKED_AT = ("conforms", "steps", "find")
"""The functions that find a fault in any value, and whose values the law has looked at before."""
RIGHT = Instance(
    ResourceGraph((Resource("a"), Resource("b", 2), Resource("c", x=1, y=2)), (("a", "b"), ("b", "c"))),
    (Robot("r", "a", "c"), Robot("s", "a", "b", release=2)),
)
OF_R = Plan("r", (Visit("a", 0, 1), Visit("b", 1, 2), Visit("c", 2, 3)))
OF_S = Plan("s", (Visit("a", 2, 3), Visit("b", 3, 4)))
SOLVED = Solution((OF_R, OF_S), ("r", "s"))
ALONE = Solution((OF_R,), ("r",), ("s",))
NOTHING = Trace(0, ())
CERTIFICATE = QueryCertificateDocument(QUERY_FORMAT, "r", 0, 2, (), ())


def with_node(**values: object) -> Instance:
    graph = RIGHT.graph
    changed = replace(graph.resources[1], **values)  # type: ignore[arg-type] # nonsense is what is asked
    return replace(RIGHT, graph=replace(graph, resources=(graph.resources[0], changed, graph.resources[2])))


def with_robot(**values: object) -> Instance:
    return replace(RIGHT, robots=(RIGHT.robots[0], replace(RIGHT.robots[1], **values)))  # type: ignore[arg-type]


def with_graph(**values: object) -> Instance:
    return replace(RIGHT, graph=replace(RIGHT.graph, **values))  # type: ignore[arg-type]


def with_plan(**values: object) -> Solution:
    return replace(SOLVED, plans=(replace(OF_R, **values), OF_S))  # type: ignore[arg-type]


def with_visit(*visit: object) -> Solution:
    return with_plan(visits=(OF_R.visits[0], Visit(*visit), OF_R.visits[2]))  # type: ignore[arg-type]


NODE, ROBOT = ("graph", "nodes", 1), ("robots", 1)
INSTANCES: Sequence[tuple[Callable[[], Instance], tuple[str | int, ...], object]] = (
    (lambda: with_node(duration=0.5), (*NODE, "duration"), 0.5),
    (lambda: with_node(duration=0), (*NODE, "duration"), 0),
    (lambda: with_node(duration=True), (*NODE, "duration"), True),
    (lambda: with_node(capacity=0), (*NODE, "capacity"), 0),
    (lambda: with_node(capacity=None), (*NODE, "capacity"), None),
    (lambda: with_node(x=1), (*NODE, "x"), 1),
    (lambda: with_node(x="1", y=1), (*NODE, "x"), "1"),
    (lambda: with_node(id=True), (*NODE, "id"), True),
    (lambda: with_node(id="a"), (*NODE, "id"), "a"),
    (lambda: with_graph(edges=(("a", "b"), ("b", "z"))), ("graph", "edges", 1, "target"), "z"),
    (lambda: with_graph(edges=(("a", "b"), (0.5, "c"))), ("graph", "edges", 1, "source"), 0.5),
    (lambda: with_graph(edges=(("a", "b"), ("b", "b"))), ("graph", "edges", 1, "target"), "b"),
    (lambda: with_graph(resources=[*RIGHT.graph.resources]), ("graph", "nodes"), None),
    (lambda: with_graph(directed=1), ("graph", "directed"), 1),
    (lambda: with_robot(id="r"), (*ROBOT, "id"), "r"),
    (lambda: with_robot(id=None), (*ROBOT, "id"), None),
    (lambda: with_robot(goal="z"), (*ROBOT, "goal"), "z"),
    (lambda: with_robot(release=-1), (*ROBOT, "release"), -1),
    (lambda: with_robot(pace=0), (*ROBOT, "pace"), 0),
    (lambda: replace(RIGHT, robots=[*RIGHT.robots]), ("robots",), None),  # type: ignore[arg-type]
    (lambda: replace(RIGHT, after_goal="stay"), ("after_goal",), "stay"),  # type: ignore[arg-type]
    (lambda: replace(RIGHT, following=None), ("following",), None),  # type: ignore[arg-type]
)
"""A malformed instance, and the place and value that make its document malformed."""

FIRST = ("plans", 0)
VISIT = (*FIRST, "visits", 1)
SOLUTIONS: Sequence[tuple[Callable[[], Solution], tuple[str | int, ...], object]] = (
    (lambda: with_visit("b", 1.0, 2), (*VISIT, 1), 1.0),
    (lambda: with_visit("b", None, 2), (*VISIT, 1), None),
    (lambda: with_visit("b", 1, True), (*VISIT, 2), True),
    (lambda: with_visit(0.5, 1, 2), (*VISIT, 0), 0.5),
    (lambda: with_plan(robot=None), (*FIRST, "robot"), None),
    (lambda: with_plan(visits=[*OF_R.visits]), (*FIRST, "visits"), None),
    (lambda: replace(SOLVED, plans=[*SOLVED.plans]), ("plans",), None),  # type: ignore[arg-type]
    (lambda: replace(SOLVED, order=("r", 1.5)), ("order", 1), 1.5),  # type: ignore[arg-type]
    (lambda: replace(SOLVED, unplanned=None), ("unplanned",), None),  # type: ignore[arg-type]
)

GIVEN: Mapping[str, object] = {
    "instance": RIGHT,
    "solution": SOLVED,
    "plans": SOLVED.plans,
    "plan": OF_R,
    "committed": (),
    "robot": "s",
    "now": 0,
    "options": Neighbourhood(),
    "stops": [Stop("c")],
    "trace": NOTHING,
    "log": NOTHING,
    "ready": ["r"],
    "grants": (),
    "driver": "order",
    "data": write_solution(SOLVED),
    "format": "carproof",
    "certificate": CERTIFICATE,
    "best": None,
    "proof": Path("nowhere"),
    "directory": Path("nowhere"),
    "planner": Carp(),
    "iterations": 1,
    "steps": 1,
}
"""A right value of each parameter; what is wrong with an instance or a solution is told before one with `None`."""
INNER = (certify, least_total_cost, digest, named_as)
FUNCTIONS: Mapping[str, Callable[..., object]] = {
    f"{module.__name__}.{name}": getattr(module, name)
    for module in (carproof, carp_spec, carp_optimized, carp_reference)
    for name in module.__all__
    if isfunction(getattr(module, name)) and name not in UNLOOKED_AT
} | {each.__name__: each for each in (carproof.Fleet, *INNER)}


def taking(parameter: str) -> list[str]:
    """The functions that take such a value."""
    return [name for name, function in FUNCTIONS.items() if parameter in signature(function).parameters]


def required(name: str) -> list[str]:
    """The parameters of a function that have no default."""
    return [each.name for each in signature(FUNCTIONS[name]).parameters.values() if each.default is each.empty]


def refused(call: Callable[[], object]) -> tuple[str, str, str]:
    with pytest.raises(Refusal) as caught:
        call()
    return caught.value.kind, caught.value.rule, caught.value.path


def refused_document(
    document: bytes, place: tuple[str | int, ...], value: object, read: Callable[[bytes], object]
) -> tuple[str, str, str]:
    """The refusal of the document with another value at a place."""
    whole = json.loads(document)
    *way, last = place
    reduce(lambda inside, step: inside[step], way, whole)[last] = value
    return refused(lambda: read(json.dumps(whole).encode()))


def refused_with(name: str, parameter: str, make: Callable[[], object]) -> tuple[str, str, str]:
    """The refusal of a function that has right values, but for one."""
    right = {each: GIVEN[each] for each in required(name) if each in GIVEN}
    return refused(lambda: FUNCTIONS[name](**right | {parameter: make()}))


@pytest.mark.parametrize("name", taking("instance"))
def test_a_malformed_instance_is_refused_like_its_document(name: str) -> None:
    for make, place, value in INSTANCES:
        by_document = refused_document(write_instance(RIGHT), place, value, read_instance)
        assert refused_with(name, "instance", make) == by_document, place


def plans_of(make: Callable[[], Solution]) -> Sequence[Plan]:
    return make().plans


PLANS_TAKEN = [(name, each) for each in ("solution", "committed") for name in taking(each)]


@pytest.mark.parametrize(("name", "parameter"), [*PLANS_TAKEN, ("carp_spec.violations_of", "plans")])
def test_malformed_plans_are_refused_like_their_document(name: str, parameter: str) -> None:
    for make, place, value in SOLUTIONS:
        if parameter == "solution" or place[:2] == FIRST:
            taken = make if parameter == "solution" else partial(plans_of, make)
            by_document = refused_document(write_solution(SOLVED), place, value, read_solution)
            assert refused_with(name, parameter, taken) == by_document, place


@pytest.mark.parametrize("name", [name for name in FUNCTIONS if name.startswith("carproof.")])
def test_values_of_other_classes_are_refused(name: str) -> None:
    for wrong in ("{}", None, 5) if required(name) else ():
        refused(partial(FUNCTIONS[name], **dict.fromkeys(required(name), wrong)))


def test_an_instance_of_which_no_look_ups_can_be_made_is_refused() -> None:
    for nodes, edges in (((Resource([]),), ()), ((None,), ()), ((Resource("a"),), (("a",),))):  # type: ignore[arg-type]
        assert refused(lambda: ResourceGraph(nodes, edges))[1] == "document/shape"  # type: ignore[arg-type] # noqa: B023
    assert refused(lambda: replace(RIGHT, robots=(None,))) == ("document", "document/shape", "$.robots[0]")  # type: ignore[arg-type]


ENGINES = [carp_optimized, carp_reference]
SAME = Neighbourhood()
PAST = Plan("r", OF_R.visits[:2])
TWICE = replace(SOLVED, plans=(OF_R, OF_R))


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize(
    ("ask", "rule", "path"),
    [
        (lambda engine: engine.add(RIGHT, SOLVED, "s", 0, SAME), "request/robot", "$.robot"),
        (lambda engine: engine.add(RIGHT, ALONE, "t", 0, SAME), "request/robot", "$.robot"),
        (lambda engine: engine.add(RIGHT, ALONE, "s", -1, SAME), "request/now", "$.now"),
        (lambda engine: engine.add(RIGHT, ALONE, "s", True, SAME), "request/now", "$.now"),
        (lambda engine: engine.add(RIGHT, replace(ALONE, order=()), "s", 0, SAME), "solution/order", "$.plans[0]"),
        (lambda engine: engine.add(RIGHT, replace(ALONE, unplanned=("s", "t")), "s", 0, SAME), "solution/covers", "$"),
        (lambda engine: engine.add(RIGHT, ALONE, "s", 0, Neighbourhood(m=0)), "planner/options", "$.m"),
        (lambda engine: engine.add(RIGHT, ALONE, "s", 0, Carp()), "planner/options", "$.planner"),
        (lambda engine: engine.query(RIGHT, (), "t"), "request/robot", "$.robot"),
        (lambda engine: engine.query(RIGHT, (), "r", 0.5), "request/now", "$.now"),
        (lambda engine: engine.query(RIGHT, 5, "r"), "document/shape", "$.plans"),
        (lambda engine: engine.query(RIGHT, (PAST,), "r", 9), "plan/goal", "$.plans[0].visits[1]"),
        (lambda engine: engine.query(RIGHT, (PAST,), "s", 9), "plan/goal", "$.plans[0].visits[1]"),
        (lambda engine: engine.query(RIGHT, (OF_R, OF_R), "s"), "solution/covers", "$.plans[0]"),
        (lambda engine: engine.plan(RIGHT, Shuffled(attempts=True)), "planner/options", "$.attempts"),
        (lambda engine: engine.plan(RIGHT, Shuffled(seed=1.0)), "planner/options", "$.seed"),  # type: ignore[arg-type]
        (lambda engine: engine.plan(RIGHT, Neighbourhood(baseline=1)), "planner/options", "$.baseline"),  # type: ignore[arg-type]
        (lambda engine: engine.plan(RIGHT, "carp"), "planner/options", "$.planner"),
        (lambda engine: engine.retime(RIGHT, SOLVED, Trace(-1, ())), "document/shape", "$.now"),
        (lambda engine: engine.polish(RIGHT, SOLVED, iterations=True), "polish/options", "$.iterations"),
        (lambda engine: engine.polish(RIGHT, SOLVED, seconds=0), "polish/options", "$.seconds"),
        (lambda engine: engine.polish(RIGHT, TWICE, iterations=1), "solution/covers", "$.plans[0]"),
    ],
)
def test_a_malformed_request_is_refused_like_its_op(
    ask: Callable[[Any], object],
    rule: str,
    path: str,
    engine: Any,  # noqa: ANN401 - a module
) -> None:
    assert refused(lambda: ask(engine))[1:] == (rule, path)


@pytest.mark.parametrize("engine", ENGINES)
def test_plans_that_collide_are_refused(engine: Any) -> None:  # noqa: ANN401 - a module
    crossing = replace(RIGHT, robots=(Robot("r", "a", "b"), Robot("s", "a", "c"), Robot("t", "b", "c")))
    plans = (Plan("r", (Visit("a", 0, 1), Visit("b", 1, 2))), Plan("s", (Visit("a", 0, 1), *OF_R.visits[1:])))
    expected = ("request", "joint/capacity", "$.plans[0].visits[0]")
    assert refused(lambda: engine.query(crossing, plans, "t")) == expected
    assert refused(lambda: engine.add(crossing, Solution(plans, ("r", "s"), ("t",)), "t", 0, SAME)) == expected
    assert engine.query(crossing, plans, "s") is None  # its own plan is its history, for which there is no room


def test_a_search_may_take_any_time_that_a_float_holds() -> None:
    assert carproof.optimum(RIGHT, 1e308).decided
    assert carproof.bound(RIGHT, seconds=1e308, steps=1).bound > 0


NO_DELAY: Any = [("r", 0, 1)]
NO_TICKS: Any = [Delay("r", 0, True)]
NO_FOOTPRINT: Any = (900, 600)
NONE: Any = None
INFINITE = float("inf")
HALF = replace(RIGHT.robots[0], id="r\ud800")
"""Of an id that no document can hold."""


def proved_by(**values: Any) -> int | None:  # noqa: ANN401 - nonsense is what is asked
    return carproof.verify_query(RIGHT, SOLVED, structs.replace(CERTIFICATE, **values))


def found(**values: Any) -> carproof.BoundDocument:  # noqa: ANN401
    return structs.replace(carproof.bound(RIGHT, steps=0), **values)


def imported_for(size: carproof.Footprint) -> carproof.Imported:
    layout = b"roadmap:\n  undirected: true\n  vertices: {a: [0, 0], b: [1, 0]}\n  edges: [[a, b]]\n"
    return carproof.import_layout(layout, settings=carproof.Settings(robots=0, footprint=size))


def far_away(x: int) -> Instance:
    return Instance(ResourceGraph((Resource("a", x=x, y=0), Resource("b")), (("a", "b"),)), (Robot("r", "a", "b"),))


@pytest.mark.parametrize(
    ("ask", "rule", "path"),
    [
        (lambda: carproof.execute(RIGHT, SOLVED, "order", NO_DELAY), "document/shape", "$.delays[0]"),
        (lambda: carproof.execute(RIGHT, SOLVED, "order", NO_TICKS), "document/shape", "$.delays[0].ticks"),
        (lambda: carproof.execute(RIGHT, SOLVED, "order", NONE), "document/shape", "$.delays"),
        (lambda: carproof.check_grants(RIGHT, SOLVED, NOTHING, NONE), "document/shape", "$.grants"),
        (lambda: carproof.check_update(NONE, (), 0), "document/shape", "$.before"),
        (lambda: carproof.check(RIGHT, SOLVED, footprint=NO_FOOTPRINT), "footprint/vehicle", "$.footprint"),
        (lambda: carproof.polish(RIGHT, SOLVED, seconds=10**400), "polish/options", "$.seconds"),
        (lambda: carproof.optimum(RIGHT, -1), "request/limit", "$.limit"),
        (lambda: carproof.optimum(RIGHT, True), "request/limit", "$.limit"),
        (lambda: carproof.bound(RIGHT, seconds=-1), "request/limit", "$.seconds"),
        (lambda: carproof.bound(RIGHT, steps=0.5), "request/limit", "$.steps"),  # type: ignore[arg-type]
        (lambda: carproof.bound(RIGHT, seconds=10**400), "request/limit", "$.seconds"),
        (lambda: carproof.optimum(RIGHT, None), "request/limit", "$.limit"),  # type: ignore[arg-type]
        (
            lambda: write_proof(RIGHT, carproof.optimum(RIGHT, 1), Path("nowhere"), float("nan")),
            "request/limit",
            "$.limit",
        ),
        (lambda: carproof.check(RIGHT, SOLVED, 0), "request/limit", "$.most"),
        (lambda: carproof.judge_log(RIGHT, NOTHING, 0), "request/limit", "$.most"),
        (lambda: carproof.audit(RIGHT, SOLVED, seconds=0), "request/limit", "$.seconds"),
        (lambda: carproof.check_grants(RIGHT, SOLVED, NOTHING, (), seconds=INFINITE), "request/limit", "$.seconds"),
        (lambda: carproof.judge_log(RIGHT, NOTHING, 2**64), "request/limit", "$.most"),
        (lambda: carp_spec.violations_of(RIGHT, SOLVED.plans, 0.5), "request/limit", "$.most"),  # type: ignore[arg-type]
        (lambda: grid_instance(Grid(width=2.0)), "generate/options", "$.width"),  # type: ignore[arg-type]
        (lambda: grid_instance(Grid(height=True)), "generate/options", "$.height"),
        (lambda: grid_instance(Grid(), Fleet(robots=Range(1, 2))), "generate/options", "$.robots"),  # type: ignore[arg-type]
        (lambda: grid_instance(Grid(), Fleet(pace=2)), "generate/options", "$.pace"),  # type: ignore[arg-type]
        (lambda: grid_instance(Grid(), Fleet(release=Range(0.5, 1))), "generate/options", "$.release"),  # type: ignore[arg-type]
        (lambda: warehouse_instance(Warehouse(), Fleet(after_goal="stay")), "generate/options", "$.after_goal"),  # type: ignore[arg-type]
        (lambda: warehouse_instance(Warehouse(), traits=Traits(capacity=2)), "generate/options", "$.capacity"),  # type: ignore[arg-type]
        (lambda: warehouse_instance(Grid()), "generate/options", "$.warehouse"),  # type: ignore[arg-type]
        (lambda: carp_reference.plan(RIGHT, FixedPaths(k=0)), "planner/options", "$.k"),
        (lambda: write_foreign_solution(RIGHT, SOLVED, "xlsx"), "adapter/format", "$.format"),
        (lambda: carproof.plan_cost(RIGHT, replace(OF_R, robot="t")), "solution/covers", "$"),
        (lambda: carproof.total_cost(RIGHT, [OF_R, Plan("s", ())]), "plan/start", "$.plans[1]"),
        (lambda: carproof.total_cost(RIGHT, [OF_R, NONE]), "document/shape", "$.plans[1]"),
        (lambda: carp_spec.violations_of(RIGHT, (OF_R, replace(OF_S, robot="t"))), "solution/covers", "$.plans[1]"),
        (lambda: write_trace(Trace(0.5, ())), "document/shape", "$.now"),  # type: ignore[arg-type]
        (lambda: carproof.optimum(RIGHT, processes=0), "request/limit", "$.processes"),
        (lambda: carproof.optimality_gap(RIGHT, NONE), "document/shape", "$.planners"),
        (lambda: carproof.plan(RIGHT, repair="no"), "document/shape", "$.repair"),  # type: ignore[arg-type]
        (lambda: carproof.audit(RIGHT, SOLVED, find_order="no"), "document/shape", "$.find_order"),  # type: ignore[arg-type]
        (lambda: carproof.Fleet(RIGHT, 0), "document/shape", "$"),  # type: ignore[arg-type]
        (lambda: carproof.release(RIGHT, SOLVED, NOTHING, NONE), "document/shape", "$.beyond"),
        (lambda: carproof.retime(RIGHT, SOLVED, NONE), "document/shape", "$"),
        (lambda: carproof.drive(RIGHT, SOLVED, Trace(0, (OF_R,)), ["r"]), "trace/robots", "$.plans"),
        (lambda: carproof.drive(RIGHT, SOLVED, Trace(4, SOLVED.plans), ["t"]), "request/robot", "$.ready"),
        (lambda: carproof.untangle(RIGHT, SOLVED, 0), "request/limit", "$.seconds"),
        (lambda: carproof.untangle(RIGHT, NONE), "document/shape", "$"),
        (lambda: carproof.give_way(RIGHT, SOLVED, "t"), "request/robot", "$.robot"),
        (lambda: carproof.give_way(RIGHT, SOLVED, "r", -1), "request/now", "$.now"),
        (lambda: carproof.give_way(RIGHT, SOLVED, "r", route=[NONE]), "document/shape", "$.route[0]"),
        (lambda: carproof.give_way(RIGHT, SOLVED, "r", route=[]), "plan/start", "$.route"),
        (lambda: carproof.view_map(RIGHT, at=True), "document/shape", "--at"),
        (lambda: carproof.stops_served(NONE, ()), "document/shape", "$.stops"),
        (lambda: carproof.stops_served((), NONE), "document/shape", "$.visits"),
        (lambda: carproof.total_cost(RIGHT, SOLVED), "document/shape", "$.plans"),  # type: ignore[arg-type]
        (lambda: carproof.verify_bound(RIGHT, b"{}"), "document/shape", "$"),  # type: ignore[arg-type]
        (lambda: carproof.verify_query(RIGHT, SOLVED, b"{}"), "document/shape", "$"),  # type: ignore[arg-type]
        (lambda: proved_by(bound=2.0), "document/shape", "$.bound"),
        (lambda: proved_by(labels=((NONE, 1),)), "document/shape", "$.labels[0][0]"),
        (lambda: proved_by(potential=(("b", float("nan")),)), "document/shape", "$.potential[0][1]"),
        (lambda: carproof.verify_bound(RIGHT, found(horizon=INFINITE)), "document/shape", "$.horizon"),
        (lambda: carproof.write_bound(found(resources=(("a", 1, 1.5),))), "document/shape", "$.resources[0][2]"),
        (lambda: carproof.planner_named("carp", NONE), "planner/options", "$.options"),
        (lambda: carproof.read_foreign_solution("text", RIGHT), "document/shape", "file"),  # type: ignore[arg-type]
        (lambda: carproof.write_orders(RIGHT, SOLVED, NONE), "order/settings", "$.orders"),
        (lambda: carproof.instance_from_array([[1]], [], [], "stay"), "document/shape", "$.after_goal"),  # type: ignore[arg-type]
        (lambda: carproof.instance_from_array([[1]], NONE, []), "adapter/array", "$.starts"),
        (lambda: write_foreign_solution(RIGHT, SOLVED, [NONE]), "document/shape", "$.format"),  # type: ignore[arg-type]
        (lambda: carproof.import_layout(b"", format=[NONE]), "document/shape", "$.format"),  # type: ignore[arg-type]
        (lambda: imported_for(carproof.Footprint(0, 600)), "footprint/vehicle", "$.footprint.length"),
        (lambda: imported_for(carproof.Footprint(900, 600, round=True)), "footprint/vehicle", "$.footprint"),
        (lambda: write_solution(Solution((), (), ("\ud800",))), "document/json", "$"),
        (lambda: carproof.read_movingai(b"", b"", -1), "movingai/scenario", "$.agents"),
        (lambda: carproof.conforms(NONE), "program/questions", "$.planner"),
        (lambda: carproof.conforms(carproof.plan, examples=-1), "program/questions", "$.examples"),
        (lambda: carproof.conforms(carproof.plan, without=NONE), "document/shape", "$.without"),
        (lambda: carproof.conforms(carproof.plan, large=NONE), "request/limit", "$.large"),
        (lambda: carproof.plan_within(far_away(10**20), iterations=1), "limit/ticks", "$.graph.nodes[0].x"),
        (lambda: carproof.plan(replace(RIGHT, robots=(HALF,))), "instance/robot-id", "$.robots[0].id"),
    ],
)
def test_other_malformed_arguments_are_refused(ask: Callable[[], object], rule: str, path: str) -> None:
    assert refused(ask)[1:] == (rule, path)


def test_none_is_no_solution_beside_one_that_is_gone() -> None:
    instance = replace(RIGHT)
    carproof.check(instance, replace(SOLVED))
    assert refused(lambda: carproof.audit(instance, NONE))[1:] == ("document/shape", "$")


class OwnPlan(Plan):
    """What a program may have that keeps more in a plan."""


def test_a_plan_of_a_class_derived_from_plan_is_a_plan() -> None:
    assert carproof.plan_cost(RIGHT, OwnPlan(OF_R.robot, OF_R.visits)) == carproof.plan_cost(RIGHT, OF_R)


def test_what_is_wrong_with_the_instance_is_not_blamed_on_further_stops() -> None:
    slow = with_graph(resources=(*RIGHT.graph.resources, Resource("d", duration=2**40)))
    ask = refused(lambda: carproof.assign(slow, SOLVED, "s", [Stop("c")], 2))
    assert ask == ("limit", "limit/ticks", "$.graph.nodes[3].duration")


def test_an_error_in_the_making_of_look_ups_is_no_refusal_if_all_values_are_of_their_types() -> None:
    def failing(_: Instance) -> None:
        raise ValueError("something else")

    with pytest.raises(ValueError, match="something else"):
        of_shape("$")(failing)(RIGHT)


def test_plans_that_broke_no_rule_are_not_judged_again_while_some_of_them_are_asked_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    instance = replace(RIGHT)
    carproof.check(instance, SOLVED)
    in_a_list: Any = [*SOLVED.plans]
    assert refused(lambda: carproof.check(instance, replace(SOLVED, plans=in_a_list)))[1:] == (
        "document/shape",
        "$.plans",
    )
    monkeypatch.setattr("carp_spec.requests.judge", lambda *_: pytest.fail("they were judged again"))
    others = [[replace(SOLVED, order=()) for _ in range(RECENT + 2)] for _ in range(2)]
    for looked_at, plan, robot in zip(others, SOLVED.plans, ("s", "r"), strict=True):
        for other in looked_at:
            assert not carproof.check(instance, other).valid
        assert carproof.query(instance, (plan,), robot) is not None


def test_a_graph_that_was_found_right_is_not_looked_at_again_with_other_robots() -> None:
    robot = Robot("r", "0,0", "1,0")
    plan = Plan("r", (Visit("0,0", 0, 1), Visit("1,0", 1, 2)))
    empty = carproof.instance_from_array([[1] * 60] * 60, starts=[], goals=[], after_goal="vanish")
    empty = replace(empty, graph=replace(empty.graph))

    def calls(robots: tuple[Robot, ...]) -> int:
        profile = cProfile.Profile()
        profile.runcall(carproof.total_cost, replace(empty, robots=robots), [plan])
        return sum(each.callcount for each in profile.getstats())

    first = calls((robot,))
    assert calls((robot, replace(robot, id="s"))) < first / 20
    wrong = refused(lambda: calls((robot, Robot("s", "0,0", "nowhere"))))
    assert wrong[1:] == ("instance/endpoint", "$.robots[1].goal")
