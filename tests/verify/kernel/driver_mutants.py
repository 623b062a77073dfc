"""Break the kernel's driver in OCaml in one place after the other, and list what no test notices.

`make kernel-driver-mutants` runs it, and continues where it stopped. `python -m tests.verify.kernel.driver_mutants
verdicts --every 5` runs each fifth mutant of some files, and `--again` those that survived before. Two runs at a time
may share the work by files.
`driver_survivors.md` explains what is left.

The tests run once, and what they ask the kernel is kept with its answers. A mutant is compiled to bytecode, in the
file that it changes alone, and asked the same. A test runs against it only if one of its answers differs: the test,
and no wording, decides whether the mutant is noticed. A mutant that does not compile is not counted.
"""

import json
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
from argparse import ArgumentParser
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from functools import cache
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Thread
from typing import Any, TextIO

os.environ["HYPOTHESIS_PROFILE"] = "mutation"

import pytest
from _pytest.runner import runtestprotocol
from tests.verify.kernel import program as kernel_program
from tests.verify.kernel.program import built

from carp_verify.kernel import VARIABLE

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / "verify/kernel"
BUILT = ROOT / "build/kernel"
STORE = ROOT / "build/kernel_driver_mutants.jsonl"
FILES = ("verdicts", "reading", "main", "search", "encoder")
TESTS = ("test_certificates", "test_verdicts", "test_optimum", "test_hostile")
LONGEST = 0.5
"""Seconds of processor time: tests whose questions take the kernel longer are left out."""
STUCK = 5
"""Seconds of processor time after which the kernel hangs, and a test has noticed it."""
MOST_BYTES = 3 << 30
TOGETHER = 40
"""So many tests are asked at a time."""
PACKAGES = ("-package", "unix,yojson,zarith")
LIMITED = f'ulimit -t {STUCK}; ulimit -v {MOST_BYTES >> 10}; exec "$0" "$@"'

BATCH = "CARPROOF_BATCH"
"""The variable that names a file of commands, which a built program then runs one after the other."""
BATCH_MODULE = f"""
let argv = ref Sys.argv
let contents file =
  let channel = open_in_bin file in
  let text = really_input_string channel (in_channel_length channel) in
  close_in channel; text
let redirect file flags target = Unix.dup2 (Unix.openfile file flags 0o600) target
let rec run folder commands =
  match input_line commands with
  | exception End_of_file -> Stdlib.exit 0
  | line -> (
      let words = String.split_on_char '\\t' line in
      let output = Filename.concat folder "output" and errors = Filename.concat folder "errors" in
      match Unix.fork () with
      | 0 ->
          ignore (Unix.alarm {60 * STUCK});
          redirect (List.hd words) [ O_RDONLY ] Unix.stdin;
          redirect output [ O_WRONLY; O_CREAT; O_TRUNC ] Unix.stdout;
          redirect errors [ O_WRONLY; O_CREAT; O_TRUNC ] Unix.stderr;
          argv := Array.of_list ("kernel" :: List.tl words)
      | child ->
          let code = match snd (Unix.waitpid [] child) with WEXITED code -> code | WSIGNALED _ | WSTOPPED _ -> -1 in
          let text = Printf.sprintf "%d %s %s" code (contents output) (contents errors) in
          Printf.printf "%d\\n%s%!" (String.length text) text;
          run folder commands)
let () =
  match Sys.getenv_opt "{BATCH}" with
  | None -> ()
  | Some file -> run (Filename.dirname file) (open_in_bin file)
"""
"""Linked before the driver: a program in its own process for each command, without starting it anew."""

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

    @property
    def key(self) -> str:
        """The same for the same text of the file."""
        return sha256(f"{self.file}\n{self.text}".encode()).hexdigest()[:20]


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
    """A folder with the kernel in bytecode, in which mutants of the driver are compiled."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.changed: str | None = None
        """The file that has the last mutant in it."""
        for path in [*BUILT.glob("*.ml"), *BUILT.glob("*.mli")]:
            shutil.copy(path, folder)
        (folder / "batch.ml").write_text(BATCH_MODULE)
        for path in SOURCES.glob("*.ml"):
            self.write(path.name, path.read_text())
        names = sorted(path.name for path in folder.iterdir())
        order = self.run("ocamldep", "-sort", *names).split()
        self.objects = [name.replace(".ml", ".cmo") for name in order if name.endswith(".ml")]
        for name in order:
            if name.removesuffix(".ml") in FILES:
                # With an interface of its own a file can be compiled alone.
                (folder / f"{name}i").write_text(self.run("ocamlc", "-i", name))
                self.run("ocamlc", "-c", f"{name}i")
            self.run("ocamlc", "-c", name)
        self.link()

    def write(self, name: str, text: str) -> None:
        """Write a file of the driver, which takes its arguments from the batch if there is one."""
        (self.folder / name).write_text(text.replace("Sys.argv", "!Batch.argv"))

    def run(self, tool: str, *arguments: str) -> str:
        """What a tool of OCaml prints."""
        command = ["ocamlfind", tool, *(() if tool == "ocamldep" else ("-w", "-a", *PACKAGES)), *arguments]
        return subprocess.run(command, cwd=self.folder, capture_output=True, text=True, check=True).stdout

    def link(self) -> None:
        """Make the program."""
        self.run("ocamlc", "-linkpkg", *self.objects, "-o", "mutant")

    def built(self, mutant: Mutant) -> Path | None:
        """The program with the mutant in it, if it compiles."""
        name = f"{mutant.file}.ml"
        if self.changed not in (None, name):
            self.write(self.changed, (SOURCES / self.changed).read_text())
            self.run("ocamlc", "-c", self.changed)
        self.changed = name
        self.write(name, mutant.text)
        try:
            self.run("ocamlc", "-c", name)
            self.link()
        except subprocess.CalledProcessError:
            return None
        return self.folder / "mutant"


@dataclass(slots=True)
class Asked:
    """What a test asks the kernel: lines that are served, and commands, each with its answer."""

    item: pytest.Item
    lines: list[tuple[str, str]] = field(default_factory=list)
    commands: list[tuple[tuple[str, ...], str | None]] = field(default_factory=list)
    answers: list[bytes] = field(default_factory=list)
    is_whole: bool = True
    """Whether nothing else was asked."""
    time: float = 0.0
    """Seconds of processor time that the answers take."""


class Recording:
    """Stands in for the kernel that stays up, and keeps what it is asked."""

    def __init__(self, asked: Asked) -> None:
        self.asked = asked
        self.kernel = started(Path(kernel_program.program()))
        self.stdin = self.stdout = self
        self.line = ""

    def write(self, line: str) -> None:
        self.line = line
        assert self.kernel.stdin
        self.kernel.stdin.write(line)

    def flush(self) -> None:
        assert self.kernel.stdin
        self.kernel.stdin.flush()

    def readline(self) -> str:
        assert self.kernel.stdout
        self.asked.lines.append((self.line, self.kernel.stdout.readline()))
        return self.asked.lines[-1][1]

    def communicate(self) -> None:
        self.kernel.communicate()


def started(program: Path) -> "subprocess.Popen[str]":
    command = ["/bin/sh", "-c", LIMITED, str(program), "serve"]
    return subprocess.Popen(
        command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace"
    )


def commanded(program: Path, tests: Sequence[Asked]) -> Iterator[tuple[Asked, int, bytes]]:
    """All that runs of the program answer, each with its test and the number of its command there."""
    with TemporaryDirectory(ignore_cleanup_errors=True) as name:
        folder = Path(name)
        lines: list[str] = []
        for asked in tests:
            for words, text in asked.commands:
                given = folder / f"{len(lines)}" if text else Path(os.devnull)
                if text:
                    given.write_text(text)
                assert not any(set("\t\n") & set(word) for word in words)
                lines.append("\t".join((str(given), *words)) + "\n")
        (folder / "commands").write_text("".join(lines))
        command = ["/bin/sh", "-c", LIMITED, str(program)]
        environment = {**os.environ, BATCH: str(folder / "commands")}
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=environment) as runs:
            assert runs.stdout
            try:
                for asked in tests:
                    for number in range(len(asked.commands)):
                        length = runs.stdout.readline()
                        yield asked, number, runs.stdout.read(int(length)) if length else b""
            finally:
                runs.kill()


def recorded(item: pytest.Item, folder: Path) -> Asked:
    """Run a test, which must pass, and keep what it asks; the files that it names are copied."""
    asked = Asked(item)
    program, server, run = kernel_program.program(), kernel_program.server, subprocess.run

    def keep(command: Sequence[str | Path], **options: Any) -> Any:  # noqa: ANN401 - as subprocess.run
        words = [str(each) for each in command]
        if words[0] != program:
            asked.is_whole = asked.is_whole and not any(program in word for word in words)
            return run(command, **options)
        for number, word in enumerate(words[1:], 1):
            if Path(word).exists():
                place = folder / f"{len([*folder.iterdir()])}"
                place.mkdir()
                run(["cp", "-a", word, place], check=True)
                words[number] = str(place / Path(word).name)
        text = options.get("input")
        asked.commands.append((tuple(words[1:]), text))
        return run(command, **options)

    kernel_program.server = cache(lambda: Recording(asked))  # type: ignore[arg-type, return-value]
    subprocess.run = keep  # type: ignore[assignment]
    try:
        assert passes(item), item.nodeid
    finally:
        kernel_program.server, subprocess.run = server, run
    return asked


class Tests:
    """A plugin of pytest that runs the collected tests against each mutant, in place of running them once."""

    def __init__(self, chosen: Sequence[Mutant], store: TextIO) -> None:
        self.chosen = chosen
        self.store = store

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        """Pass all tests once, then run the mutants."""
        with TemporaryDirectory() as files, TemporaryDirectory() as name:
            builder = Builder(Path(name))
            original = Path(shutil.copy(builder.folder / "mutant", builder.folder / "original"))
            tests = [recorded(item, Path(files)) for item in session.items]
            order = [asked for asked in tests if is_soon_answered(original, asked)]
            order.sort(key=lambda asked: asked.time)
            say(f"{len(order)} tests of {len(tests)}")
            assert outcome_of(original, order) == ("survives", ""), "the driver as it is"
            self.run(builder, order)
        return True

    def run(self, builder: Builder, order: list[Asked]) -> None:
        """Run the mutants, and keep what comes of them."""
        for number, mutant in enumerate(self.chosen, 1):
            program = builder.built(mutant)
            outcome, test = ("does not compile", "") if program is None else outcome_of(program, order)
            result = {"key": mutant.key, "file": mutant.file, "outcome": outcome, "test": test}
            self.store.write(json.dumps({**result, "line": mutant.line, "change": mutant.change}) + "\n")
            self.store.flush()
            if number % 50 == 0:
                say(f"{number} of {len(self.chosen)}")


def say(line: str) -> None:
    print(line, flush=True)  # noqa: T201 - a report


def is_soon_answered(program: Path, asked: Asked) -> bool:
    """Whether the program answers all that the test asks within its time; its answers to commands are kept."""
    before = processor_time()
    asked.answers = [answer for _, _, answer in commanded(program, [asked])]
    differs = any(True for _ in served_differently(program, [asked]))
    differs = differs or (not asked.is_whole and notices(asked.item, program))
    asked.time = processor_time() - before
    return not differs and asked.time <= LONGEST


def processor_time() -> float:
    """Seconds of the programs that have ended, however busy the machine is."""
    times = os.times()
    return times.children_user + times.children_system


def passes(item: pytest.Item) -> bool:
    item._initrequest()  # type: ignore[attr-defined]
    return all(report.passed or report.skipped for report in runtestprotocol(item, log=False, nextitem=None))


def served_differently(program: Path, tests: Sequence[Asked]) -> Iterator[Asked]:
    """The tests of which the program answers a line in another way."""
    left = [(asked, line, answer) for asked in tests for line, answer in asked.lines]
    while left:
        kernel = started(program)
        writer = Thread(target=_write, args=(kernel, [line for _, line, _ in left]))
        writer.start()
        failed = None
        try:
            assert kernel.stdout
            for asked, _, answer in left:
                if kernel.stdout.readline() != answer:
                    failed = asked
                    break
        finally:
            kernel.kill()
            writer.join()
            if kernel.stdout is not None:
                kernel.stdout.close()
            kernel.wait()
        if failed is None:
            return
        yield failed
        last = max(number for number, (asked, _, _) in enumerate(left) if asked is failed)
        left = left[last + 1 :]


def _write(kernel: "subprocess.Popen[str]", lines: Sequence[str]) -> None:
    assert kernel.stdin
    with suppress(OSError), kernel.stdin as lines_to:  # it may have been ended
        for line in lines:
            lines_to.write(line)


def differing(program: Path, tests: Sequence[Asked]) -> Iterator[Asked]:
    """The tests that are answered in another way, and those that ask more than is kept."""
    for first in range(0, len(tests), TOGETHER):
        some = tests[first : first + TOGETHER]
        yield from served_differently(program, some)
        differs = None
        for asked, number, answer in commanded(program, some):
            if asked is not differs and answer != asked.answers[number]:
                differs = asked
                yield asked
    yield from (asked for asked in tests if not asked.is_whole)


def outcome_of(program: Path, tests: list[Asked]) -> tuple[str, str]:
    """Whether a test notices the program, and which; that test comes first from now on."""
    for asked in differing(program, tuple(tests)):
        if notices(asked.item, program):
            tests.remove(asked)
            tests.insert(0, asked)
            return "noticed", asked.item.nodeid
    return "survives", ""


def notices(item: pytest.Item, program: Path) -> bool:
    """Whether the test fails with the program, in a process of its own."""
    child = os.fork()
    if child == 0:
        os.setsid()
        os.environ[VARIABLE] = str(program)
        resource.setrlimit(resource.RLIMIT_CPU, (STUCK, STUCK))
        signal.alarm(60 * STUCK)
        for stream in (1, 2):
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
        passed = False
        try:
            passed = passes(item)
        finally:
            os._exit(0 if passed else 1)
    status = os.waitpid(child, 0)[1]
    with suppress(ProcessLookupError):
        os.killpg(child, signal.SIGKILL)
    return status != 0


def report(results: Sequence[dict[str, Any]]) -> None:
    """Say how many mutants of each file have which outcome, and which survive."""
    for each in results:
        if each["outcome"] == "survives":
            say(f"{each['file']}:{each['line']}  {each['change']}")
    for file in FILES:
        say(f"{file}: {dict(Counter(each['outcome'] for each in results if each['file'] == file))}")


def main() -> int:
    parser = ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", default=FILES)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--again", action="store_true", help="run those again that survived")
    arguments = parser.parse_args()
    os.environ.pop(VARIABLE, None)
    built()
    chosen = [mutant for file in arguments.files for mutant in [*mutants(file)][:: arguments.every]]
    known = stored()
    done = {key for key, each in known.items() if not (arguments.again and each["outcome"] == "survives")}
    say(f"{len(chosen)} mutants, {sum(mutant.key in done for mutant in chosen)} of them done")
    paths = [str(ROOT / f"tests/verify/kernel/{name}.py") for name in TESTS]
    # Tests whose time is what they are about.
    slow = "not late_deadline and not long_stays and not which_hints and not idle"
    options = ["-q", "-s", "-p", "no:cacheprovider", "-p", "no:unraisableexception", "-k", slow, *paths]
    STORE.parent.mkdir(exist_ok=True)
    left = [each for each in chosen if each.key not in done]
    with STORE.open("a") as store:
        code = pytest.main(options, plugins=[Tests(left, store)])
    known = stored()
    report([known[mutant.key] for mutant in chosen if mutant.key in known])
    return code


def stored() -> dict[str, dict[str, Any]]:
    """The outcomes so far, the latest of each mutant."""
    lines = STORE.read_text().splitlines() if STORE.exists() else []
    return {each["key"]: each for each in map(json.loads, lines)}


if __name__ == "__main__":
    sys.exit(main())
