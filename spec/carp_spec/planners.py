"""The planners by name, their options and their decisions."""

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import ClassVar, Literal, TypeAlias, get_args

from carp_spec.rule import DESIGN, Found, fault_rule, is_whole, rule

LARGEST_SEED = 2**64 - 1
LARGEST_TABLE = 5_000_000
LARGEST_SAMPLE = 1_000_000
PathKind: TypeAlias = Literal["shortest", "disjoint"]


@dataclass(frozen=True, slots=True)
class Carp:
    """Prioritized planning: each robot in the order given, against the plans before it. Source: ter Mors 2010."""

    name: ClassVar = "carp"


@dataclass(frozen=True, slots=True)
class Shuffled:
    """The best of `attempts` passes of CARP (the paper's CARP10 and CARP100).

    The first pass is in the order given, each later one in a Fisher-Yates shuffle of the order before, from the
    SplitMix64 stream of `seed`. Fewer unplanned robots are better, then a smaller total cost, then the earlier pass.
    """

    name: ClassVar = "shuffled"
    attempts: int = 10
    seed: int = 0


@dataclass(frozen=True, slots=True)
class LongestFirst:
    """CARP with the longest shortest path first; a tie goes to the earlier robot (the paper's LF)."""

    name: ClassVar = "longest-first"


@dataclass(frozen=True, slots=True)
class Greedy:
    """In each round, the robot whose plan costs least is planned; a tie goes to the earlier robot."""

    name: ClassVar = "greedy"


@dataclass(frozen=True, slots=True)
class Neighbourhood:
    """The paper's Proposed_m: each robot is added together with its m - 1 nearest neighbours, in every order.

    `sample` is the number of orders drawn (`None`: all), `baseline` whether keeping all plans is a candidate (`False`
    is paper mode), `fallback` the attempts of `Shuffled`, with the same seed, without a candidate (`None`: none).
    """

    name: ClassVar = "neighbourhood"
    m: int = 4
    sample: int | None = None
    seed: int = 0
    baseline: bool = True
    fallback: int | None = None


BY_DEFAULT = Neighbourhood()
"""The planner that is used where none is named."""


@dataclass(frozen=True, slots=True)
class FixedPaths:
    """Each robot takes, of its k shortest or at most k disjoint paths, the first on which it arrives earliest.

    The paths are those of the empty graph. Disjoint paths share no resource but start and goal; they are as many as
    possible, of the least total length. Source: ter Mors' comparison, as the paper cites it.
    """

    name: ClassVar = "fixed-paths"
    k: int = 3
    paths: PathKind = "shortest"


@dataclass(frozen=True, slots=True)
class TimeExpanded:
    """Like `Carp`, with A* on a table of occupied ticks in place of windows (the paper's [spatioTempA*])."""

    name: ClassVar = "time-expanded"


Planner: TypeAlias = Carp | Shuffled | LongestFirst | Greedy | Neighbourhood | FixedPaths | TimeExpanded
PLANNERS: Mapping[str, type[Planner]] = {kind.name: kind for kind in get_args(Planner)}


def is_between(value: object, least: int, most: int | None = None) -> bool:
    """Whether the value is a whole number between the two, both included."""
    return is_whole(value) and value >= least and (most is None or value <= most)


@fault_rule(
    "planner/options",
    f"Counts (m, k, attempts, fallback, sample) are whole numbers of at least 1, a sample at most {LARGEST_SAMPLE}; "
    "a seed is between 0 and 2^64 - 1; baseline is true or false; paths is shortest or disjoint; sample and fallback "
    "may be null.",
    DESIGN,
)
def options_are_right(planner: Planner) -> Found:
    limits = {"seed": (0, LARGEST_SEED), "sample": (1, LARGEST_SAMPLE)}
    for name, value in asdict(planner).items():
        least, most = limits.get(name, (1, None))
        right = f"a whole number of at least {least}" if most is None else f"a whole number between {least} and {most}"
        is_right = is_between(value, least, most) or (value is None and name in ("sample", "fallback"))
        if name == "baseline":
            right, is_right = "true or false", isinstance(value, bool)
        elif name == "paths":
            right, is_right = '"shortest" or "disjoint"', value in get_args(PathKind)
        if not is_right:
            yield f"$.{name}", f"the {name} must be {right}, not {value!r}"


@rule(
    "limit/ticks",
    "A planner that keeps ticks in tables may refuse an instance that its tables cannot hold: the compiled engine "
    f"ticks, durations and positions beyond {2**30}, the time-expanded planner more than {LARGEST_TABLE} ticks.",
    DESIGN,
)
def ticks_are_held(ticks: int, most: int) -> bool:
    return ticks <= most
