"""Colours: a palette for light and for dark pages, how each kind of shape is painted, and the looks of robots.

Shapes name the palette's colours as CSS variables, `var(--cell)`, which a page defines twice. A still picture has the
light colours in their place (`fixed`), so that it needs no browser.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from xml.etree.ElementTree import Element

PALETTE = {
    "paper": ("#ffffff", "#14171c"),
    "panel": ("#f4f5f7", "#1d2128"),
    "ink": ("#1b1f24", "#eceff3"),
    "faint": ("#5d6672", "#a3adba"),
    "line": ("#c9ced6", "#3b434f"),
    "cell": ("#e3e7ed", "#2c323b"),
    "roomy": ("#cfd8e6", "#3a4657"),
    "wall": ("#7d8794", "#59636f"),
    "floor": ("#f4f6f8", "#262b33"),
    "joint": ("#e9ecf0", "#2e343d"),
    "way": ("#6b7480", "#98a3b1"),
    "window": ("#dcebdc", "#223a2c"),
    "wrong": ("#c1121f", "#ff6b6b"),
    "accent": ("#0b57d0", "#8ab4f8"),
}
"""The colours, each for a light page and for a dark one."""
LIGHT = {name: light for name, (light, _) in PALETTE.items()}
HUES = ("#0072b2", "#e69f00", "#009e73", "#f0e442", "#cc79a7", "#56b4e9")
"""Six colours that colour-blind people tell apart (Okabe and Ito 2008); red is left to what is wrong."""
BLACK, WHITE = "#000000", "#ffffff"
DARKER, PALER = 55, 75
"""How much black makes the dark shade of a hue, and how much white the pale one, in parts of a hundred."""


@dataclass(frozen=True, slots=True)
class Look:
    """How a robot is painted: the hue of its start and goal, its fill, its edge and that edge's width, its text."""

    hue: str
    fill: str
    edge: str
    width: int
    text: str


def mixed(colour: str, other: str, parts: int) -> str:
    """The colour with parts of a hundred of another."""
    pairs = ((int(colour[at : at + 2], 16), int(other[at : at + 2], 16)) for at in (1, 3, 5))
    return "#" + "".join(f"{(one * (100 - parts) + two * parts) // 100:02x}" for one, two in pairs)


def looks() -> tuple[Look, ...]:
    """Six hues in three kinds, which differ in grey too: full, pale with a strong edge, dark with a bright edge."""
    dark = [mixed(hue, BLACK, DARKER) for hue in HUES]
    full = [Look(hue, hue, shade, 1, WHITE if hue == HUES[0] else BLACK) for hue, shade in zip(HUES, dark, strict=True)]
    pale = [Look(hue, mixed(hue, WHITE, PALER), shade, 2, BLACK) for hue, shade in zip(HUES, dark, strict=True)]
    deep = [Look(hue, shade, hue, 2, WHITE) for hue, shade in zip(HUES, dark, strict=True)]
    return (*full, *pale, *deep)


LOOKS = looks()


def of(colour: str) -> str:
    """A colour of the palette."""
    return f"var(--{colour})"


HATCH = "url(#hatch)"
FAINT = {"fill": of("faint")}
AT_END = {"text-anchor": "end"}
IN_MIDDLE = {"text-anchor": "middle"}
HALO = {"stroke": of("paper"), "stroke-width": "3", "paint-order": "stroke"}
FRAME = {"fill": HATCH, "stroke": of("wrong"), "stroke-width": "2"}
PAINT: Mapping[str, Mapping[str, str]] = {
    "paper": {"fill": of("paper")},
    "cell": {"fill": of("cell")},
    "cell roomy": {"fill": of("roomy"), "stroke": of("way"), "stroke-width": "1"},
    "square": {"fill": of("floor")},
    "wall": {"fill": of("wall")},
    "joint": {"fill": of("joint")},
    "edge": {"fill": "none", "stroke": of("cell"), "stroke-width": "10"},
    "edge thin": {"fill": "none", "stroke": of("line"), "stroke-width": "3"},
    "one-way": {"fill": "none", "stroke": of("way"), "stroke-width": "2"},
    "one-way head": {"fill": of("way")},
    "lane": {"fill": "none", "stroke": of("cell"), "stroke-width": "14", "stroke-linecap": "round"},
    "lane roomy": {"fill": "none", "stroke": of("roomy"), "stroke-width": "14", "stroke-linecap": "round"},
    "lane head": {"fill": of("way"), "opacity": "0.6"},
    "lane-traits": {**FAINT, **IN_MIDDLE},
    "group": {"fill": of("accent"), "fill-opacity": "0.06", "stroke": of("accent"), "stroke-dasharray": "5 3"},
    "group-name": {"fill": of("accent"), **IN_MIDDLE},
    "point-name": {"fill": of("ink"), **IN_MIDDLE, **HALO},
    "stop": {"fill": "none", "stroke-width": "1.5"},
    "service": {"fill": of("accent"), "stroke": "none"},
    "serving": {"fill": "none", "stroke": of("accent"), "stroke-width": "2"},
    "name": FAINT,
    "traits": {**FAINT, **AT_END},
    "goal": {"fill": "none", "stroke-width": "1.5"},
    "start": {"fill": "none", "stroke-width": "1.5"},
    "goal-of": {**FAINT, **IN_MIDDLE},
    "short": {**IN_MIDDLE, "stroke": "none", "font-weight": "600"},
    "violation": FRAME,
    "hatch": {"fill": of("wrong"), "opacity": "0.45"},
    "line": {"fill": "none", "stroke": of("line")},
    "tick": {**FAINT, **IN_MIDDLE},
    "unit": {**FAINT, **AT_END},
    "row-name": {**FAINT, **AT_END},
    "window": {"fill": of("window")},
    "waits": {"fill": of("way"), "stroke": of("way")},
    "cycle": {"fill": of("wrong"), "stroke": of("wrong"), "stroke-width": "2"},
    "arrow": {"fill": "none"},
    "head": {"stroke": "none"},
    "legend-text": FAINT,
}
"""The attributes of each kind of shape or group that has any."""


def variables() -> str:
    """The palette as a style sheet: the light colours, and the dark ones where a person prefers them."""
    light, dark = ("".join(f"--{name}:{pair[at]};" for name, pair in PALETTE.items()) for at in (0, 1))
    return f":root{{color-scheme:light dark;{light}}}\n@media (prefers-color-scheme:dark){{:root{{{dark}}}}}\n"


def fixed(picture: Element) -> None:
    """Put the light colours in the place of the variables."""
    values = {of(name): value for name, value in LIGHT.items()}
    for element in picture.iter():
        for name, value in element.attrib.items():
            if value in values:
                element.set(name, values[value])
