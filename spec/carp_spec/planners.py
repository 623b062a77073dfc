"""The planners by name, their options and their decisions."""

from dataclasses import dataclass
from typing import ClassVar, Literal, TypeAlias

from carp_spec.rule import DESIGN, rule

LARGEST_SEED = 2**64 - 1
LARGEST_TABLE = 5_000_000
PathKind: TypeAlias = Literal["shortest", "disjoint"]


@dataclass(frozen=True, slots=True)
class Carp:
    """Prioritized planning: each robot in the order given, against the plans before it. Source: ter Mors 2010."""

    name: ClassVar[str] = "carp"


@dataclass(frozen=True, slots=True)
class Shuffled:
    """The best of `attempts` passes of CARP (the paper's CARP10 and CARP100).

    The first pass is in the order given, each later one in a shuffle of the order before, from the stream of `seed`.
    Fewer unplanned robots are better, then a smaller total cost, then the earlier pass.
    """

    name: ClassVar[str] = "shuffled"
    attempts: int = 10
    seed: int = 0


@dataclass(frozen=True, slots=True)
class LongestFirst:
    """CARP with the longest shortest path first; a tie goes to the earlier robot (the paper's LF)."""

    name: ClassVar[str] = "longest-first"


@dataclass(frozen=True, slots=True)
class Greedy:
    """In each round, the robot whose plan costs least is planned; a tie goes to the earlier robot."""

    name: ClassVar[str] = "greedy"


@dataclass(frozen=True, slots=True)
class Neighbourhood:
    """The paper's Proposed_m: each robot is added together with its m - 1 nearest neighbours, in every order.

    `sample` is the number of orders drawn (`None`: all), `baseline` whether keeping all plans is a candidate (`False`
    is paper mode), `fallback` the attempts of `Shuffled`, with the same seed, without a candidate (`None`: none).
    """

    name: ClassVar[str] = "neighbourhood"
    m: int = 4
    sample: int | None = None
    seed: int = 0
    baseline: bool = True
    fallback: int | None = None


BY_DEFAULT = Neighbourhood()
"""The planner where none is named."""


@dataclass(frozen=True, slots=True)
class FixedPaths:
    """Each robot takes, of its k shortest or at most k disjoint paths, the first on which it arrives earliest.

    Disjoint paths share no resource but start and goal; they are as many as possible, of the least total length on the
    empty graph. Of shortest paths of equal length, those come first whose resources do in the graph. Source: ter Mors'
    comparison, as the paper cites it.
    """

    name: ClassVar[str] = "fixed-paths"
    k: int = 3
    paths: PathKind = "shortest"


@dataclass(frozen=True, slots=True)
class TimeExpanded:
    """Like `Carp`, with A* on a table of occupied ticks in place of windows (the paper's [spatioTempA*])."""

    name: ClassVar[str] = "time-expanded"


Planner: TypeAlias = Carp | Shuffled | LongestFirst | Greedy | Neighbourhood | FixedPaths | TimeExpanded


@rule(
    "limit/ticks",
    "A planner may refuse an instance that its tables cannot hold: the compiled engine ticks and durations beyond "
    f"{2**30} and positions beyond {2**29}, the time-expanded planner more than {LARGEST_TABLE} ticks.",
    DESIGN,
)
def ticks_are_held(ticks: int, most: int) -> bool:
    return ticks <= most
