"""The size of a vehicle, and the rules by which vehicles of that size keep apart: `footprint/...`."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from carp_spec import ResourceId, RobotId, Rule
from carp_spec.model import Resource
from carp_spec.rule import DESIGN, Breach, Found, fault_rule, is_between, rule, violation_rule

MOST_PAIRS = 2_000_000


@dataclass(frozen=True, slots=True)
class Footprint:
    """A vehicle of a length and a width in mm; where it is `round`, a disc of this diameter."""

    length: int
    width: int
    round: bool = False

    def __str__(self) -> str:
        """Print like `900x600mm`, or `450mm`, the radius of a disc."""
        return f"{self.length // 2 if self.round else f'{self.length}x{self.width}'}mm"


@dataclass(frozen=True, slots=True)
class Meeting:
    """Two robots in resources whose shapes overlap, in the ticks [start, end)."""

    robots: tuple[RobotId, RobotId]
    resources: tuple[ResourceId, ResourceId]
    start: int
    end: int | None


@fault_rule(
    "footprint/vehicle",
    "A vehicle has a length and a width of at least 1 mm, in whole mm; both are the diameter of a round one.",
    DESIGN,
)
def vehicle_has_a_size(size: Footprint) -> Iterator[tuple[str, str]]:  # noqa: D103 - its statement stands above
    for name in ("length", "width"):
        if not is_between(value := getattr(size, name), 1):
            yield f"$.footprint.{name}", f"it must be a whole number of at least 1, not {value!r}"
    is_round: object = size.round
    if not isinstance(is_round, bool):
        yield "$.footprint.round", f"it must be true or false, not {is_round!r}"
    elif size.round and size.length != size.width:
        yield "$.footprint", "the length and the width of a round vehicle must be equal"


@fault_rule(
    "footprint/cells",
    "Cells are those of a floor for a footprint; a step of their positions is at least 1 mm long, in whole mm.",
    DESIGN,
)
def cells_have_a_step(cells: int | None, size: Footprint | None) -> Found:  # noqa: D103 - its statement stands above
    if cells is not None and not is_between(cells, 1):
        yield "$.cells", f"a step must be a whole number of at least 1 mm, not {cells!r}"
    elif cells is not None and size is None:
        yield "$.cells", "there must be a footprint, for cells"


@fault_rule("footprint/positions", "For a footprint, each resource has a position, in mm.", DESIGN)
def all_have_positions(resources: Sequence[Resource]) -> Found:  # noqa: D103
    for index, each in enumerate(resources):
        if each.x is None or each.y is None:
            yield f"$.graph.resources[{index}]", f"{each.id!r} must have a position, in mm, for a footprint"


@fault_rule(
    "footprint/lanes",
    "For a footprint, resources that an edge joins are at one place, or one of them is a lane. A lane is joined to two "
    "other places, neither of them a lane, and lies at their middle, rounded down to whole mm. On a floor of cells no "
    "resource is a lane.",
    DESIGN,
)
def lanes_lie_between_points(edges: Sequence[tuple[ResourceId, ResourceId, bool]]) -> Found:
    """Look at the edges, each with whether exactly one of its ends is a lane or both are at one place."""
    for index, (source, target, is_right) in enumerate(edges):
        if not is_right:
            message = (
                f"of {source!r} and {target!r}, one must be a lane at the middle of two points, unless all are cells"
            )
            yield f"$.graph.edges[{index}]", message


@rule(
    "footprint/size",
    f"At most {MOST_PAIRS} pairs of points and lanes of the plans are so near that a footprint must be looked at.",
    DESIGN,
)
def pairs_fit(pairs: int) -> bool:
    """Whether the pairs are few enough."""
    return pairs <= MOST_PAIRS


@violation_rule(
    "footprint/apart",
    "At no tick do the shapes that two vehicles of the size sweep in their resources overlap. On a lane a rectangle "
    "sweeps a longer one. At a point it turns and sweeps a disc, unless all lanes there lie along one line. In a cell "
    "it sweeps what lies between it and half way from the one before and to the one after, and a disc unless these "
    "ways lie along one line. Shapes that only touch do not overlap.",
    DESIGN,
)
def vehicles_keep_apart(meetings: Iterator[Meeting], size: Footprint) -> Iterator[Breach]:
    """Blame the first resource of each meeting."""
    for each in meetings:
        reason = f"{each.robots[1]} in {each.resources[1]}, too near for {size}"
        yield each.robots, each.resources[0], each.start, each.end, reason


FOOTPRINT_RULES: tuple[Rule[..., Any], ...] = (
    vehicle_has_a_size,
    cells_have_a_step,
    all_have_positions,
    lanes_lie_between_points,
    pairs_fit,
    vehicles_keep_apart,
)
