"""The stored results as one report to print: HTML with its figures inside, and PDF."""

import platform
import re
from base64 import b64encode
from collections.abc import Sequence
from datetime import UTC, datetime
from importlib.metadata import version
from os import cpu_count
from pathlib import Path
from tempfile import TemporaryDirectory

from carp_experiments.page import results
from carp_experiments.redrawing import draw_figures
from carproof.command_line.files import write_whole

TITLE = "Context-aware route planning for automated warehouses: the experiments again"
IMAGE = re.compile(r'src="figures/([a-z-]+)\.svg"')
STYLE = """\
body { font: 15px/1.5 Georgia, serif; max-width: 62em; margin: 3em auto; padding: 0 1em; color: #111; background: #fff }
table { border-collapse: collapse; font: 12px/1.4 Arial, sans-serif; margin: 1em 0 }
th, td { border-bottom: 1px solid #bbb; padding: 0.25em 0.6em; text-align: left; vertical-align: top }
svg, img { display: block; width: 36em; max-width: 100%; height: auto; margin: 1.5em 0 }
"""
WIDTHS = {"the paper says": 20, "as published": 16, "with the baseline": 14, "we find": 50}
"""The parts of the width of a page that the columns of the claims take."""
WIDEST, HIGHEST = 480, 500
"""Points of a page that a figure may take."""
ABOUT = """\
The experiments of Hvězda, Rybecký, Kulich and Přeučil (ITSC 2018) with the planners of carproof {version}. Each
section has the command of its run, its size, its processor time, and the digest of its rows, which depends neither on
the machine nor on the number of workers. Intervals are those of 95 %. This report was made on {machine}.

100 robots, with starts and goals drawn at random, are planned on 21 maps of 20 x 20 cells, from a spanning tree (map 0)
to the full grid (map 20). `CARP` plans one robot after the other by context-aware route planning; `CARP10` and
`CARP100` keep the best of as many orders drawn at random; `LF` begins with the longest way. `Proposed_M` is the paper's
Algorithm 1: it adds a robot by planning it again with M - 1 robots near it, in all orders, or in 150 drawn for M = 10.
`+ baseline` has all plans as they are as one more candidate; `+ CARP100` is the fallback where no order works. The cost
is the sum of ticks from release to goal. An assignment fails if a robot has no plan.
"""


def write_printed(folder: Path, stored: Path) -> tuple[Path, Path]:
    """Write `report.html` and `report.pdf` about the runs stored in a folder; returns their paths.

    Raises `Refusal` if a file cannot be written, and `OSError` if a run cannot be read.
    """
    about = ABOUT.format(version=version("carproof"), machine=machine())
    body = html_of(f"# {TITLE}\n\n{about}\n{results(stored)}")
    folder.mkdir(parents=True, exist_ok=True)
    html, pdf = folder / "report.html", folder / "report.pdf"
    write_whole(html, page_of(body, stored).encode())
    write_whole(pdf, pdf_of(body, stored))
    return html, pdf


def write_figures(folder: Path, stored: Path) -> Sequence[Path]:
    """Write each figure of the runs stored in a folder as a PDF, for a paper to print; returns their paths."""
    return [*draw_figures(stored, folder, "pdf").values()]


def machine() -> str:
    """The machine, in words."""
    return f"{platform.machine()} with {cpu_count()} cores, {platform.system()}, Python {platform.python_version()}"


def html_of(text: str) -> str:
    """Markdown as HTML."""
    from markdown import markdown  # noqa: PLC0415 - only the report needs it

    return markdown(text, extensions=["tables"])


def page_of(body: str, stored: Path) -> str:
    """A whole page, with the figures inside it."""

    def inside(image: re.Match[str]) -> str:
        data = b64encode((stored / f"{image[1]}.svg").read_bytes()).decode()
        return f'src="data:image/svg+xml;base64,{data}"'

    head = f'<meta charset="utf-8"><title>{TITLE}</title><style>{STYLE}</style>'
    return f"<!doctype html><html lang=en><head>{head}</head><body>{IMAGE.sub(inside, body)}</body></html>\n"


def pdf_of(body: str, stored: Path) -> bytes:
    """The same as PDF, the figures drawn as pixels, 300 to the inch of a page."""
    from fpdf import FPDF, FontFace  # noqa: PLC0415 - only the report needs it
    from matplotlib import get_data_path  # noqa: PLC0415 - has fonts

    pdf = FPDF(orientation="landscape", format="a4")
    for style, file in {"": "DejaVuSans", "B": "DejaVuSans-Bold", "I": "DejaVuSans-Oblique"}.items():
        pdf.add_font("DejaVu", style, Path(get_data_path()) / "fonts" / "ttf" / f"{file}.ttf")
    pdf.add_font("DejaVu Mono", "", Path(get_data_path()) / "fonts" / "ttf" / "DejaVuSansMono.ttf")
    pdf.set_font("DejaVu", size=8)
    pdf.set_title(TITLE)
    pdf.set_creation_date(datetime(2000, 1, 1, tzinfo=UTC))  # the same bytes for the same runs
    pdf.add_page()
    with TemporaryDirectory() as place:
        drawn = draw_figures(stored, Path(place), "png")
        printed = IMAGE.sub(lambda image: f'src="{drawn[image[1]]}" width="{width_of(drawn[image[1]])}"', body)
        for cell in ("td", "th"):
            printed = printed.replace(f'<{cell} style="text-align: right;">', f'<{cell} align="right">')
            printed = printed.replace(f"<{cell}>", f'<{cell} align="left">')
        printed = printed.replace("<p><img", "<br><br><p><img")  # a figure is not glued to a table
        for heading, width in WIDTHS.items():
            printed = printed.replace(f">{heading}</th>", f' width="{width}%">{heading}</th>')
        faces = {"code": FontFace(family="DejaVu Mono", size_pt=7)}
        pdf.write_html(printed, font_family="DejaVu", tag_styles=faces, table_line_separators=True)
        return bytes(pdf.output())


def width_of(picture: Path) -> int:
    """The points that a picture is wide in print, so that it ends within a page; its size is in the file's head."""
    wide, high = (int.from_bytes(picture.read_bytes()[at : at + 4]) for at in (16, 20))
    return min(WIDEST, HIGHEST * wide // high)
