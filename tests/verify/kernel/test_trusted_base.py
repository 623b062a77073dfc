"""The trusted base: the modules that the documentation lists, and the lines of code that it counts."""

import re
from pathlib import Path

import pytest
from docs.trusted_base import CHECK, KERNEL, VERDICTS, module_file
from tests.verify.kernel.mutants import mutants, mutated


def kernel_lines(path: Path) -> list[str]:
    """The lines of a file in Coq or OCaml that hold more than a comment; comments may be nested."""
    code, depth = [], 0
    for part in re.split(r"(\(\*|\*\)|\n)", path.read_text()):
        depth += (part == "(*") - (part == "*)")
        if part == "\n" or (depth == 0 and part != "*)"):
            code.append(part)
    return [line for line in "".join(code).split("\n") if line.strip()]


def source(name: str) -> str:
    return module_file(name).read_text()


@pytest.mark.parametrize("verdict", VERDICTS)
def test_what_a_trusted_module_imports_is_trusted_too(verdict: str) -> None:
    """Each needs what `check` does; a proof directory has one of three claims, which need parts of `proof`."""
    named = {*VERDICTS[verdict][0]}
    of_proofs = {name for modules, _ in VERDICTS.values() if "optimum/proof" in modules for name in modules}
    known = {*VERDICTS[CHECK][0]} | (of_proofs if "optimum/proof" in named else named)
    for name in named:
        imported = re.findall(
            r"^from (?:carp_verify|carp_spec(?=\.documents))\.([\w.]+) import", source(name), re.MULTILINE
        )
        assert {each.replace(".", "/") for each in imported} <= known


@pytest.mark.parametrize("name", sorted({name for modules, _ in VERDICTS.values() for name in modules}))
def test_what_is_trusted_imports_no_search(name: str) -> None:
    assert not any(package in source(name) for package in ("carp_optimum", "carp_optimized", "carp_reference", "pysat"))


def test_the_map_of_the_kernel_counts_the_lines_that_must_be_trusted() -> None:
    text = (KERNEL / "README.md").read_text()
    counts = re.findall(r"\[(\w+\.\w+)\]\(\1\) (\d+) \|", text)
    assert {name for name, _ in counts} == {"Extract.v", "Law.v", "reading.ml", "verdicts.ml", "main.ml"}
    assert {name: len(kernel_lines(KERNEL / name)) for name, _ in counts} == {
        name: int(count) for name, count in counts
    }


def test_each_planted_error_of_the_kernel_has_its_place() -> None:
    planted = mutants()
    assert len({mutated(mutant) for mutant in planted}) == len(planted) > 100


def test_the_map_of_the_kernel_names_every_coq_file() -> None:
    text = (KERNEL / "README.md").read_text()
    assert [
        path.stem for path in KERNEL.glob("*.v") if f"`{path.stem}`" not in text and f"[{path.name}]" not in text
    ] == []
