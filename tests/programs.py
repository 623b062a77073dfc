"""The system programs that some tests need. Where one is missing a test is skipped, or fails if all are required."""

import os
import shutil

import pytest

DEBIAN_PACKAGES = {
    "chromium": "chromium",
    "chromedriver": "chromium-driver",
    "g++": "g++",
    "go": "golang-go",
    "coqc": "coq",
    "ocamlfind": "ocaml-findlib",
    "bash": "bash",
    "rsvg-convert": "librsvg2-bin",
}


def require_programs(*names: str) -> None:
    """Skip the test if a program is missing; fail it instead where CARPROOF_REQUIRE_ALL is 1."""
    missing = [name for name in names if shutil.which(name) is None]
    if not missing:
        return
    packages = " ".join(DEBIAN_PACKAGES[name] for name in missing)
    message = f"{' and '.join(missing)} not found; on Debian: apt install {packages}"
    if os.environ.get("CARPROOF_REQUIRE_ALL") == "1":
        pytest.fail(message, pytrace=False)
    pytest.skip(message)
