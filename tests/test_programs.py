"""A test without its system program is skipped with the Debian package, or fails where all programs are required."""

import pytest
from tests.programs import require_programs

MESSAGE = r"^chromium and go not found; on Debian: apt install chromium golang-go$"


@pytest.fixture(autouse=True)
def _no_programs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")


def test_a_missing_program_skips_and_names_its_debian_package(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CARPROOF_REQUIRE_ALL", raising=False)
    with pytest.raises(pytest.skip.Exception, match=MESSAGE):
        require_programs("chromium", "go")


def test_a_missing_program_fails_where_all_are_required(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CARPROOF_REQUIRE_ALL", "1")
    with pytest.raises(pytest.fail.Exception, match=MESSAGE):
        require_programs("chromium", "go")


def test_a_program_that_is_there_is_no_reason_to_skip(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.undo()
    require_programs("sh")
