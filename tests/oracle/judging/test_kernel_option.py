"""`--kernel`: the kernel's verdicts are passed on, and its absence is one sentence. A stand-in answers in its place."""

import json
import sys
from pathlib import Path

import msgspec
import pytest
from tests.oracle.api.test_optimum import UNSOLVABLE
from tests.oracle.running import EAST, Outcome, Run, corridor, save, solution
from tests.verify.bound.examples import crossing, deadline_certificate
from tests.verify.kernel.program import program

import carp_verify.kernel
from carp_spec.documents.decoding import write
from carp_verify.kernel import PROGRAM, VARIABLE
from carproof import write_instance

STAND_IN = """#!{python}
import json, sys
if sys.argv[1] != "serve":
    sys.exit(print({answer!r}))
for line in sys.stdin:
    json.loads(line)
    print({answer!r}, flush=True)
"""


@pytest.fixture(autouse=True)
def _certificates(folder: Path, carproof: Run) -> None:
    """Certificates of a query, of a bound and of an optimum."""
    del folder
    carproof("optimum town.json --proof proof")
    carproof("query town.json plans.json r1 --certificate query.json")
    carproof("bound town.json --steps 3 -o bound.json")


def stand_in(monkeypatch: pytest.MonkeyPatch, **answer: object) -> None:
    """A kernel that gives one answer to all that it is asked."""
    program = Path(PROGRAM).absolute()
    text = json.dumps({"kernel": "7", **answer}) if answer else "nonsense"
    program.write_text(STAND_IN.format(python=sys.executable, answer=text))
    program.chmod(0o755)
    monkeypatch.setenv(VARIABLE, str(program))


COMMANDS = [
    "check town.json plans.json --kernel",
    "audit town.json plans.json --kernel",
    "verify proof --kernel",
    "verify town.json plans.json query.json --kernel",
    "verify town.json bound.json --kernel",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_what_the_kernel_accepts_is_accepted_in_its_name(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    stand_in(monkeypatch, verdict="accepted", cost=5, unplanned=0, bound=proved_by(command))
    outcome = carproof(command)
    assert (outcome.code, outcome.stderr) == (0, "")
    assert f"{PROGRAM} 7" in outcome.stdout
    document = json.loads(carproof(command, "--json").stdout)
    assert "7" in document.get("by", document.get("kernel"))


def proved_by(command: str) -> int:
    """The bound that its certificate proves: robot r1 arrives at tick 2, and the least total cost is 5."""
    return 2 if "query.json" in command else 5


def forge(command: str) -> None:
    """Let the certificate of the command claim a tick more."""
    for name in ("query.json", "bound.json"):
        if name in command:
            honest = json.loads(Path(name).read_text())
            Path(name).write_text(json.dumps({**honest, "bound": honest["bound"] + 1}))


def require_contradiction(outcome: Outcome) -> None:
    assert (outcome.code, outcome.stdout, "Internal contradiction: " in outcome.stderr) == (70, "", True)


@pytest.mark.parametrize("command", COMMANDS[3:])
def test_a_kernel_refuses_with_python_or_contradicts_it(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    stand_in(monkeypatch, verdict="accepted", bound=proved_by(command) - 1)
    require_contradiction(carproof(command))
    too_large = "query-certificate/size" if "query.json" in command else "bound/size"
    stand_in(monkeypatch, verdict="refused", rule=too_large, message="it is large")
    assert carproof(command) == Outcome(1, f"not proved: $: it is large [{too_large}]\n", "")
    forge(command)
    stand_in(monkeypatch, verdict="accepted", bound=proved_by(command) + 1)
    require_contradiction(carproof(command))
    stand_in(monkeypatch, verdict="refused", rule="some/rule", message="it is wrong")
    assert carproof(command) == Outcome(1, "not proved: $: it is wrong [some/rule]\n", "")


def test_a_certificate_of_another_instance_is_refused_whatever_the_kernel_says(
    carproof: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    save(bound={**json.loads(Path("bound.json").read_text()), "instance": "0" * 64})
    stand_in(monkeypatch, verdict="accepted", bound=5)
    outcome = carproof(COMMANDS[4])
    assert (outcome.code, "[bound/instance]" in outcome.stdout) == (1, True)


@pytest.mark.parametrize("command", COMMANDS)
def test_what_the_kernel_cannot_decide_or_read_is_neither(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    stand_in(monkeypatch, verdict="undecided", message="too large")
    assert carproof(command) == Outcome(3, "", f"Undecided: {PROGRAM} 7: too large\n")
    stand_in(monkeypatch, verdict="bad input", path="$.x", rule="document/shape", message="it is not read")
    outcome = carproof(command)
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr.endswith("it is not read [document/shape]\n")
    stand_in(monkeypatch)
    ended = f"Error: --kernel: {PROGRAM} ended without an answer [kernel/answer]\n"
    assert carproof(command) == Outcome(2, "", ended)


@pytest.mark.parametrize("command", COMMANDS)
def test_without_a_kernel_one_sentence_says_how_to_build_it(
    carproof: Run, folder: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    monkeypatch.setattr(carp_verify.kernel, "BUILT", folder / "none")
    monkeypatch.setenv("PATH", str(folder))
    monkeypatch.delenv(VARIABLE, raising=False)
    outcome = carproof(command)
    assert (outcome.code, outcome.stdout) == (2, "")
    assert outcome.stderr.startswith(f"Error: --kernel: there is no program {PROGRAM}; `make kernel` builds it, with")
    monkeypatch.setenv(VARIABLE, str(folder / "elsewhere"))
    assert carproof(command).code == 2
    stand_in(monkeypatch, verdict="accepted", cost=5, unplanned=0, bound=proved_by(command))
    monkeypatch.delenv(VARIABLE)
    assert carproof(command).code == 0, "the program is on the PATH"


@pytest.mark.parametrize("command", ["check town.json broken.json", *COMMANDS])
def test_a_kernel_that_differs_is_a_contradiction(carproof: Run, monkeypatch: pytest.MonkeyPatch, command: str) -> None:
    if "broken" in command:
        stand_in(monkeypatch, verdict="accepted", cost=6, unplanned=0)
    else:
        stand_in(monkeypatch, verdict="refused", rule="some/rule", message="it is wrong")
    require_contradiction(carproof(command.removesuffix(" --kernel"), "--kernel"))


def test_a_refusal_that_the_kernel_shares_is_shown_with_the_violations_of_the_specification(
    carproof: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    stand_in(monkeypatch, verdict="refused", rule="joint/capacity", message="it is wrong")
    outcome = carproof("check town.json broken.json --kernel")
    assert outcome.code == 1
    assert "[joint/capacity]" in outcome.stdout
    assert outcome.stdout.endswith(f"decided by {PROGRAM} 7\n")


def test_a_size_that_only_python_refuses_is_no_contradiction(carproof: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    far = 10**9
    save(bound={**json.loads(Path("bound.json").read_text()), "horizon": far, "resources": [["a", far - 1, 1]]})
    stand_in(monkeypatch, verdict="accepted", bound=5)
    assert carproof(COMMANDS[4]).code == 0


def test_a_proof_is_verified_without_a_kernel_that_cannot_decide(
    carproof: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    stand_in(monkeypatch, verdict="undecided", message="too large")
    decided = carproof("verify proof")
    assert (decided.code, decided.stderr, "decided by" in decided.stdout) == (0, "", False)
    monkeypatch.setenv(VARIABLE, "nowhere")
    assert carproof("verify proof") == decided


@pytest.mark.parametrize(
    "answer",
    [
        {"bound": 6, "cost": 5},
        {"bound": 4, "cost": 5},
        {"bound": 5, "cost": 4},
        {"bound": 5, "cost": 5, "unplanned": 1},
        {"verdict": "refused", "path": "$", "rule": "refutation/step", "message": "it follows from nothing"},
    ],
)
def test_a_kernel_that_proves_something_else_is_a_contradiction(
    carproof: Run, monkeypatch: pytest.MonkeyPatch, answer: dict[str, object]
) -> None:
    stand_in(monkeypatch, **{"verdict": "accepted", "unplanned": 0, **answer})
    require_contradiction(carproof("verify proof"))


def test_the_kernel_proves_an_optimum_and_no_obstacle_but_clauses(
    carproof: Run, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(VARIABLE, program())
    outcome = carproof("verify proof --kernel")
    assert (outcome.code, outcome.stdout.splitlines()[-1]) == (0, f"decided by {PROGRAM} 1")
    document = json.loads(carproof("verify proof --kernel --json").stdout)
    assert (document["proved"], document["cost"], document["by"]) == (True, 5, f"{PROGRAM} 1")
    save(lane=UNSOLVABLE)
    carproof("optimum lane.json --proof lane")
    assert carproof("verify-proof lane").code == 0
    outcome = carproof("verify-proof lane --kernel")
    assert (outcome.code, "the obstacle must be clauses" in outcome.stderr) == (2, True)


def test_a_certificate_is_written_too_where_there_is_no_plan(carproof: Run) -> None:
    standing = {"id": "r2", "start": "b", "goal": "b"}
    save(park=corridor([EAST, standing], "park"), stands=solution({"r2": [["b", 0, None]]}, ["r1"]))
    for engine in ("optimized", "reference"):
        assert carproof(f"query park.json stands.json r1 --certificate query.json --engine {engine}").code == 1
        verified = carproof("verify park.json stands.json query.json")
        assert verified.stdout.splitlines()[-1].split()[2] == "never"


@pytest.mark.parametrize("change", [{"ticks": (2,)}, {"ticks": (2, 2, 2)}, {"seen": ((1, ("middle",)),)}])
def test_deadlines_that_are_not_of_each_robot_are_refused_by_the_kernel_too(
    carproof: Run, folder: Path, change: dict[str, object]
) -> None:
    program()
    certificate = deadline_certificate()
    deadlines = (msgspec.structs.replace(certificate.deadlines[0], **change),)
    (folder / "town.json").write_bytes(write_instance(crossing()))
    (folder / "bound.json").write_bytes(write(msgspec.structs.replace(certificate, deadlines=deadlines)))
    assert carproof("verify town.json bound.json").code == 1
    outcome = carproof("verify --kernel town.json bound.json")
    assert (outcome.code, outcome.stderr) == (1, "")
    assert "[bound/deadline]" in outcome.stdout
