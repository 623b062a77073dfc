"""The rules of the options of `generate`: `generate/...`."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, fields
from typing import Any, Literal, TypeAlias, get_args

from carp_spec import Refusal, Rule
from carp_spec.planners import LARGEST_SEED
from carp_spec.rule import DESIGN, fault_rule, is_whole, rule

LARGEST = 2**30
MOST_RESOURCES = 250_000
MOST_ROBOTS = 100_000

Distinct: TypeAlias = Literal["both", "starts", "goals", "none"]
Side: TypeAlias = Literal["racks", "stations"]
Orders: TypeAlias = Literal["goals", "pick-and-drop"]

BOUNDS: Mapping[str, tuple[int, int]] = {
    "map": (0, 20),
    "map_seed": (0, LARGEST_SEED),
    "seed": (0, LARGEST_SEED),
    "robots": (0, MOST_ROBOTS),
    "release": (0, LARGEST),
    "service": (0, LARGEST),
}


@dataclass(frozen=True, slots=True)
class Range:
    """The whole numbers from low to high, both included."""

    low: int
    high: int

    def draw(self, stream: Iterator[int]) -> int:
        """Choose one by the next number of the stream; a range of one number uses none."""
        if self.low == self.high:
            return self.low
        return self.low + next(stream) % (self.high - self.low + 1)

    def __str__(self) -> str:
        """Print like the option: `2` or `1..3`."""
        return str(self.low) if self.low == self.high else f"{self.low}..{self.high}"


JUST_ZERO = Range(0, 0)
JUST_ONE = Range(1, 1)


@dataclass(frozen=True, slots=True)
class Traits:
    """Capacities and durations of a map's resources, drawn from its seed."""

    capacity: Range = JUST_ONE
    duration: Range = JUST_ONE


@fault_rule(
    "generate/options",
    f"A seed is between 0 and 2^64 - 1, a map between 0 and 20, robots between 0 and {MOST_ROBOTS}, a release or a "
    "service between 0 and 2^30, any other number between 1 and 2^30; a range does not fall; a word is one of those "
    "that the option names.",
    DESIGN,
)
def options_are_right(options: Any) -> Iterator[tuple[str, str]]:  # noqa: ANN401 - any of the dataclasses of options
    """Yield the faults of a dataclass of options, each with its path."""
    for each in fields(options):
        value = getattr(options, each.name)
        is_range = isinstance(value, Range)
        if is_range == (each.type is Range):
            message = _wrong(each.name, value, get_args(each.type))
        else:
            message = f"it must be {'a whole number' if is_range else 'a Range'}, not {value!r}"
        if message is not None:
            yield f"$.{each.name}", message


def _wrong(name: str, value: object, words: tuple[str, ...]) -> str | None:
    if words:
        is_word = isinstance(value, str) and value in words
        return None if is_word else f"it must be one of {', '.join(words)}, not {value!r}"
    least, most = BOUNDS.get(name, (1, LARGEST))
    ends = [value.low, value.high] if isinstance(value, Range) else [value]
    if not all(is_whole(end) and least <= end <= most for end in ends):
        return f"it must be between {least} and {most}, not {value}"
    if isinstance(value, Range) and value.low > value.high:
        return f"its range must not fall, and is {value}"
    return None


@rule(
    "generate/size",
    f"A map has at most {MOST_RESOURCES} resources, so that it fits into memory.",
    DESIGN,
)
def size_is_bounded(width: int, height: int) -> bool:
    """Whether the area is no more than the limit."""
    return width * height <= MOST_RESOURCES


@rule(
    "generate/ends",
    "There are as many places for robots to start, or to end, as robots that are to have distinct ones.",
    DESIGN,
)
def ends_suffice(places: int, robots: int) -> bool:
    """Whether each robot can have a place of its own."""
    return robots <= places


GENERATE_RULES: tuple[Rule[..., Any], ...] = (options_are_right, size_is_bounded, ends_suffice)


def refuse_wrong_options(**options: tuple[object, type[Any]]) -> None:
    """Raise `Refusal` on the first fault of options, each with its class."""
    for name, (each, kind) in options.items():
        if not isinstance(each, kind):
            message = f"it must be a {kind.__name__}, not {each!r}"
            raise Refusal("option", f"$.{name}", options_are_right.id, message)
        for fault in options_are_right(each):
            raise Refusal("option", fault.path, fault.rule, fault.message)


def refuse_large_maps(width: int, height: int) -> None:
    """Raise `Refusal` where the map would be too large."""
    if not size_is_bounded(width, height):
        message = f"the map must have at most {MOST_RESOURCES} resources, and {width} x {height} are {width * height}"
        raise Refusal("limit", "$.width", size_is_bounded.id, message)
