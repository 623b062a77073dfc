"""The page about the test vectors."""

import json
import re
from pathlib import Path

from carproof.testing.vectors import vectors

PAGE = (Path(__file__).parents[2] / "docs" / "reference" / "vectors.md").read_text()


def test_the_page_shows_a_case_as_it_is() -> None:
    (shown,) = re.findall(r'```text\n("id".*?)```', PAGE, re.DOTALL)
    case = next(case for case in vectors("window/fits") if case.id == "window-fits.a-tick-short")
    reported = json.loads("{" + shown + "}")
    assert reported == {name: json.loads(json.dumps(getattr(case, name))) for name in case.__struct_fields__}
