"""How an instance is made of a layout: the tick, the speed and the size of vehicles, the robots."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction

from carp_spec import AfterGoal, Refusal
from carp_spec.rule import DESIGN
from carp_spec.shapes import require_shape
from carp_verify.footprint.rules import Footprint, vehicle_has_a_size
from carproof.input_rules import Code

MILLIMETRES = {"mm": Fraction(1), "cm": Fraction(10), "m": Fraction(1000)}
SECONDS = {"ms": Fraction(1, 1000), "s": Fraction(1), "min": Fraction(60)}
_QUANTITY = re.compile(r"(\d{1,9}(?:\.\d{1,9})?)([a-z/]+)")
_SIZE = re.compile(r"(\d{1,6})(?:x(\d{1,6}))?mm")
RIGHT_SETTINGS = Code(
    "layout/settings",
    "A time is like 0.5s or 100ms, a length like 1m, a speed like 1.2m/s, a footprint 900x600mm or the radius of a "
    "disc, like 450mm; all are above 0. Requests are CSV with the columns robot, start, goal and perhaps release; "
    "starts and goals are points of the layout.",
    DESIGN,
)


@dataclass(frozen=True, slots=True)
class Settings:
    """How an instance is made: the tick in seconds, the speed of vehicles in mm/s, and the robots.

    Without `robots` and `requests`, they are the vehicles of the file. Goals that the file does not give are drawn.
    Refusals of requests name their `requests_file`. `turning` is the time of a quarter turn in seconds; without it
    vehicles turn at once. Without a footprint vehicles may use all points and lanes together that the file does not
    forbid.
    """

    tick: Fraction = Fraction(1)
    speed: Fraction | None = None
    robots: int | None = None
    seed: int = 0
    requests: bytes | None = None
    after_goal: AfterGoal = "park"
    footprint: Footprint | None = None
    turning: Fraction | None = None
    requests_file: str = "requests"


def require_settings(settings: Settings) -> None:
    """Raise `Refusal` for values of other types, times and speeds that are not above 0, and a wrong footprint."""
    require_shape(settings, Settings)
    for name in ("tick", "speed", "turning"):
        value = getattr(settings, name)
        if value is not None and value <= 0:
            raise Refusal("option", f"$.{name}", RIGHT_SETTINGS.id, f"it must be above 0, and is {value}")
    for fault in () if settings.footprint is None else vehicle_has_a_size(settings.footprint):
        raise Refusal("option", fault.path, fault.rule, fault.message)


def seconds(text: str, name: str = "tick") -> Fraction:
    """A time such as `0.5s`, in seconds."""
    return _quantity(name, text, SECONDS)


def millimetres(text: str, name: str) -> Fraction:
    """A length such as `1m`, in mm."""
    return _quantity(name, text, MILLIMETRES)


def speed(text: str) -> Fraction:
    """A speed such as `1.2m/s`, in mm/s."""
    return _quantity("speed", text, {f"{unit}/s": value for unit, value in MILLIMETRES.items()})


def _quantity(name: str, text: str, units: Mapping[str, Fraction]) -> Fraction:
    found = _QUANTITY.fullmatch(text.replace(" ", ""))
    value = Fraction(0) if found is None or found[2] not in units else Fraction(found[1]) * units[found[2]]
    if value <= 0:
        message = f"it must be a number above 0 with one of the units {', '.join(units)}, not {text!r}"
        raise Refusal("option", f"$.{name}", RIGHT_SETTINGS.id, message)
    return value


def footprint(text: str) -> Footprint:
    """Read `900x600mm`, a rectangle, or `450mm`, the radius of a disc."""
    found = _SIZE.fullmatch(text.replace(" ", ""))
    sizes = [int(each) for each in found.groups() if each is not None] if found else [0]
    if not all(sizes):
        message = f"it must be a length and a width like 900x600mm, or a radius like 450mm, above 0, not {text!r}"
        raise Refusal("option", "$.footprint", RIGHT_SETTINGS.id, message)
    if len(sizes) == 1:
        return Footprint(2 * sizes[0], 2 * sizes[0], round=True)
    return Footprint(sizes[0], sizes[1])


def step_of_cells(text: str) -> int:
    """The length of a step of the positions of cells, such as `1m`, in mm."""
    step = millimetres(text, "cells")
    if step.denominator > 1:
        raise Refusal("option", "$.cells", RIGHT_SETTINGS.id, f"it must be in whole mm, not {text!r}")
    return int(step)
