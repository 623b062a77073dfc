"""The report on stored runs, in HTML and as PDF."""

from pathlib import Path

from carp_experiments.page import RESULTS
from carp_experiments.printed import write_figures, write_printed


def test_the_report_is_whole_and_the_same_each_time(tmp_path: Path) -> None:
    stored = tmp_path / "stored"
    stored.mkdir()
    for path in RESULTS.glob("following*"):
        (stored / path.name).write_bytes(path.read_bytes())
    html, pdf = write_printed(tmp_path / "one", stored)
    again = write_printed(tmp_path / "other", stored)
    assert [path.read_bytes() for path in again] == [html.read_bytes(), pdf.read_bytes()]
    assert pdf.read_bytes().startswith(b"%PDF")
    text = html.read_text(encoding="utf-8")
    assert 'src="figures' not in text
    assert "data:image/svg+xml;base64," in text
    (figure,) = write_figures(tmp_path / "one", stored)
    assert figure.read_bytes().startswith(b"%PDF")
