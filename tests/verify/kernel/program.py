"""The proved kernel, for tests."""

import fcntl
import json
import os
import re
import subprocess
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from shutil import which
from typing import Any

import msgspec
import pytest

from carp_spec import Instance, Refusal, Solution
from carp_spec.documents.bounds import BoundDocument
from carp_spec.documents.instances import instance_document
from carp_spec.documents.solutions import solution_document
from carp_verify.kernel import VARIABLE

ROOT = Path(__file__).parents[3]
PROGRAM = ROOT / "build/kernel/carproof-kernel"
Json = Any
PACKAGES = "coq, ocaml, ocaml-findlib, libyojson-ocaml-dev and libzarith-ocaml-dev"


def program() -> str:
    """The kernel's program: the one that `VARIABLE` names, or else ours."""
    return os.environ.get(VARIABLE) or built()


@cache
def built() -> str:
    """Our kernel, made by `make kernel` if its sources have changed; for the first time only where all is required."""
    is_required = os.environ.get("CARPROOF_REQUIRE_ALL") == "1"
    if not all(map(which, ("coqc", "ocamlfind", "ocamlopt"))):
        reason = f"the kernel needs the Debian packages {PACKAGES}"
        if is_required:
            pytest.fail(reason)
        pytest.skip(reason)
    if not is_required and not PROGRAM.exists():
        pytest.skip("the kernel is not built yet, which takes Coq a minute: make kernel")
    PROGRAM.parent.mkdir(parents=True, exist_ok=True)
    with (PROGRAM.parent / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        made = subprocess.run(
            [which("make") or "make", "kernel"], cwd=ROOT, capture_output=True, text=True, check=False
        )
    assert made.returncode == 0, made.stderr
    return str(PROGRAM)


@cache
def server() -> "subprocess.Popen[str]":
    """A kernel that stays up."""
    return subprocess.Popen([program(), "serve"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def served() -> Iterator[None]:
    """A fixture: the kernel stays up until the tests of a module have ended."""
    kernel = server()
    yield
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


def refusal_of(read: Callable[[], object]) -> Refusal | None:
    """Why Python does not read or accept something, if it does not."""
    try:
        read()
    except Refusal as refusal:
        return refusal
    return None


def require_bad_input(answer: Json, refusal: Refusal, name: str) -> None:
    """The kernel cannot read the document of that name by the same rule and, of a list of values, in one of them."""
    assert (answer["verdict"], answer["rule"]) == ("bad input", refusal.rule)
    ours, theirs = (
        re.sub(r"(\[\d+\])+$", "", path) for path in (f"$.{name}{refusal.path.removeprefix('$')}", answer["path"])
    )
    assert ours.startswith(theirs) or theirs.startswith(ours)


def encoded(**request: object) -> str:
    return msgspec.json.encode(request).decode()


def run(*arguments: str | Path) -> tuple[int, Json, str]:
    """Run the kernel once: exit code, verdict, and what it prints on standard error."""
    done = subprocess.run([program(), *map(str, arguments)], capture_output=True, text=True, check=False)
    return done.returncode, json.loads(done.stdout) if done.stdout else None, done.stderr
