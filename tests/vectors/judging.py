"""carproof's own answer to a case, and the rules that are violated.

It asks the checker, the rules' predicates and the readable planner; tests hold every case equal to it.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias, cast

import msgspec

from carp_spec import (
    Instance,
    Neighbourhood,
    Plan,
    Refusal,
    ResourceGraph,
    RobotId,
    Solution,
    Visit,
    judge,
    neighbourhood_rules,
    plan_cost,
    polish_rules,
    total_cost,
    violations_of,
)
from carp_spec.documents.bounds import read_bound
from carp_spec.documents.decoding import is_json
from carp_spec.documents.query_certificates import read_query_certificate
from carp_spec.documents.solutions import read_solution, read_trace
from carp_spec.documents.vectors import Fields, Vector
from carp_spec.execution.execution_rules import is_acyclic, trace_violations
from carp_spec.instance_rules import after_goal_is_known, following_is_known
from carp_spec.permutations import splitmix64
from carp_spec.plan_rules import is_plan_cost, is_total_cost, plan_keeps_history
from carp_spec.query_rules import expansion_key
from carp_spec.windows import Window, free_windows, stay_fits, windows_are_free
from carp_verify.bound.rules import BOUND_RULES
from carp_verify.bound.verify import verify_bound
from carp_verify.optimum.joint_search import least_total_cost
from carp_verify.query.rules import QUERY_CERTIFICATE_RULES, plans_are_lawful, robot_is_known
from carp_verify.query.verify import verify_query
from carproof.execution.giving_way import robot_is_first
from carproof.planner_options import planner_named
from carproof.registry import RULES


@dataclass(frozen=True, slots=True)
class Finding:
    """The violated rules, in the order of the rules, and the right answer."""

    violated: tuple[str, ...]
    answer: Fields


def finding(subject: str, vector: Vector) -> Finding:
    """Judge a case about a subject."""
    if vector.op in _PROTOCOL:
        violated, answer = _PROTOCOL[vector.op](subject, vector)
        of_all = (*RULES, *BOUND_RULES, *QUERY_CERTIFICATE_RULES)
        return Finding(tuple(rule.id for rule in of_all if rule.id in violated), answer)
    if vector.op in _JUDGED:
        return Finding(() if _JUDGED[vector.op](vector.input) else (vector.op,), {})
    answer = _ANSWERED[vector.op](vector)
    return Finding(() if vector.claim == answer else (vector.op,), answer)


Found: TypeAlias = tuple[set[str], Fields]


def _check(subject: str, vector: Vector) -> Found:
    for name, read in (("instance", vector.read_instance), ("solution", vector.read_solution)):
        try:
            read()
        except Refusal as refusal:
            return {refusal.rule}, {"refused": f"$.{name}{refusal.path[1:]}"}
    instance, solution = vector.read_instance(), vector.read_solution()
    verdict = judge(instance, solution)
    violated = {violation.rule for violation in verdict.violations}
    if vector.claim is not None:
        cost = vector.claim["cost"]
        right = (
            is_plan_cost(instance, solution.plans[0], cost)
            if subject == is_plan_cost.id
            else is_total_cost(instance, solution.plans, cost)
        )
        violated |= set() if right else {subject}
    return violated, {"cost": verdict.cost, "unplanned": verdict.unplanned}


def _query(subject: str, vector: Vector) -> Found:
    import carp_reference

    instance, solution = vector.read_instance(), vector.read_solution()
    robot, now = vector.input["robot"], vector.input["now"]
    right = carp_reference.query(instance, solution.plans, robot, now)
    answer = {"cost": None if right is None else plan_cost(instance, right)}
    assert vector.claim is not None
    visits = vector.claim["plan"]
    if visits is None:
        return set() if right is None else {"query/complete"}, answer
    claimed = _plan(robot, visits)
    others = [plan for plan in solution.plans if plan.robot != robot]
    violated = {violation.rule for violation in violations_of(instance, (*others, claimed))}
    violated |= {"query/sound"} if violated else set()
    before = [plan for plan in solution.plans if plan.robot == robot]
    violated |= {violation.rule for plan in before for violation in plan_keeps_history(plan, claimed, now)}
    if right is not None and plan_cost(instance, claimed) > plan_cost(instance, right):
        violated |= {"query/optimal"} if "query/sound" not in violated else set()
    if subject == "query/ties" and claimed != right:
        violated |= {"query/ties"}
    return violated, answer


def _planned(instance: Instance, solution: Solution) -> Fields:
    return {"cost": total_cost(instance, solution.plans), "unplanned": len(solution.unplanned)}


def _plan_all(subject: str, vector: Vector) -> Found:
    import carp_reference

    del subject
    options = dict(vector.input)
    instance = vector.read_instance()
    try:
        planner = planner_named(options.pop("planner"), options)
    except Refusal as refusal:
        return {refusal.rule}, {"refused": refusal.path}
    return set(), _planned(instance, carp_reference.plan(instance, planner))


def _add(subject: str, vector: Vector) -> Found:
    import carp_reference

    del subject
    options = {name: value for name, value in vector.input.items() if name not in ("solution", "robot")}
    neighbourhood = cast("Neighbourhood", planner_named(Neighbourhood.name, options))
    instance, robot = vector.read_instance(), vector.input["robot"]
    after = carp_reference.add(instance, vector.read_solution(), robot, 0, neighbourhood)
    return set(), _planned(instance, after)


def _optimum(subject: str, vector: Vector) -> Found:
    """By looking at all states of all robots together: the cases are tiny, and nothing of the encoding is in it."""
    del subject
    return set(), {"cost": least_total_cost(vector.read_instance())}


def _verify_bound(subject: str, vector: Vector) -> Found:
    del subject
    try:
        certificate = read_bound(msgspec.json.encode(vector.input["certificate"]))
        return set(), {"bound": verify_bound(vector.read_instance(), certificate)}
    except Refusal as refusal:
        return {refusal.rule}, {"refused": f"$.certificate{refusal.path[1:]}"}


def _verify_query(subject: str, vector: Vector) -> Found:
    import carp_reference

    del subject
    instance, solution = vector.read_instance(), vector.read_solution()
    certificate = read_query_certificate(msgspec.json.encode(vector.input["certificate"]))
    try:
        verify_query(instance, solution, certificate)
        violated = set()
    except Refusal as refusal:
        violated = {refusal.rule}
    if violated & {robot_is_known.id, plans_are_lawful.id}:
        return violated, {"arrival": None}
    right = carp_reference.query(instance, solution.plans, certificate.robot, certificate.now)
    return violated, {"arrival": None if right is None else right.visits[-1].enter}


def _check_trace(subject: str, vector: Vector) -> Found:
    del subject
    instance, solution = vector.read_instance(), vector.read_solution()
    assert judge(instance, solution).valid
    trace = read_trace(msgspec.json.encode(vector.input["trace"]))
    return {violation.rule for violation in trace_violations(instance, solution, trace)}, {}


def _dependencies(subject: str, vector: Vector) -> Found:
    cycles = {violation.rule for violation in is_acyclic(vector.read_instance(), vector.read_solution())}
    return cycles, {"acyclic": subject not in cycles}


def _priority(subject: str, vector: Vector) -> Found:
    before, after, *rivals = (
        read_solution(msgspec.json.encode(each)).plans
        for each in (vector.input["solution"], vector.input["after"], *vector.input["rivals"])
    )
    kept = robot_is_first(vector.read_instance(), before, after, vector.input["robot"], vector.input["now"], rivals)
    return set() if kept else {subject}, {}


_PROTOCOL: Mapping[str, Callable[[str, Vector], Found]] = {
    "check": _check,
    "query": _query,
    "plan": _plan_all,
    "add": _add,
    "optimum": _optimum,
    "verify-bound": _verify_bound,
    "verify-query": _verify_query,
    "check-trace": _check_trace,
    "dependencies": _dependencies,
    "priority/first": _priority,
}


def _json(input: Fields) -> bool:
    return is_json(input["text"].encode() if "text" in input else bytes.fromhex(input["hex"]))


def _after_goal(input: Fields) -> bool:
    return not list(after_goal_is_known(Instance(ResourceGraph((), ()), (), input["after_goal"])))


def _following(input: Fields) -> bool:
    return not list(following_is_known(Instance(ResourceGraph((), ()), (), following=input["following"])))


def _fits(input: Fields) -> bool:
    return stay_fits(Window(*input["window"]), input["enter"], input["leave"], input["duration"])


_JUDGED: Mapping[str, Callable[[Fields], bool]] = {
    "document/json": _json,
    "instance/after-goal": _after_goal,
    "instance/following": _following,
    "window/fits": _fits,
}


def _free(vector: Vector) -> Fields:
    limits = [
        ([(enter, leave) for enter, leave in each["occupations"]], each["capacity"])
        for each in (vector.input, *vector.input.get("groups", ()))
    ]
    windows = free_windows(limits)
    assert windows_are_free(windows, limits)
    return {"windows": [[window.start, window.end] for window in windows]}


def _ties(vector: Vector) -> Fields:
    nodes = vector.input["nodes"]
    return {"order": sorted(range(len(nodes)), key=lambda position: expansion_key(*nodes[position]))}


def _distance(vector: Vector) -> Fields:
    mean = neighbourhood_rules.distance(vector.read_instance(), _plan_of(vector, "one"), _plan_of(vector, "other"))
    return {"distance": [mean.numerator, mean.denominator]}


def _nearest(vector: Vector) -> Fields:
    distances = [[Fraction(*each) for each in robot] for robot in vector.input["distances"]]
    return {"nearest": neighbourhood_rules.nearest(distances)}


def _orders(vector: Vector) -> Fields:
    size, sample, seed = (vector.input[name] for name in ("size", "sample", "seed"))
    return {"orders": [[*order] for order in neighbourhood_rules.neighbourhood_orders(size, sample, splitmix64(seed))]}


def _update(vector: Vector) -> Fields:
    before, planned = (vector.input[name] and _plan_of(vector, name) for name in ("before", "planned"))
    after = neighbourhood_rules.next_trajectory(before, planned)
    visits = [[visit.resource, visit.enter, visit.leave] for visit in after.visits]
    return {"trajectory": {"robot": after.robot, "visits": visits}}


def _drawn(answer: str, draw: Callable[..., Any], *names: str) -> Callable[[Vector], Fields]:
    """The answer of a function of the fields of these names, and of a stream of random numbers from the seed."""

    def judged(vector: Vector) -> Fields:
        found = draw(*(vector.input[name] for name in names), splitmix64(vector.input["seed"]))
        return {answer: [*found] if isinstance(found, tuple) else found}

    return judged


def _way(vector: Vector) -> Fields:
    spans = polish_rules.spans(vector.read_instance().graph.successors, _plan_of(vector, "plan"))
    return {"in_way": polish_rules.is_in_way(spans, _plan_of(vector, "other"))}


def _contested(vector: Vector) -> Fields:
    return {"apart": polish_rules.ticks_apart(Visit(*vector.input["visit"]), _plan_of(vector, "other"))}


def _near(vector: Vector) -> Fields:
    return {"order": polish_rules.by_distance([Fraction(*each) for each in vector.input["distances"]])}


def _kept(vector: Vector) -> Fields:
    before, after = ((each[0], each[1]) for each in (vector.input["before"], vector.input["after"]))
    return {"kept": polish_rules.is_kept(before, after)}


_ANSWERED: Mapping[str, Callable[[Vector], Fields]] = {
    "window/free": _free,
    "query/ties": _ties,
    "neighbourhood/baseline": lambda vector: {"tried": neighbourhood_rules.baseline_is_tried(**vector.input)},
    "neighbourhood/nearest": _nearest,
    "neighbourhood/distance": _distance,
    "neighbourhood/replan": lambda vector: {"from": neighbourhood_rules.replanned_from(**vector.input)},
    "neighbourhood/orders": _orders,
    "neighbourhood/best": lambda vector: {"replaces": neighbourhood_rules.replaces_best(**vector.input)},
    "neighbourhood/update": _update,
    "polish/draws": _drawn("drawn", polish_rules.drawn, "things", "count"),
    "polish/kind": _drawn("kind", polish_rules.kind_of, "turn", "waiting", "delay"),
    "polish/pivot": _drawn("pivot", polish_rules.pivot_of, "weights"),
    "polish/members": _drawn("members", polish_rules.members_of, "pivot", "candidates", "everyone"),
    "polish/way": _way,
    "polish/contested": _contested,
    "polish/near": _near,
    "polish/order": _drawn("order", polish_rules.order_of, "members", "repair"),
    "polish/kept": _kept,
    "polish/options": lambda vector: {"right": not [*polish_rules.options_are_right(**vector.input)]},
}


def _plan(robot: RobotId, visits: Sequence[Sequence[Any]]) -> Plan:
    return Plan(robot, tuple(Visit(*visit) for visit in visits))


def _plan_of(vector: Vector, name: str) -> Plan:
    """The plan in a field."""
    return _plan(**vector.input[name])
