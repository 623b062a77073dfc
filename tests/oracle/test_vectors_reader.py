"""The reader of the test vectors."""

import contextlib
import io
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from carp_spec import Refusal
from carproof.testing.vectors import subjects, vectors

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "vectors.md").read_text()


def test_a_case_tells_its_question_and_its_documents() -> None:
    case = next(vectors("plan/start"))
    assert case.request == {"op": "check", "instance": case.instance, "solution": case.input["solution"]}
    assert case.read_instance().robots[0].id == "r1"
    assert case.read_solution().order == ("r1",)


def test_a_case_without_instance_asks_without_one() -> None:
    case = next(vectors("window/free"))
    assert case.request == {"op": "window/free", "occupations": [], "capacity": 1}


def test_a_malformed_instance_is_refused_when_it_is_read() -> None:
    case = next(case for case in vectors("instance/pace") if case.expected == "invalid")
    with pytest.raises(Refusal, match="instance/pace"):
        case.read_instance()


def test_without_a_subject_all_cases_come_in_the_order_of_the_subjects() -> None:
    assert [case.id for case in vectors()] == [case.id for subject in subjects() for case in vectors(subject)]


def test_importing_the_reader_reads_no_file() -> None:
    script = "import pathlib; pathlib.Path.read_bytes = None; from carproof.testing.vectors import subjects, vectors"
    script += "; subjects(); vectors()"
    subprocess.run([sys.executable, "-c", script], check=True)


def test_the_page_shows_a_case_as_it_is() -> None:
    (shown,) = re.findall(r'```text\n("id".*?)```', PAGE, re.DOTALL)
    case = next(case for case in vectors("window/fits") if case.id == "window-fits.a-tick-short")
    reported = json.loads("{" + shown + "}")
    assert reported == {name: json.loads(json.dumps(getattr(case, name))) for name in case.__struct_fields__}


def test_the_example_on_the_page_runs() -> None:
    (example,) = re.findall(r"```python\n(from carproof.testing.vectors.*?)```", PAGE, re.DOTALL)
    with contextlib.redirect_stdout(io.StringIO()) as printed:
        exec(example, {})  # noqa: S102 - the page is ours
    assert "joint-exchange.swap invalid [{'robot': 'r1'" in printed.getvalue()
