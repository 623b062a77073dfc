"""Runs `carproof-kernel`, the native program whose verdicts are proved in Coq (`kernel/`)."""

import os
import subprocess
from collections.abc import Mapping, Sequence
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from typing import Any, Final, Literal

import msgspec

from carp_spec import Instance, Refusal, Rule
from carp_spec.documents.instances import instance_document
from carp_spec.limits import refuse_stops
from carp_spec.rule import DESIGN, rule

PROGRAM: Final = "carproof-kernel"
VARIABLE: Final = "CARPROOF_KERNEL"
BUILT: Final = Path(__file__).parents[2] / "build/kernel" / PROGRAM


@rule(
    "kernel/program",
    f"The kernel is asked only where its program is: the file that {VARIABLE} names, else the one that `make kernel` "
    f"builds, else {PROGRAM} on the PATH.",
    DESIGN,
)
def program_is_there(program: str | None) -> bool:
    """Whether a program was found."""
    return program is not None


@rule("kernel/answer", "The kernel answers each request by one line of JSON.", DESIGN)
def is_answer(line: str) -> bool:
    """Whether the line is an answer of the kernel."""
    try:
        msgspec.json.decode(line, type=KernelVerdict)
    except (msgspec.DecodeError, UnicodeError):
        return False
    return True


KERNEL_RULES: tuple[Rule[..., Any], ...] = (program_is_there, is_answer)


class UndecidedError(RuntimeError):
    """The kernel could not decide."""


class KernelVerdict(msgspec.Struct, frozen=True):
    """A verdict of the kernel's version `kernel`, and the other fields of its answer."""

    kernel: str
    verdict: Literal["accepted", "refused", "undecided", "bad input"]
    path: str = "$"
    rule: str | None = None
    message: str | None = None
    cost: int | None = None
    unplanned: int | None = None
    bound: int | None = None

    @property
    def by(self) -> str:
        """Who decided."""
        return f"{PROGRAM} {self.kernel}"

    @property
    def accepted(self) -> bool:
        """Whether the kernel accepts; raises `Refusal` for documents that it cannot read, and `UndecidedError`."""
        if self.verdict == "bad input":
            raise Refusal("document", self.path, self.rule or is_answer.id, f"{self.by}: {self.message}")
        if self.verdict == "undecided":
            raise UndecidedError(f"{self.by}: {self.message}")
        return self.verdict == "accepted"


def find_program() -> str | None:
    """The kernel's program, if one exists."""
    built = str(BUILT) if BUILT.is_file() else None
    return which(os.environ[VARIABLE]) if VARIABLE in os.environ else built or which(PROGRAM)


def program() -> str:
    """The kernel's program; raises `Refusal` if none exists."""
    found = find_program()
    if found is None:
        message = (
            f"there is no program {PROGRAM}; `make kernel` builds it, with the Debian packages coq, ocaml, "
            "ocaml-findlib, libyojson-ocaml-dev and libzarith-ocaml-dev"
        )
        raise Refusal("request", "$.kernel", program_is_there.id, message)
    return found


def request(op: str, instance: Instance, **documents: object) -> bytes:
    """One line that asks the kernel; raises `Refusal` if it does not decide the question about such an instance."""
    if op == "verify-bound":
        refuse_stops(instance)
    return msgspec.json.encode({"op": op, "instance": instance_document(instance), **documents}) + b"\n"


def ask(requests: Sequence[bytes]) -> list[KernelVerdict]:
    """Send requests to one run of the kernel; raises `Refusal` if there is no program, or no answer to a request."""
    lines = replies(requests)
    return [verdict_of(lines[number] if number < len(lines) else "") for number in range(len(requests))]


def replies(requests: Sequence[bytes], seconds: float | None = None) -> list[str]:
    """The lines with which one run of the kernel answers requests: fewer if it ends early, or after these seconds."""
    command = [program(), "serve"]
    try:
        done = subprocess.run(  # noqa: S603 - ours
            command, input=b"".join(requests), stdout=subprocess.PIPE, check=False, timeout=seconds
        )
    except subprocess.TimeoutExpired as expired:
        return (expired.stdout or b"").decode(errors="replace").split("\n")[:-1]
    text = done.stdout.decode(errors="replace")
    return text.removesuffix("\n").split("\n") if text else []


def version() -> str:
    """The kernel's name and version; raises `Refusal` if there is no program."""
    return ask([b"{}\n"])[0].by


def verify_proof(files: Mapping[str, bytes]) -> KernelVerdict:
    """The kernel's answer about a proof directory's instance, manifest and refutation: that no plans cost less."""
    with TemporaryDirectory() as name:
        for file, content in files.items():
            (Path(name) / file).write_bytes(content)
        command = [program(), "verify-proof", name]
        done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603 - ours
        return verdict_of(done.stdout)


def verdict_of(line: str) -> KernelVerdict:
    """The verdict in a line; raises `Refusal` if it is none."""
    if not is_answer(line):
        raise Refusal("limit", "$.kernel", is_answer.id, f"{PROGRAM} ended without an answer")
    return msgspec.json.decode(line, type=KernelVerdict)
