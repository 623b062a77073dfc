"""Builds the planners in other languages, once for each state of their sources."""

import subprocess
from hashlib import sha256
from pathlib import Path

import pytest
from tests.programs import require_programs

HERE = Path(__file__).parent
BUILT = HERE.parent.parent / ".venv" / "foreign"
COMPILERS = {
    "cpp": ("g++", "-std=c++17", "-O2", "-Wall", "-Wextra", "-Werror", "-o", "{program}", "main.cpp"),
    "go": ("go", "build", "-o", "{program}", "."),
}


def built(language: str) -> Path:
    """The program, built if it is not there; skips the test without a compiler."""
    command = COMPILERS[language]
    require_programs(command[0])
    sources = sorted(path for path in (HERE / language).iterdir() if path.is_file())
    digest = sha256(b"\0".join([*map(str.encode, command), *(path.read_bytes() for path in sources)])).hexdigest()
    program = BUILT / f"{language}-{digest[:16]}"
    if not program.exists():
        BUILT.mkdir(parents=True, exist_ok=True)
        part = program.with_suffix(".part")
        filled = [word.format(program=part) for word in command]
        done = subprocess.run(filled, cwd=HERE / language, capture_output=True, text=True)  # noqa: PLW1510 - reported below
        if done.returncode != 0:
            pytest.fail(f"{language} does not build: {done.stderr}", pytrace=False)
        part.replace(program)
    return program


if __name__ == "__main__":
    for language in COMPILERS:
        link = BUILT / language
        link.unlink(missing_ok=True)
        link.symlink_to(built(language).name)
