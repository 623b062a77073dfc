"""The reader of the test vectors."""

import json
import re
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


def test_the_page_shows_a_case_as_it_is() -> None:
    (shown,) = re.findall(r'```text\n("id".*?)```', PAGE, re.DOTALL)
    case = next(case for case in vectors("window/fits") if case.id == "window-fits.a-tick-short")
    reported = json.loads("{" + shown + "}")
    assert reported == {name: json.loads(json.dumps(getattr(case, name))) for name in case.__struct_fields__}
