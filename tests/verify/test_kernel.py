"""The proved kernel: it agrees with `carp_spec` on every verdict, and refuses what it should not read."""

import json
import subprocess
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from tests.verify.bound_examples import certificates, completed, crossing, cut_certificate
from tests.verify.kernel_program import program
from tests.verify.tiny import TINY

from carp_reference.context import context_of
from carp_reference.problem import Problem, prepare
from carp_reference.query import _expand, _start, find_plan
from carp_spec import (
    Instance,
    Plan,
    Refusal,
    Resource,
    ResourceGraph,
    ResourceId,
    Robot,
    RobotId,
    Solution,
    has_ended,
    judge,
)
from carp_verify.bounds import BOUND_FORMAT, BoundDocument, digest
from carp_verify.documents import instance_document, read_instance, read_solution, solution_document, write
from carp_verify.verify_bound import verify_bound
from carproof.mutations import BrokenSolution
from carproof.strategies import (
    FleetUnderWay,
    PlannedInstance,
    broken_solutions,
    fleets_under_way,
    instances,
    planned_instances,
)
from carproof.vectors import Vector, vectors

Json = Any


@cache
def server() -> "subprocess.Popen[str]":
    """A kernel that stays up."""
    return subprocess.Popen([program(), "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


@pytest.fixture(scope="module", autouse=True)
def _kernel() -> Iterator[None]:
    server()
    yield
    kernel = server()
    kernel.communicate()
    server.cache_clear()


def ask(request: str) -> Json:
    """Put one request to the kernel that stays up."""
    kernel = server()
    assert kernel.stdin is not None
    assert kernel.stdout is not None
    kernel.stdin.write(request + "\n")
    kernel.stdin.flush()
    return json.loads(kernel.stdout.readline())


def check(instance: Instance, solution: Solution) -> Json:
    """The kernel's answer about a solution."""
    return ask(encoded(op="check", instance=instance_document(instance), solution=solution_document(solution)))


def check_bound(instance: Instance, certificate: BoundDocument) -> Json:
    """The kernel's answer about the certificate of a bound."""
    return ask(encoded(op="verify-bound", instance=instance_document(instance), certificate=certificate))


def encoded(**request: object) -> str:
    return msgspec.json.encode(request).decode()


def run(*arguments: str | Path) -> tuple[int, Json, str]:
    """Run the kernel once: exit code, verdict, and what it prints on standard error."""
    done = subprocess.run([program(), *map(str, arguments)], capture_output=True, text=True, check=False)
    return done.returncode, json.loads(done.stdout) if done.stdout else None, done.stderr


def vectors_of(op: str) -> list[Vector]:
    return [case for case in vectors() if case.op == op and "following" not in case.instance]


@pytest.mark.parametrize("case", [*vectors("joint/following")][1:], ids=lambda case: case.id)
def test_the_kernel_refuses_instances_that_forbid_following(case: Vector) -> None:
    verdict = ask(encoded(**case.request))
    assert (verdict["verdict"], verdict["path"]) == ("bad input", "$.instance.following")
    assert (verdict["rule"], "following must be allowed" in verdict["message"]) == ("limit/following", True)


def test_the_kernel_ends_with_2_where_following_is_forbidden_or_a_trace_is_no_solution(tmp_path: Path) -> None:
    instance, solution, trace = (tmp_path / f"{name}.json" for name in ("instance", "solution", "trace"))
    case = next(case for case in vectors("joint/following") if case.instance.get("following") == "forbidden")
    instance.write_text(json.dumps(case.instance))
    solution.write_text(json.dumps(case.request["solution"]))
    trace.write_text('{"format": "carproof-trace/1", "now": 3, "plans": []}')
    code, _, sentence = run("check", instance, solution)
    assert (code, sentence.count("\n"), "[limit/following]" in sentence) == (2, 1, True)
    instance.write_text(json.dumps({**case.instance, "following": "allowed", "$schema": "instance.schema.json"}))
    solution.write_text(json.dumps({**case.request["solution"], "$schema": "solution.schema.json"}))
    assert run("check", instance, solution)[0] == 0
    code, _, sentence = run("check", instance, trace)
    assert (code, sentence) == (
        2,
        "$.format: the format must be carproof-solution/1, and is carproof-trace/1 [document/format]\n",
    )


@pytest.mark.parametrize("case", vectors_of("check"), ids=lambda case: case.id)
def test_the_kernel_answers_every_vector_of_check_rightly(case: Vector) -> None:
    verdict = ask(encoded(**case.request))
    if "refused" in case.answer:
        assert verdict["verdict"] == "bad input"
        assert (verdict["path"], [verdict["rule"]]) == (case.answer["refused"], list(case.violated))
    elif case.claim is not None or case.expected == "valid":
        claim = case.claim or case.answer
        assert (verdict["verdict"], verdict["unplanned"]) == ("accepted", case.answer["unplanned"])
        assert (verdict["cost"] == claim["cost"]) == (case.expected == "valid")
    else:
        assert verdict["verdict"] == "refused"
        assert verdict["rule"] in case.violated


@pytest.mark.parametrize("case", vectors_of("verify-query"), ids=lambda case: case.id)
def test_the_kernel_answers_every_vector_of_verify_query_rightly(case: Vector) -> None:
    verdict = ask(encoded(**case.request))
    if case.expected == "valid":
        assert (verdict["verdict"], verdict["bound"]) == ("accepted", case.request["certificate"]["bound"])
    else:
        assert (verdict["verdict"], [verdict["rule"]]) == ("refused", list(case.violated))


@pytest.mark.parametrize("case", vectors_of("verify-bound"), ids=lambda case: case.id)
def test_the_kernel_answers_every_vector_of_verify_bound_rightly(case: Vector) -> None:
    verdict = ask(encoded(**case.request))
    if case.expected == "valid" or case.violated == ("bound/instance",):
        assert (verdict["verdict"], verdict["bound"]) == ("accepted", case.request["certificate"]["bound"])
    else:
        assert verdict["verdict"] in ("refused", "bad input")
        assert [verdict["rule"]] == list(case.violated)


def test_the_kernel_reads_no_tick_now_before_0() -> None:
    certificate = {**vectors_of("verify-query")[0].request["certificate"], "now": -1}
    verdict = ask(encoded(**{**vectors_of("verify-query")[0].request, "certificate": certificate}))
    assert (verdict["verdict"], verdict["path"], verdict["rule"]) == (
        "bad input",
        "$.certificate.now",
        "document/shape",
    )


@given(planned_instances())
def test_the_kernel_accepts_what_breaks_no_rule(case: PlannedInstance) -> None:
    verdict = check(case.instance, case.solution)
    assert verdict["verdict"] == "accepted"
    assert verdict["cost"] == judge(case.instance, case.solution).cost


@given(broken_solutions())
def test_the_kernel_refuses_what_breaks_a_rule(case: BrokenSolution) -> None:
    verdict = check(case.instance, case.solution)
    rules = {violation.rule for violation in judge(case.instance, case.solution).violations}
    assert verdict["verdict"] == "refused"
    assert verdict["rule"] in rules


@given(instances())
def test_the_kernel_reads_every_instance(instance: Instance) -> None:
    solution = Solution((), (), tuple(instance.robot))
    assert check(instance, solution)["verdict"] == "accepted"


# ---- strict reading ----

INSTANCE = json.dumps(
    {
        "format": "carproof-instance/1",
        "graph": {"nodes": [{"id": "a", "capacity": 2}, {"id": "b"}], "edges": [{"source": "a", "target": "b"}]},
        "after_goal": "vanish",
        "robots": [{"id": "r", "start": "a", "goal": "b"}],
    }
)
SOLUTION = json.dumps(
    {
        "format": "carproof-solution/1",
        "plans": [{"robot": "r", "visits": [["a", 0, 1], ["b", 1, 2]]}],
        "order": ["r"],
        "unplanned": [],
    }
)
BAD_INSTANCES = {
    "not JSON": "{",
    "empty": "",
    "two values": INSTANCE + INSTANCE,
    "a comment": INSTANCE + "/* done */",
    "a tuple": INSTANCE.replace('["b", 1, 2]', '("b", 1, 2)').replace("[{", "([{"),
    "no JSON number": INSTANCE.replace('"capacity": 2', '"capacity": NaN'),
    "infinity": INSTANCE.replace('"capacity": 2', '"capacity": Infinity'),
    "leading zero": INSTANCE.replace('"capacity": 2', '"capacity": 02'),
    "a plus": INSTANCE.replace('"capacity": 2', '"capacity": +2'),
    "unquoted name": INSTANCE.replace('"capacity": 2', "capacity: 2"),
    "trailing comma": INSTANCE.replace('"capacity": 2', '"capacity": 2,'),
    "bad escape": INSTANCE.replace('"b"', r'"\x62"'),
    "half a pair of surrogates": INSTANCE.replace('"b"', r'"\ud800"'),
    "a surrogate and a letter": INSTANCE.replace('"b"', r'"\ud800\u0041"'),
    "the second of a pair alone": INSTANCE.replace('"b"', r'"\udc00"'),
    "a control character": INSTANCE.replace('"b"', '"b\x01"'),
    "nested too deep": "[" * 100_000,
    "a name twice": INSTANCE.replace('"capacity": 2', '"capacity": 2, "capacity": 2'),
    "a name twice, escaped": INSTANCE.replace('"capacity": 2', r'"capacity": 2, "capacit\u0079": 2'),
    "an unknown field": INSTANCE.replace('"capacity": 2', '"capacity": 2, "colour": 2'),
    "a missing field": INSTANCE.replace('"after_goal": "vanish", ', ""),
    "1.0": INSTANCE.replace('"capacity": 2', '"capacity": 1.0'),
    "1e0": INSTANCE.replace('"capacity": 2', '"capacity": 1e0'),
    "true": INSTANCE.replace('"capacity": 2', '"capacity": true'),
    "null": INSTANCE.replace('"capacity": 2', '"capacity": null'),
    "a string": INSTANCE.replace('"capacity": 2', '"capacity": "2"'),
    "a boolean id": INSTANCE.replace('"id": "a"', '"id": true'),
    "101 digits": INSTANCE.replace('"capacity": 2', f'"capacity": {10**100}'),
    "another format": INSTANCE.replace("instance/1", "instance/2"),
    "an id twice": INSTANCE.replace('"id": "b"', '"id": "a"'),
    "an edge twice": INSTANCE.replace('"edges": [', '"edges": [{"source": "b", "target": "a"}, '),
    "capacity 0": INSTANCE.replace('"capacity": 2', '"capacity": 0'),
    "unknown goal": INSTANCE.replace('"goal": "b"', '"goal": "c"'),
    "release below 0": INSTANCE.replace('"goal": "b"', '"goal": "b", "release": -1'),
}


@pytest.mark.parametrize("text", BAD_INSTANCES.values(), ids=BAD_INSTANCES)
def test_a_bad_instance_is_refused_with_the_rule_that_carp_spec_names(text: str, tmp_path: Path) -> None:
    (tmp_path / "instance.json").write_text(text)
    (tmp_path / "solution.json").write_text(SOLUTION)
    with pytest.raises(Refusal) as refusal:
        read_instance(text.encode())
    code, verdict, sentence = run("check", tmp_path / "instance.json", tmp_path / "solution.json")
    assert (code, verdict["verdict"], verdict["rule"]) == (2, "bad input", refusal.value.rule)
    assert verdict["path"] == refusal.value.path
    assert sentence.count("\n") == 1


@pytest.mark.parametrize(
    ("escaped", "plain"),
    [
        (r"\u0041", "A"),
        (r"\/", "/"),
        (r"\\", r"\\"),
        (r"\u000a", r"\n"),
        (r"\u00e9", "\u00e9"),
        (r"\ud83d\ude00", "\U0001f600"),
    ],
)
def test_an_escaped_id_is_the_same_id(escaped: str, plain: str, tmp_path: Path) -> None:
    (tmp_path / "instance.json").write_text(INSTANCE.replace('"b"', f'"{escaped}"'))
    (tmp_path / "solution.json").write_text(SOLUTION.replace('"b"', f'"{plain}"'))
    assert run("check", tmp_path / "instance.json", tmp_path / "solution.json")[0] == 0


@pytest.mark.parametrize("data", [b"\xff", b'"\xc0\xaf"', b'"\xed\xa0\x80"', b'"\xf5\x80\x80\x80"', b"\xef\xbb\xbf{}"])
def test_bytes_that_are_no_utf_8_are_refused(data: bytes, tmp_path: Path) -> None:
    (tmp_path / "instance.json").write_bytes(data)
    code, verdict, _ = run("check", tmp_path / "instance.json", tmp_path / "instance.json")
    assert (code, verdict["rule"]) == (2, "document/json")


def test_a_missing_file_is_bad_input(tmp_path: Path) -> None:
    code, verdict, sentence = run("check", tmp_path / "none.json", tmp_path / "none.json")
    assert (code, verdict["verdict"]) == (2, "bad input")
    assert "none.json" in sentence


def test_a_command_that_is_none_is_bad_input() -> None:
    assert run("chekc")[0] == 2


@pytest.mark.parametrize("shift", [2**31, 2**62, 2**63, 2**64, 10**99])
@pytest.mark.parametrize("off", [0, 1])
def test_ticks_of_any_size_are_told_apart(shift: int, off: int) -> None:
    """No tick overflows: a plan is right where it starts at its release, and wrong a tick or 2^64 beside it."""
    instance = Instance(ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),)), (Robot("r", "a", "b", shift),))
    start = shift + off
    visits = [["a", start, start + 1], ["b", start + 1, start + 2]]
    plan = {"robot": "r", "visits": visits}
    solution = {"format": "carproof-solution/1", "plans": [plan], "order": ["r"], "unplanned": []}
    verdict = ask(encoded(op="check", instance=instance_document(instance), solution=solution).replace("\\", ""))
    assert verdict["verdict"] == ("refused" if off else "accepted")


def test_robots_meet_at_ticks_of_any_size() -> None:
    instance = Instance(ResourceGraph((Resource("a"),), ()), (Robot("r", "a", "a", 2**64), Robot("s", "a", "a", 0)))
    plans = [{"robot": "r", "visits": [["a", 2**64, 2**64 + 1]]}, {"robot": "s", "visits": [["a", 0, 1]]}]
    solution = {"format": "carproof-solution/1", "plans": plans, "order": ["r", "s"], "unplanned": []}
    read = read_solution(json.dumps(solution).encode())
    assert judge(instance, read).valid
    assert check(instance, read)["verdict"] == "accepted"


# ---- queries ----


def query_certificate(problem: Problem, committed: Sequence[Plan], robot: RobotId) -> Json:
    """A certificate made by the reference's steps: each window that can be entered in time, at its earliest."""
    instance = problem.instance
    plan = find_plan(problem, committed, robot)
    bound = None if plan is None else plan.visits[-1].enter
    context, potential = context_of(instance, committed), problem.ticks_to_goal[robot]
    _, start = _start(problem, context, robot)
    entered: dict[tuple[ResourceId, int], int] = {}
    queue = [] if start is None else [start]
    while queue:
        node = min(queue, key=lambda each: each.enter)
        queue.remove(node)
        for following in _expand(context, robot, node, instance.graph.successors[node.resource]):
            key = (following.resource, following.window.start)
            in_time = following.resource in potential and (
                bound is None or following.enter + potential[following.resource] < bound
            )
            if in_time and entered.get(key, following.enter + 1) > following.enter:
                entered[key] = following.enter
                queue.append(following)
    return {
        "format": "carproof-query/1",
        "robot": robot,
        "now": problem.now,
        "bound": bound,
        "labels": [(resource, enter) for (resource, _), enter in entered.items()],
        "potential": list(potential.items()),
    }


def verify_query(instance: Instance, solution: Solution, certificate: Json) -> Json:
    documents = {"instance": instance_document(instance), "solution": solution_document(solution)}
    return ask(encoded(op="verify-query", certificate=certificate, **documents))


@given(st.data(), fleets_under_way())
def test_query_certificates_prove_the_least_arrival_and_no_later_one(data: st.DataObject, fleet: FleetUnderWay) -> None:
    certificate = query_certificate(prepare(fleet.instance, fleet.now), fleet.solution.plans, fleet.robot)
    verdict = verify_query(fleet.instance, fleet.solution, certificate)
    assert (verdict["verdict"], verdict["bound"]) == ("accepted", certificate["bound"])
    if certificate["bound"] is not None:
        for later in (certificate["bound"] + 1, None):
            assert verify_query(fleet.instance, fleet.solution, certificate | {"bound": later})["verdict"] == "refused"
    if certificate["labels"]:
        missing = data.draw(st.integers(0, len(certificate["labels"]) - 1))
        fewer = [label for number, label in enumerate(certificate["labels"]) if number != missing]
        assert verify_query(fleet.instance, fleet.solution, certificate | {"labels": fewer})["verdict"] == "refused"


@given(st.data(), fleets_under_way())
def test_query_certificates_of_robots_under_way_prove_the_least_arrival(
    data: st.DataObject, fleet: FleetUnderWay
) -> None:
    assume(fleet.solution.plans)
    plan = data.draw(st.sampled_from(fleet.solution.plans))
    assume(not has_ended(plan, fleet.now))
    problem = replace(prepare(fleet.instance, fleet.now), before={plan.robot: plan})
    others = [each for each in fleet.solution.plans if each != plan]
    certificate = query_certificate(problem, others, plan.robot)
    verdict = verify_query(fleet.instance, fleet.solution, certificate)
    assert (verdict["verdict"], verdict["bound"]) == ("accepted", certificate["bound"])
    later = certificate | {"bound": certificate["bound"] + 1}
    assert verify_query(fleet.instance, fleet.solution, later)["verdict"] == "refused"


@given(instances())
def test_an_audit_accepts_plans_made_one_after_the_other_and_no_later_one(instance: Instance) -> None:
    problem = prepare(instance, 0)
    plans: list[Plan] = []
    certificates = []
    for robot in instance.robot:
        plan = find_plan(problem, plans, robot)
        if plan is not None:
            certificates.append(query_certificate(problem, plans, robot))
            plans.append(plan)
    solution = Solution.of(instance, plans)
    documents = {"instance": instance_document(instance), "solution": solution_document(solution)}
    assert ask(encoded(op="audit", certificates=certificates, **documents))["verdict"] == "accepted"
    if certificates:
        verdict = ask(encoded(op="audit", certificates=certificates[1:], **documents))
        assert (verdict["verdict"], verdict["rule"]) == ("refused", "query/optimal")


# ---- refutations ----

FORMULA = "c a comment\np cnf 2 4\n1 2 0\n-1 2 0\n1 -2 0\n-1 -2 0\n"
PROOF = "5 2 0 1 2 0\n5 d 1 2 0\n6 0 5 3 4 0\n"
BAD_PROOFS = {
    "empty": "",
    "no empty clause": "5 2 0 1 2 0\n",
    "a hint that is missing": "5 2 0 1 0\n6 0 5 3 4 0\n",
    "a hint that is deleted": "5 2 0 1 2 0\n5 d 3 0\n6 0 5 3 4 0\n",
    "a hint of no clause": "5 2 0 1 9 0\n6 0 5 3 4 0\n",
    "hints in another order": "5 2 0 1 2 0\n6 0 3 5 4 0\n",
    "a RAT step": "5 2 0 1 -2 0\n6 0 5 3 4 0\n",
    "no 0": "5 2 0 1 2 0\n6 0 5 3 4\n",
    "words after 0": "5 2 0 1 2 0 7\n6 0 5 3 4 0\n",
    "a number that is taken": "1 2 0 1 2 0\n6 0 1 3 4 0\n",
    "a 0 as literal": "5 0 0 1 2 0\n6 0 5 3 4 0\n",
}


def refute(folder: Path, formula: str, proof: str) -> tuple[int, Json, str]:
    (folder / "formula.cnf").write_text(formula)
    (folder / "proof.lrat").write_text(proof)
    return run("refute", folder / "formula.cnf", folder / "proof.lrat")


def test_a_refutation_is_accepted(tmp_path: Path) -> None:
    assert refute(tmp_path, FORMULA, PROOF)[0] == 0


@pytest.mark.parametrize("proof", BAD_PROOFS.values(), ids=BAD_PROOFS)
def test_a_bad_refutation_is_refused(proof: str, tmp_path: Path) -> None:
    assert refute(tmp_path, FORMULA, proof)[0] == 1


def test_a_formula_that_has_a_solution_is_not_refuted(tmp_path: Path) -> None:
    formula = FORMULA.replace("4\n", "3\n", 1).replace("-1 -2 0\n", "")
    assert refute(tmp_path, formula, PROOF)[0] == 1


@pytest.mark.parametrize(
    "formula", ["", "1 0\n", "p cnf 1 2\n1 0\n", "p cnf 1 1\n2 0\n", "p cnf 1 1\n1\n", "p cnf x 1\n"]
)
def test_a_malformed_formula_is_bad_input(formula: str, tmp_path: Path) -> None:
    assert refute(tmp_path, formula, PROOF)[0] == 2


@pytest.mark.parametrize("proof", ["5 x 0\n", "5 1.0 0 1 0\n", "5 0x1 0 1 0\n", "5 1_0 0 1 0\n", "5 - 0 1 0\n"])
def test_words_that_are_no_numbers_are_bad_input(proof: str, tmp_path: Path) -> None:
    assert refute(tmp_path, FORMULA, proof)[0] == 2


# ---- bounds ----


def broken_rule(instance: Instance, certificate: BoundDocument) -> str | None:
    """The rule by which `carp_verify` refuses a certificate, if it does."""
    try:
        verify_bound(instance, certificate)
    except Refusal as refusal:
        return refusal.rule
    return None


def with_price(number: int, change: int) -> Callable[[BoundDocument], BoundDocument]:
    """Change a price of a resource: its tick (1) or its amount (2)."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        first, others = certificate.resources[:1], certificate.resources[1:]
        changed = tuple(
            (place, tick + change * (number == 1), amount + change * (number == 2)) for place, tick, amount in first
        )
        return msgspec.structs.replace(certificate, resources=(*changed, *others))

    return tamper


def with_claim(change: Callable[[int | None], int | None]) -> Callable[[BoundDocument], BoundDocument]:
    """Change the claim of the first robot."""

    def tamper(certificate: BoundDocument) -> BoundDocument:
        (robot, least), *others = certificate.robots
        return msgspec.structs.replace(certificate, robots=((robot, change(least)), *others))

    return tamper


def replaced(**fields: Callable[[Any], object]) -> Callable[[BoundDocument], BoundDocument]:
    """Change fields by what they are."""
    return lambda certificate: msgspec.structs.replace(
        certificate, **{name: change(getattr(certificate, name)) for name, change in fields.items()}
    )


TAMPERS = (
    replaced(bound=lambda bound: bound + 1),
    replaced(bound=lambda bound: bound - 1),
    replaced(scale=lambda scale: scale - 1),
    replaced(scale=lambda scale: scale * 2),
    replaced(horizon=lambda horizon: horizon - 1),
    replaced(horizon=lambda horizon: horizon * 10**30),
    replaced(robots=lambda robots: robots[1:]),
    replaced(robots=lambda robots: (*robots, *robots[:1])),
    replaced(robots=lambda robots: robots[::-1]),
    replaced(resources=lambda prices: (*prices, *prices[:1])),
    replaced(exchanges=lambda prices: (*prices, *prices[:1])),
    replaced(exchanges=lambda prices: tuple((two, one, tick, price) for one, two, tick, price in prices)),
    replaced(exchanges=lambda prices: tuple((one, one, tick, price) for one, _, tick, price in prices)),
    replaced(resources=lambda prices: tuple(("no place", tick, price) for _, tick, price in prices)),
    with_price(1, 1),
    with_price(1, -1),
    with_price(2, 1),
    with_price(2, -1),
    with_price(2, -100),
    with_claim(lambda _: None),
    with_claim(lambda least: (least or 0) + 1),
    with_claim(lambda least: (least or 0) - 1),
)


@given(st.data(), instances(TINY, least_robots=1))
def test_bounds_are_accepted_and_refused_as_by_carp_verify(data: st.DataObject, instance: Instance) -> None:
    certificate = data.draw(certificates(instance))
    verdict = check_bound(instance, certificate)
    assert (verdict["verdict"], verdict["bound"]) == ("accepted", certificate.bound)
    tampered = data.draw(st.sampled_from(TAMPERS))(certificate)
    verdict = check_bound(instance, tampered)
    assert verdict.get("rule") == broken_rule(instance, tampered)
    assert verdict["verdict"] == ("refused" if "rule" in verdict else "accepted")


def test_long_stays_and_late_releases_cost_no_time() -> None:
    """Ticks beyond the horizon are not gone through."""
    resources = (Resource("a", duration=10**60), Resource("b"))
    robots = (Robot("r", "a", "b", release=10**90), Robot("s", "a", "b"))
    instance = Instance(ResourceGraph(resources, (("a", "b"),)), robots)
    certificate = BoundDocument(
        format=BOUND_FORMAT,
        instance=digest(instance),
        bound=2 * 10**60 + 3 - 3,
        scale=1,
        horizon=10**6,
        resources=(("a", 5, 3),),
        exchanges=(),
        cuts=(),
        robots=(("r", 10**60), ("s", 10**60 + 3)),
    )
    assert broken_rule(instance, certificate) is None
    assert check_bound(instance, certificate)["verdict"] == "accepted"


def test_a_bound_with_cuts_is_decided(tmp_path: Path) -> None:
    certificate = cut_certificate()
    (tmp_path / "instance.json").write_bytes(write(instance_document(crossing())))
    (tmp_path / "bound.json").write_bytes(write(certificate))
    code, verdict, _ = run("verify-bound", tmp_path / "instance.json", tmp_path / "bound.json")
    assert (code, verdict) == (0, {"kernel": "1", "verdict": "accepted", "bound": certificate.bound})


@pytest.mark.parametrize(
    "change",
    [
        {"refutation": ""},
        {"refutation": "nonsense\n"},
        {"least": 8},
        {"horizons": (0, 0)},
        {"horizons": (1,)},
        {"horizons": (-1, 3)},
        {"order": (0, 0)},
        {"order": (0, 10**40)},
        {"robots": ("r0", "r1")},
        {"robots": ("r0", "r0")},
        {"robots": ("r0", "r9")},
    ],
)
def test_a_cut_whose_proof_is_changed_is_refused(change: dict[str, Any]) -> None:
    (cut,) = cut_certificate().cuts
    changed = (msgspec.structs.replace(cut, **change),)
    certificate = completed(crossing(), msgspec.structs.replace(cut_certificate(), cuts=changed))
    verdict = check_bound(crossing(), certificate)
    assert (verdict["verdict"], verdict["rule"]) == ("refused", "bound/cut")
