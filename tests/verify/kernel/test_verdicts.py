"""The proved kernel: it agrees with `carp_spec` on every verdict, and refuses what it should not read."""

import json
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import get_args

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.spec.making import line, plan_of, solution_of
from tests.verify.forging import changed
from tests.verify.kernel.program import ask, check, encoded, refusal_of, require_bad_input, run, served
from tests.verify.kernel.test_optimum import claim

from carp_spec import Group, Instance, Robot, Stop, judge
from carp_spec.documents.instances import read_instance
from carp_spec.documents.query_certificates import read_query_certificate
from carp_spec.documents.solutions import read_solution
from carp_spec.documents.vectors import Vector
from carp_spec.model import Following
from carp_verify.optimum.encoding import Evidence
from carproof.testing.mutations import BrokenSolution
from carproof.testing.strategies import PlannedInstance, Sizes, broken_solutions, planned_instances
from carproof.testing.vectors import subjects, vectors

_kernel = pytest.fixture(scope="module", autouse=True)(served)

WITH_STOPS = Sizes(stops=3, service=5, groups=2)


def vectors_of(op: str) -> list[Vector]:
    return [case for case in vectors() if case.op == op]


@pytest.mark.parametrize("command", ["verify-proof", "formula"])
def test_the_kernel_refuses_proofs_of_robots_with_stops_by_name(command: str, tmp_path: Path) -> None:
    serving = Robot("r", "a", stops=(Stop("b", 1),))
    claim(tmp_path, Instance(line("ab"), (serving,)), 1, Evidence((1,), (0,)))
    code, verdict, _ = run(command, tmp_path)
    assert (code, verdict["path"], verdict["rule"]) == (2, "$.robots[0].stops", "limit/stops")


def test_the_kernel_refuses_bounds_of_robots_with_stops_by_name() -> None:
    case = vectors_of("verify-bound")[0]
    robot, *others = case.instance["robots"]
    goal = robot.pop("goal")
    serving = {**robot, "stops": [{"resource": goal, "service": 1}]}
    verdict = ask(encoded(**{**case.request, "instance": {**case.instance, "robots": [serving, *others]}}))
    assert (verdict["verdict"], verdict["rule"]) == ("bad input", "limit/stops")


def test_the_kernel_ends_with_2_where_a_trace_is_no_solution(tmp_path: Path) -> None:
    instance, solution, trace = (tmp_path / f"{name}.json" for name in ("instance", "solution", "trace"))
    case = next(case for case in vectors("joint/following") if case.instance.get("following") == "forbidden")
    trace.write_text('{"format": "carproof-trace/1", "now": 3, "plans": []}')
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


@pytest.mark.parametrize("case", [*vectors_of("verify-query"), *vectors_of("verify-bound")], ids=lambda case: case.id)
def test_the_kernel_answers_every_vector_of_certificates_rightly(case: Vector) -> None:
    verdict = ask(encoded(**case.request))
    if case.expected == "valid" or case.violated == ("bound/instance",):
        assert (verdict["verdict"], verdict["bound"]) == ("accepted", case.request["certificate"]["bound"])
    else:
        assert verdict["verdict"] == "refused" or (case.op, verdict["verdict"]) == ("verify-bound", "bad input")
        assert [verdict["rule"]] == list(case.violated)


@given(planned_instances() | planned_instances(WITH_STOPS))
def test_the_kernel_accepts_what_breaks_no_rule(case: PlannedInstance) -> None:
    verdict = check(case.instance, case.solution)
    assert verdict["verdict"] == "accepted"
    assert verdict["cost"] == judge(case.instance, case.solution).cost


@given(broken_solutions() | broken_solutions(WITH_STOPS))
def test_the_kernel_refuses_what_breaks_a_rule(case: BrokenSolution) -> None:
    verdict = check(case.instance, case.solution)
    rules = {violation.rule for violation in judge(case.instance, case.solution).violations}
    assert verdict["verdict"] == "refused"
    assert verdict["rule"] in rules


@given(planned_instances() | planned_instances(WITH_STOPS), st.data())
def test_the_kernel_counts_robots_in_groups_and_a_tick_longer_as_the_checker_does(
    case: PlannedInstance, data: st.DataObject
) -> None:
    graph = case.instance.graph
    members = st.lists(st.sampled_from([*graph.resource]), min_size=1, unique=True)
    drawn = data.draw(st.lists(st.tuples(members, st.integers(1, 2)), max_size=3))
    groups = tuple(Group(number, tuple(resources), capacity) for number, (resources, capacity) in enumerate(drawn))
    following = data.draw(st.sampled_from(get_args(Following)))
    instance = replace(case.instance, graph=replace(graph, groups=groups), following=following)
    verdict, judged = check(instance, case.solution), judge(instance, case.solution)
    assert (verdict["verdict"] == "accepted") == judged.valid
    assert judged.valid or verdict["rule"] in {violation.rule for violation in judged.violations}


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


READERS = {"instance": read_instance, "solution": read_solution, "certificate": read_query_certificate}


OF_INSTANCES = [each for each in subjects() if each.startswith("instance/") or each == "joint/following"]
SOUND = [[case for case in vectors(each) if (case.op, case.expected) == ("check", "valid")] for each in OF_INSTANCES]
LARGEST = [max(cases, key=lambda case: len(json.dumps(case.instance))) for cases in SOUND if cases]


@pytest.mark.parametrize("case", LARGEST, ids=lambda case: case.id)
def test_a_document_with_any_change_is_read_as_carp_spec_reads_it(case: Vector) -> None:
    graph = {**case.instance["graph"], "multigraph": False, "graph": {"name": "n"}}
    certificate = vectors_of("verify-query")[0].request
    instance = {"$schema": "text", **case.instance, "graph": graph}
    for request in ({"op": "check", "instance": instance, "solution": case.request["solution"]}, certificate):
        for name, value in request.items():
            for document in changed(value) if name in READERS else ():
                answer = ask(encoded(**{**request, name: document}))
                refusal = refusal_of(partial(READERS[name], json.dumps(document).encode()))
                if refusal is not None:
                    require_bad_input(answer, refusal, name)
                else:
                    assert answer["verdict"] != "bad input"


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


CHARACTERS = [0x01, 0x20, 0x7F, 0x80, 0x7FF, 0x800, 0xFFF, 0x1000, 0xCFFF, 0xD000, 0xD7FF, 0xE000, 0xFFFF]
CHARACTERS += [0x10000, 0x3FFFF, 0x40000, 0xFFFFF, 0x100000, 0x10FFFF]
BROKEN = """
1f 80 bf c1bf c2 c261 c2c2 dfc0 e09fbf e1 e180 e18061 e16180 e180c0 eda080 edbfbf f08fbfbf f1 f180 f18080 f1808061
f1806180 f1618080 f4908080 f5808080 f888808080 ff
"""
BYTES = [*(chr(each).encode() for each in CHARACTERS), *map(bytes.fromhex, BROKEN.split())]
ESCAPES = rb"""
\u0000 \u001f \ud7ff \ud800\udc00 \ud800\udfff \udbff\udc00 \udbff\udfff \ue000 \ud800 \udbff \udc00 \udfff
\ud800\udbff \ud800\ue000 \ud800\ud800 \ud800\u0041 \ud800u \ud800\\ud \ud800\n \udc00\ud800 \u0041\udc00 \u00 \u00g0
\u \\ \\u0041 \\ud800 \" \/ \b\f\n\r\t \x41 \U0041
""".split()
NUMBERS = b"""
0 1 -0 -1 00 01 -01 - -- -a +1 1. 1.5 0.0 -0.5 1.e1 .5 1.x 1.5x 1.5.1 1e5 1E5 1e+5 1e-5 1e 1e+ 1e+x 1e5x 1e5.1 0e1 0x1
1_0 1a 1.5e5 1.5e 1.5e+5x 1-1 truex nulll tru NaN Infinity +2
""".split()
NUMBERS += [sign + b"1" + b"0" * zeros for sign in (b"", b"-") for zeros in (17, 18, 98, 99, 100)]


@pytest.mark.parametrize(("texts", "old"), [(BYTES, '"b"'), (ESCAPES, '"b"'), (NUMBERS, "2")])
def test_texts_at_the_edge_of_being_json_are_read_as_carp_spec_reads_them(
    texts: Sequence[bytes], old: str, tmp_path: Path
) -> None:
    (tmp_path / "solution.json").write_text(json.dumps({**json.loads(SOLUTION), "plans": [], "order": []}))
    for number, text in enumerate(texts):
        new = b'"' + text + b'"' if old == '"b"' else text
        whole = INSTANCE.encode().replace(old.encode(), new)
        for content in (whole, *(whole[: whole.index(new) + end] for end in (len(new) - 1, len(new)))):
            path = tmp_path / f"{number} {len(content)}.json"
            path.write_bytes(content)
            refusal = refusal_of(partial(read_instance, content))
            _, verdict, _ = run("check", path, tmp_path / "solution.json")
            assert verdict.get("rule") == ("solution/covers" if refusal is None else refusal.rule), content


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
    instance = Instance(line("ab"), (Robot("r", "a", "b", shift),))
    start = shift + off
    plan = plan_of("r", ("a", start, start + 1), ("b", start + 1, start + 2))
    assert check(instance, solution_of([plan]))["verdict"] == ("refused" if off else "accepted")
