"""Plant the errors of `verify/kernel/mutants.txt` one after the other: each must break a proof.

Run after `make kernel`, as `make kernel-mutants`. A mutant is compiled in a folder of its own, with the files that
depend on it, until one fails.
"""

import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import cpu_count
from pathlib import Path
from shutil import copy
from tempfile import TemporaryDirectory

ROOT = Path(__file__).parents[3]
SOURCES = ROOT / "verify/kernel"
BUILT = ROOT / "build/kernel"


@dataclass(frozen=True, slots=True)
class Mutant:
    """A piece of a file's text, and what is put in its place."""

    file: str
    old: str
    new: str

    def __str__(self) -> str:
        return f"{self.file}: {' '.join(self.new.split())}"


def mutants() -> list[Mutant]:
    blocks = (SOURCES / "mutants.txt").read_text().strip().split("\n\n")[1:]
    form = re.compile(r"(\w+\.v)\n- (.*)\n\+ (.*)", re.DOTALL)
    matches = [(block, form.fullmatch(block)) for block in blocks]
    for block, match in matches:
        if match is None:
            raise ValueError(f"a mutant must be a file, a piece of text and another, and is {block!r}")
    return [Mutant(*match.groups()) for _, match in matches if match]


def dependants(file: str) -> list[str]:
    """The file and those that depend on it, in the order of the Makefile; extraction proves nothing."""
    needs = {
        Path(target).stem: {Path(each).stem for each in others.split()}
        for target, others in (line.split(":") for line in (BUILT / "depends").read_text().splitlines())
    }
    order = re.findall(r"(\w+)\.v\b", (SOURCES / "Makefile").read_text().partition("DRIVER")[0])
    changed = {Path(file).stem}
    for module in order:
        if needs[module] & changed:
            changed.add(module)
    return [f"{module}.v" for module in order if module in changed and module != "Extract"]


def mutated(mutant: Mutant) -> str:
    """The file's text with the error in it."""
    text = (SOURCES / mutant.file).read_text()
    if text.count(mutant.old) != 1:
        raise ValueError(f"{mutant}: its text must be in the file once, and is {text.count(mutant.old)} times")
    return text.replace(mutant.old, mutant.new)


def is_in_proof(text: str, line: int) -> bool:
    """Whether the line is in a proof, and not in a definition, which the error has made senseless."""
    before = "\n".join(text.splitlines()[:line])
    definitions = [match.start() for match in re.finditer(r"^ *(Definition|Fixpoint|Record)\b", before, re.MULTILINE)]
    return before.rfind("Proof.") > max(definitions, default=0)


def broken_proof(mutant: Mutant) -> str | None:
    """Where the mutant breaks a proof; `None` if it breaks none."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        for built in BUILT.glob("*.vo"):
            copy(built, folder)
        for file in dependants(mutant.file):
            text = mutated(mutant) if file == mutant.file else (SOURCES / file).read_text()
            (folder / file).write_text(text)
            command = ["coqc", "-q", "-Q", ".", "Carproof", "-no-glob", file]
            compiled = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
            where = re.search(r"line (\d+)", compiled.stderr)
            if compiled.returncode != 0 and where is not None:
                line = int(where[1])
                return (
                    f"{file}, line {line}: {text.splitlines()[line - 1].strip()}" if is_in_proof(text, line) else None
                )
    return None


def main() -> int:
    planted = mutants()
    for mutant in planted:
        mutated(mutant)
    survivors = []
    with ThreadPoolExecutor(cpu_count()) as workers:
        for mutant, where in zip(planted, workers.map(broken_proof, planted), strict=True):
            sys.stdout.write(f"{mutant}\n    {where or 'breaks no proof'}\n")
            if where is None:
                survivors.append(mutant)
    sys.stdout.write(f"{len(planted)} errors planted, {len(survivors)} break no proof\n")
    sys.stdout.writelines(f"{mutant}\n" for mutant in survivors)
    return 1 if survivors or not planted else 0


if __name__ == "__main__":
    sys.exit(main())
