"""Break the kernel's driver in OCaml in one place after the other, and list what no test notices.

`make kernel-driver-mutants` runs it; `python -m tests.verify.kernel_driver_mutants verdicts --every 5` runs each fifth
mutant of some files. `kernel_driver_survivors.md` explains what is left.

The driver's files alone are compiled for each mutant. The tests run in a process forked from one that has loaded them,
the last that noticed a mutant first. A mutant that does not compile is not counted.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import monotonic

os.environ["HYPOTHESIS_PROFILE"] = "mutation"

import pytest
from _pytest.runner import runtestprotocol
from tests.verify.kernel_program import built, server

from carp_verify.kernel import VARIABLE

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "verify/kernel"
BUILT = ROOT / "build/kernel"
FILES = ("verdicts", "reading", "main", "search", "encoder")
TESTS = ("test_kernel_certificates", "test_kernel", "test_kernel_optimum", "test_kernel_hostile")
LONGEST = 1.5
"""Seconds: tests that take longer are left out."""
STUCK = 20
"""Seconds after which a test has noticed that the program hangs."""

SWAPS = (
    (r" <> ", " = "),
    (r" <= ", " < "),
    (r" >= ", " > "),
    (r" < ", " <= "),
    (r" > ", " >= "),
    (r"(?<=[\w)]) \+ (?=[\w(])", " - "),
    (r"(?<=[\w)]) - (?=[\w(])", " + "),
    (r" && ", " || "),
    (r" \|\| ", " && "),
    (r"\bZ\.lt\b", "Z.leq"),
    (r"\bZ\.leq\b", "Z.lt"),
    (r"\bZ\.gt\b", "Z.geq"),
    (r"\bZ\.geq\b", "Z.gt"),
    (r"\bZ\.equal\b", "(fun a b -> not (Z.equal a b))"),
    (r"\btrue\b", "false"),
    (r"\bfalse\b", "true"),
    (r"\bnot (?=[(\w])", ""),
    (r"\bList\.exists\b", "List.for_all"),
    (r"\bList\.for_all\b", "List.exists"),
    (r"\bif [^;]*? then\b", "if false then"),
    (r"\bif [^;]*? then\b", "if true then"),
    (r" when [^;]*? ->", " ->"),
    (r"(?<=[ (,])\d[\d_]*\b(?!\.)", "+1"),
)
STATEMENT = re.compile(r"^ +[a-z][^{}\n]*;\n", re.MULTILINE)
ARM = re.compile(r"^ +\| .* -> .*\n(?= *\|)", re.MULTILINE)
EQUATION = re.compile(r"(?:\bif |&& |\|\| |\bwhen |\bnot \()[^;=<>\n]*?(?<![<>])( = )")
PLANTED = (
    # An audit that lets robots exchange resources, and false read as null: an audit of the project planted both.
    (
        "verdicts",
        "Audit.audit_accepted read.instance solution certificates then",
        "Audit.audit read.instance solution certificates = None then",
    ),
    ("reading", "match json with `Null -> None", "match json with `Null | `Bool false -> None"),
)


@dataclass(frozen=True, slots=True)
class Mutant:
    """A file of the driver with one change, at a line."""

    file: str
    line: int
    change: str
    text: str


def code_of(text: str) -> str:
    """The text with strings, comments and first sizes of tables blanked out."""
    blank = re.compile(r'"(?:[^"\\]|\\.)*"|\(\*.*?\*\)', re.DOTALL)
    code = blank.sub(lambda match: re.sub(r"[^\n]", "~", match[0]), text)
    return re.sub(r"\.create \d+", lambda match: "~" * len(match[0]), code)


def mutants(file: str) -> Iterator[Mutant]:
    """The mutants of a file, in its order."""
    text = (SOURCES / f"{file}.ml").read_text()
    code = code_of(text)
    changes: list[tuple[int, int, str]] = []
    for pattern, new in SWAPS:
        for match in re.finditer(pattern, code):
            put = f"({int(match[0])} + 1)" if new == "+1" else new
            changes.append((match.start(), match.end(), put))
    changes += [(match.start(), match.end(), "") for form in (STATEMENT, ARM) for match in form.finditer(code)]
    changes += [(match.start(1), match.end(1), " <> ") for match in EQUATION.finditer(code)]
    for name, old, new in PLANTED:
        if name == file:
            assert text.count(old) == 1, old
            changes.append((text.index(old), text.index(old) + len(old), new))
    for start, end, new in sorted(changes):
        line = text.count("\n", 0, start) + 1
        shown = " ".join(text[start:end].split())
        around = " ".join(text[text.rfind("\n", 0, start) + 1 : text.find("\n", end)].split())
        yield Mutant(
            file, line, f"{shown} -> {new.strip() or 'nothing'}   in: {around[:110]}", text[:start] + new + text[end:]
        )


class Builder:
    """A folder with the kernel's compiled files, in which mutants of the driver are compiled."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        for path in BUILT.iterdir():
            if path.suffix in {".ml", ".mli", ".cmi", ".cmx", ".o"}:
                shutil.copy(path, folder)
        names = sorted(path.name for path in folder.iterdir() if path.suffix in {".ml", ".mli"})
        sort = ["ocamlfind", "ocamldep", "-sort", *names]
        order = subprocess.run(sort, cwd=folder, capture_output=True, text=True, check=True).stdout.split()
        self.driver = [name for name in order if name.removesuffix(".ml") in FILES]
        self.objects = [name.replace(".ml", ".cmx") for name in order if name.endswith(".ml")]

    def built(self, mutant: Mutant) -> Path | None:
        """The program with the mutant in it, if it compiles."""
        for name in self.driver:
            shutil.copy(SOURCES / name, self.folder)
        (self.folder / f"{mutant.file}.ml").write_text(mutant.text)
        first = self.driver.index(f"{mutant.file}.ml")
        compiler = ["ocamlfind", "ocamlopt", "-w", "-a", "-package", "unix,yojson,zarith"]
        for step in (["-c", *self.driver[first:]], ["-linkpkg", *self.objects, "-o", "mutant"]):
            if subprocess.run([*compiler, *step], cwd=self.folder, capture_output=True, check=False).returncode:
                self.restore(first)
                return None
        return self.folder / "mutant"

    def restore(self, first: int) -> None:
        """Compile the driver as it is, so that the next mutant finds it whole."""
        for name in self.driver:
            shutil.copy(SOURCES / name, self.folder)
        command = ["ocamlfind", "ocamlopt", "-w", "-a", "-package", "unix,yojson,zarith", "-c", *self.driver[first:]]
        subprocess.run(command, cwd=self.folder, capture_output=True, check=True)


class Tests:
    """A plugin of pytest that runs the collected tests against each mutant, in place of running them once."""

    def __init__(self, chosen: Sequence[Mutant]) -> None:
        self.chosen = chosen

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Pass all tests once, then run the mutants."""
        timed: list[tuple[float, pytest.Item]] = []
        for item in session.items:
            started = monotonic()
            assert passes(item), item.nodeid
            timed.append((monotonic() - started, item))
        items = [item for seconds, item in sorted(timed, key=lambda each: each[0]) if seconds <= LONGEST]
        server.cache_clear()
        print(f"{len(items)} tests of {len(timed)}", flush=True)  # noqa: T201 - a report
        counts: dict[str, Counter[str]] = {}
        with TemporaryDirectory() as name:
            builder = Builder(Path(name))
            assert outcome_of(Path(built()), items) == "survive", f"{items[0].nodeid} fails in a forked process"
            last = ""
            for mutant in self.chosen:
                if last not in ("", mutant.file):
                    builder.restore(0)
                last = mutant.file
                program = builder.built(mutant)
                outcome = "do not compile" if program is None else outcome_of(program, items)
                counts.setdefault(mutant.file, Counter())[outcome] += 1
                if outcome == "survive":
                    print(f"{mutant.file}:{mutant.line}  {mutant.change}", flush=True)  # noqa: T201
                if counts[mutant.file].total() % 20 == 0:
                    print(f"{mutant.file}: {dict(counts[mutant.file])} so far", flush=True)  # noqa: T201
        for file, of_file in counts.items():
            print(f"{file}: {dict(of_file)}", flush=True)  # noqa: T201
        return True


def passes(item: pytest.Item) -> bool:
    item._initrequest()  # type: ignore[attr-defined]
    return all(report.passed or report.skipped for report in runtestprotocol(item, log=False, nextitem=None))


def outcome_of(program: Path, items: list[pytest.Item]) -> str:
    """Whether a test notices the program, in a process of its own; that test comes first from now on."""
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.setsid()
        os.environ[VARIABLE] = str(program)
        for stream in (1, 2):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
        for number, item in enumerate(items):
            os.write(writing, number.to_bytes(4, "little"))
            signal.alarm(STUCK)
            try:
                passed = passes(item)
            except BaseException:  # noqa: BLE001 - whatever it is, the test has noticed
                passed = False
            if not passed:
                os._exit(1)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as pipe:
        status = os.waitpid(child, 0)[1]
        reached = int.from_bytes(pipe.read()[-4:], "little")
    if status == 0:
        return "survive"
    items.insert(0, items.pop(reached))
    return "noticed"


def main() -> int:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", default=FILES)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    arguments = parser.parse_args()
    os.environ.pop(VARIABLE, None)
    built()
    chosen = [mutant for file in arguments.files for mutant in [*mutants(file)][arguments.first :: arguments.every]]
    print(f"{len(chosen)} mutants", flush=True)  # noqa: T201 - a report
    paths = [str(ROOT / f"tests/verify/{name}.py") for name in TESTS]
    # Tests that take long, or whose time is what they are about.
    slow = "not late_deadline and not long_stays and not which_hints and not idle"
    return pytest.main(
        ["-q", "-s", "-p", "no:cacheprovider", "-p", "no:unraisableexception", "-k", slow, *paths],
        plugins=[Tests(chosen)],
    )


if __name__ == "__main__":
    sys.exit(main())
