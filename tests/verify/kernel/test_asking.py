"""The questions to the kernel's program, and the results of its answers. Shell scripts stand in for it."""

from dataclasses import replace
from pathlib import Path

import msgspec
import pytest

import carp_verify.kernel
from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot, Stop
from carp_spec.documents.decoding import write
from carp_spec.documents.instances import instance_document
from carp_spec.limits import goals_stand_alone
from carp_verify.kernel import (
    PROGRAM,
    VARIABLE,
    KernelVerdict,
    UndecidedError,
    ask,
    is_answer,
    program,
    program_is_there,
    replies,
    request,
    verify_proof,
    version,
)

INSTANCE = Instance(ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),)), (Robot("r1", "a", "b"),))
ACCEPTED = '{"kernel": "7", "verdict": "accepted"}'
REFUSED = '{"kernel": "7", "verdict": "refused", "path": "$.bound", "rule": "bound/total", "message": "too much"}'


@pytest.fixture(name="folder")
def folder_of_kernel(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the only kernel; it notes its arguments, the files that they name, and its input."""
    answers(tmp_path)
    monkeypatch.setenv(VARIABLE, str(tmp_path / PROGRAM))
    return tmp_path


def answers(folder: Path, *lines: str, end: str = "\\n") -> None:
    """Let the kernel of the folder answer these lines, whatever it is asked, and end as one that refuses does."""
    note = f'for each in "$@"; do echo "$each" >> "{folder}/arguments"; cat "$each"/* >> "{folder}/files"; done'
    prints = "".join(f"printf '%s{end}' '{line}'\n" for line in lines)
    (folder / PROGRAM).write_text(
        f'#!/bin/sh\n({note}) 2> /dev/null\ncat > "{folder}/input"\n{prints}echo no >&2\nexit 1\n'
    )
    (folder / PROGRAM).chmod(0o755)


def test_each_request_has_the_answer_in_its_line(folder: Path) -> None:
    answers(folder, ACCEPTED, REFUSED, ACCEPTED)
    asked = [request("check", INSTANCE, solution=number) for number in range(2)]
    assert [answer.accepted for answer in ask(asked)] == [True, False]
    assert (folder / "arguments").read_text() == "serve\n"
    lines = (folder / "input").read_bytes().splitlines(keepends=True)
    assert lines == asked
    document = msgspec.json.decode(write(instance_document(INSTANCE)))
    expected = [{"op": "check", "instance": document, "solution": number} for number in range(2)]
    assert [msgspec.json.decode(line) for line in lines] == expected


@pytest.mark.parametrize(
    "lines", [(), (ACCEPTED,), ("", ACCEPTED), (ACCEPTED, "nonsense"), (ACCEPTED, '{"kernel": 7}')]
)
def test_a_request_without_an_answer_is_refused(folder: Path, lines: tuple[str, ...]) -> None:
    answers(folder, *lines)
    with pytest.raises(Refusal) as refused:
        ask([b"{}\n"] * 2)
    assert (refused.value.path, refused.value.rule) == ("$.kernel", "kernel/answer")


def test_an_answer_may_say_more_of_a_solution_or_a_bound(folder: Path) -> None:
    answers(folder, '{"kernel": "7", "verdict": "accepted", "cost": 3, "unplanned": 1, "bound": 2}')
    assert ask([b"{}\n"]) == [KernelVerdict("7", "accepted", cost=3, unplanned=1, bound=2)]


def test_a_request_behind_a_line_without_an_end_has_no_answer(folder: Path) -> None:
    answers(folder, ACCEPTED, end="")
    with pytest.raises(Refusal, match="ended without an answer"):
        ask([b"{}\n"] * 2)
    assert ask([b"{}\n"])[0].accepted


def test_a_kernel_that_takes_too_long_has_answered_the_lines_that_it_ended(folder: Path) -> None:
    answers(folder, ACCEPTED, REFUSED)
    script = folder / PROGRAM
    script.write_text(script.read_text().replace("echo no", "printf cut\nexec sleep 60\necho no"))
    assert replies([b"{}\n"] * 3, 3) == [ACCEPTED, REFUSED]
    answers(folder)
    script.write_text(script.read_text().replace("echo no", "exec sleep 60\necho no"))
    assert replies([b"{}\n"], 0.1) == []


def test_the_kernel_is_not_asked_for_bounds_of_robots_with_stops() -> None:
    to_and_fro = replace(INSTANCE, robots=(replace(INSTANCE.robots[0], stops=(Stop("b"), Stop("a"))),))
    assert request("verify-query", to_and_fro)
    with pytest.raises(Refusal) as refused:
        request("verify-bound", to_and_fro)
    assert refused.value.rule == goals_stand_alone.id


def test_the_version_is_asked_of_the_program_itself(folder: Path) -> None:
    answers(folder, '{"kernel": "7", "verdict": "bad input"}')
    assert version() == "carproof-kernel 7"


def test_a_proof_is_verified_from_its_files(folder: Path) -> None:
    answers(folder, REFUSED)
    verdict = verify_proof({"manifest.json": b"claim", "beat.lrat": b"steps"})
    assert (verdict.accepted, verdict.rule, verdict.message) == (False, "bound/total", "too much")
    command, directory = (folder / "arguments").read_text().splitlines()
    assert (command, Path(directory).exists()) == ("verify-proof", False)
    assert (folder / "files").read_bytes() == b"stepsclaim"


@pytest.mark.parametrize(
    ("line", "is_one"),
    [
        (ACCEPTED, True),
        (REFUSED, True),
        ('{"kernel": "7", "verdict": "yes"}', False),
        ('{"verdict": "accepted"}', False),
        ('{"kernel": "7", "verdict": "accepted", "cost": "1"}', False),
        ("", False),
        ("[]", False),
        ("\udcff", False),
    ],
)
def test_an_answer_has_a_version_and_a_verdict(line: str, is_one: bool) -> None:
    assert is_answer(line) is is_one


def test_what_is_no_acceptance_is_a_refusal_undecided_or_not_read() -> None:
    assert KernelVerdict("7", "accepted").accepted
    assert not KernelVerdict("7", "refused").accepted
    with pytest.raises(UndecidedError, match="carproof-kernel 7: too large"):
        KernelVerdict("7", "undecided", message="too large").accepted  # noqa: B018 - it raises
    for rule, shown in (("document/shape", "document/shape"), (None, "kernel/answer")):
        with pytest.raises(Refusal, match="carproof-kernel 7: no instance") as refused:
            KernelVerdict("7", "bad input", "$.x", rule, "no instance").accepted  # noqa: B018
        assert (refused.value.kind, refused.value.path, refused.value.rule) == ("document", "$.x", shown)


def test_a_kernel_is_there_where_its_program_was_found() -> None:
    assert program_is_there("/bin/carproof-kernel")
    assert not program_is_there(None)


def test_the_program_named_goes_before_the_one_built_and_this_before_the_one_on_the_path(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    built, on_path = tmp_path / "built", tmp_path / "path" / PROGRAM
    on_path.parent.mkdir()
    for each in (built, on_path):
        each.write_text("#!/bin/sh\n")
        each.chmod(0o755)
    monkeypatch.setattr(carp_verify.kernel, "BUILT", built)
    monkeypatch.setenv("PATH", str(on_path.parent))
    assert program() == str(folder / PROGRAM)
    monkeypatch.delenv(VARIABLE)
    assert program() == str(built)
    built.unlink()
    assert program() == str(on_path)
    on_path.unlink()
    with pytest.raises(Refusal, match="there is no program carproof-kernel; `make kernel` builds it") as refused:
        program()
    assert (refused.value.path, refused.value.rule) == ("$.kernel", "kernel/program")
    monkeypatch.setenv(VARIABLE, str(tmp_path / "elsewhere"))
    with pytest.raises(Refusal, match="kernel/program"):
        program()
