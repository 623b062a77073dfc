"""`--kernel`: the kernel's verdicts are passed on, and its absence is one sentence. A stand-in answers in its place."""

import json
import sys
from pathlib import Path

import msgspec
import pytest
from tests.oracle.running import BROKEN, TWO, TWO_PLANNED, Document, Run, line
from tests.verify.kernel_program import program
from tests.verify.test_bound import crossing, cut_certificate

import carp_verify.kernel
from carp_spec.documents import write, write_instance
from carp_verify.kernel import PROGRAM, VARIABLE

STAND_IN = """#!{python}
import json, sys
if sys.argv[1] != "serve":
    sys.exit(print({answer!r}))
for line in sys.stdin:
    json.loads(line)
    print({answer!r}, flush=True)
"""


@pytest.fixture(name="files")
def written_files(tmp_path: Path, carproof: Run) -> dict[str, Path]:
    documents: dict[str, Document] = {"town": TWO, "plans": TWO_PLANNED, "broken": BROKEN}
    files = {name: tmp_path / f"{name}.json" for name in (*documents, "query", "bound")}
    for name, document in documents.items():
        files[name].write_bytes(line(**document))
    carproof("query", files["town"], files["plans"], "r1", "--certificate", files["query"])
    carproof("bound", files["town"], "--steps", 3, "-o", files["bound"])
    return files


def stand_in(folder: Path, monkeypatch: pytest.MonkeyPatch, **answer: object) -> None:
    """A kernel that gives one answer to all that it is asked."""
    program = folder / PROGRAM
    text = json.dumps({"kernel": "7", **answer}) if answer else "nonsense"
    program.write_text(STAND_IN.format(python=sys.executable, answer=text))
    program.chmod(0o755)
    monkeypatch.setenv(VARIABLE, str(program))


COMMANDS = {
    "check": ("town", "plans"),
    "audit": ("town", "plans"),
    "verify-query": ("town", "plans", "query"),
    "verify-bound": ("town", "bound"),
}


@pytest.mark.parametrize("command", COMMANDS)
def test_what_the_kernel_accepts_is_accepted_in_its_name(
    carproof: Run, files: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    stand_in(tmp_path, monkeypatch, verdict="accepted", cost=5, unplanned=0)
    arguments = [files[name] for name in COMMANDS[command]]
    outcome = carproof(command, *arguments, "--kernel")
    assert (outcome.code, outcome.stderr) == (0, "")
    assert f"{PROGRAM} 7" in outcome.stdout
    document = json.loads(carproof(command, *arguments, "--kernel", "--json").stdout)
    assert "7" in document.get("by", document.get("kernel"))


@pytest.mark.parametrize("command", ["verify-query", "verify-bound"])
def test_what_the_kernel_refuses_is_refused(
    carproof: Run, files: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    stand_in(tmp_path, monkeypatch, verdict="refused", rule="some/rule", message="it is wrong")
    outcome = carproof(command, *(files[name] for name in COMMANDS[command]), "--kernel")
    assert (outcome.code, outcome.stdout) == (1, "not proved: $: it is wrong [some/rule]\n")


@pytest.mark.parametrize("command", COMMANDS)
def test_what_the_kernel_cannot_decide_or_read_is_neither(
    carproof: Run, files: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    arguments = [*(files[name] for name in COMMANDS[command]), "--kernel"]
    stand_in(tmp_path, monkeypatch, verdict="undecided", message="too large")
    outcome = carproof(command, *arguments)
    assert (outcome.code, outcome.stdout, outcome.stderr) == (3, "", f"Undecided: {PROGRAM} 7: too large\n")
    stand_in(tmp_path, monkeypatch, verdict="bad input", path="$.x", rule="document/shape", message="it is not read")
    outcome = carproof(command, *arguments)
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr.endswith("it is not read [document/shape]\n")
    stand_in(tmp_path, monkeypatch)
    outcome = carproof(command, *arguments)
    assert (outcome.code, outcome.stderr) == (
        2,
        f"Error: --kernel: {PROGRAM} ended without an answer [kernel/answer]\n",
    )


@pytest.mark.parametrize("command", COMMANDS)
def test_without_a_kernel_one_sentence_says_how_to_build_it(
    carproof: Run, files: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    monkeypatch.setattr(carp_verify.kernel, "BUILT", tmp_path / "none")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv(VARIABLE, raising=False)
    arguments = [*(files[name] for name in COMMANDS[command]), "--kernel"]
    outcome = carproof(command, *arguments)
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr.startswith(f"Error: --kernel: there is no program {PROGRAM}; `make kernel` builds it, with")
    monkeypatch.setenv(VARIABLE, str(tmp_path / "elsewhere"))
    assert carproof(command, *arguments).code == 2
    stand_in(tmp_path, monkeypatch, verdict="accepted", cost=5, unplanned=0)
    monkeypatch.delenv(VARIABLE)
    assert carproof(command, *arguments).code == 0, "the program is on the PATH"


@pytest.mark.parametrize(("command", "plans"), [("check", "plans"), ("check", "broken"), ("audit", "plans")])
def test_a_kernel_that_differs_is_a_contradiction(
    carproof: Run, files: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, plans: str
) -> None:
    if plans == "broken":
        stand_in(tmp_path, monkeypatch, verdict="accepted", cost=6, unplanned=0)
    else:
        stand_in(tmp_path, monkeypatch, verdict="refused", rule="some/rule", message="it is wrong")
    outcome = carproof(command, files["town"], files[plans], "--kernel")
    assert outcome.code == 70
    assert "Internal contradiction: " in outcome.stderr


def test_a_refusal_that_the_kernel_shares_is_shown_with_the_violations_of_the_specification(
    carproof: Run, files: dict[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    stand_in(tmp_path, monkeypatch, verdict="refused", rule="joint/capacity", message="it is wrong")
    outcome = carproof("check", files["town"], files["broken"], "--kernel")
    assert outcome.code == 1
    assert "[joint/capacity]" in outcome.stdout
    assert outcome.stdout.endswith(f"decided by {PROGRAM} 7\n")


def test_certificates_of_queries_are_written_and_verified(
    carproof: Run, files: dict[str, Path], tmp_path: Path
) -> None:
    verified = carproof("verify-query", files["town"], files["plans"], files["query"])
    assert (verified.code, verified.stderr) == (0, "")
    assert verified.stdout.splitlines()[-1].split() == ["r1", "0", "2", "0", "carp_verify"]
    certificate = json.loads(files["query"].read_text())
    wrong = tmp_path / "wrong.json"
    wrong.write_text(json.dumps({**certificate, "bound": 3}))
    outcome = carproof("verify-query", files["town"], files["plans"], wrong)
    assert outcome.code == 1
    assert outcome.stdout.startswith("not proved: $.labels: ")
    assert outcome.stdout.endswith("[query-certificate/closed]\n")
    document = json.loads(carproof("verify-query", files["town"], files["plans"], wrong, "--json").stdout)
    assert (document["proved"], document["bound"], document["rule"]) == (False, None, "query-certificate/closed")
    wrong.write_text(json.dumps({**certificate, "now": True}))
    assert carproof("verify-query", files["town"], files["plans"], wrong).code == 2


def test_a_certificate_is_written_too_where_there_is_no_plan(carproof: Run, tmp_path: Path) -> None:
    park = {
        **TWO,
        "after_goal": "park",
        "robots": [{"id": "r1", "start": "a", "goal": "c"}, {"id": "r2", "start": "b", "goal": "b"}],
    }
    town, plans, query = (tmp_path / name for name in ("town.json", "plans.json", "query.json"))
    town.write_bytes(line(**park))
    stays = {"robot": "r2", "visits": [["b", 0, None]]}
    plans.write_bytes(line(**{**TWO_PLANNED, "plans": [stays], "order": ["r2"], "unplanned": ["r1"]}))
    for engine in ("optimized", "reference"):
        assert carproof("query", town, plans, "r1", "--certificate", query, "--engine", engine).code == 1
        verified = carproof("verify-query", town, plans, query)
        assert verified.stdout.splitlines()[-1].split()[2] == "never"


def test_the_op_verify_query_is_served(carproof: Run, files: dict[str, Path]) -> None:
    certificate = json.loads(files["query"].read_text())
    asked = {"op": "verify-query", "instance": TWO, "solution": TWO_PLANNED}
    requests = [
        line(id=1, **asked, certificate=certificate),
        line(id=2, **asked, certificate={**certificate, "bound": 3}),
        line(id=3, **asked, certificate={**certificate, "bound": True}),
        line(id=4, **asked),
    ]
    answers = [json.loads(each) for each in carproof("serve", stdin=b"".join(requests)).stdout.splitlines()]
    assert answers[0]["result"] == {
        "proved": True, "bound": 2, "path": None, "rule": None, "reason": None, "by": "carp_verify"
    }  # fmt: skip
    assert (answers[1]["result"]["proved"], answers[1]["result"]["rule"]) == (False, "query-certificate/closed")
    assert (answers[2]["error"]["path"], answers[2]["error"]["rule"]) == ("$.certificate.bound", "document/shape")
    assert answers[3]["error"]["path"] == "$.certificate"


def test_a_bound_with_cuts_is_verified_by_the_kernel_and_the_assumptions_are_named(
    carproof: Run, tmp_path: Path
) -> None:
    program()
    town, bound = tmp_path / "town.json", tmp_path / "bound.json"
    certificate = cut_certificate()
    town.write_bytes(write_instance(crossing()))
    bound.write_bytes(write(certificate))
    outcome = carproof("verify-bound", town, bound, "--kernel")
    assert (outcome.code, outcome.stderr) == (0, "")
    assert outcome.stdout.count("assumed: the formula given says") == len(certificate.cuts) > 0
    document = json.loads(carproof("verify-bound", town, bound, "--kernel", "--json").stdout)
    assert (document["bound"], len(document["assumed"])) == (certificate.bound, len(certificate.cuts))
    cuts = (msgspec.structs.replace(certificate.cuts[0], refutation=""), *certificate.cuts[1:])
    bound.write_bytes(write(msgspec.structs.replace(certificate, cuts=cuts)))
    outcome = carproof("verify-bound", town, bound, "--kernel")
    assert (outcome.code, outcome.stdout) == (3, "")
    assert "the refutation of cut 0 does not hold" in outcome.stderr
