"""All experiments by name: their sizes, their cases and their reports."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import product
from pkgutil import resolve_name
from typing import Any

from carp_experiments.paper.map_cases import FULL_MAP, SORTING, WAREHOUSE, MapCase
from carp_experiments.report import ExperimentReport, Figure
from carp_experiments.store import Row
from carp_spec import Refusal
from carproof.generate.options import ends_suffice

ALL_MAPS = tuple(range(FULL_MAP + 1))
SOME_MAPS = (0, 5, 10, 15, 20)
PAPERS_MAP = 15
MOST_STREAMED = 100_000


@dataclass(frozen=True, slots=True)
class Profile:
    """The size of an experiment: assignments of start and goal to this many robots, each on all maps."""

    assignments: int
    robots: int
    maps: tuple[int, ...]

    @property
    def options(self) -> str:
        """The options of the command line that ask for it."""
        maps = () if self.maps == ALL_MAPS else (f"--map {map}" for map in self.maps)
        return " ".join([f"--assignments {self.assignments}", f"--robots {self.robots}", *maps])

    def __str__(self) -> str:
        """Print in words."""
        maps = f"map{'s' if len(self.maps) > 1 else ''} {', '.join(map(str, self.maps))}"
        where = f"all {len(ALL_MAPS)} maps" if self.maps == ALL_MAPS else maps
        return f"{self.assignments} assignments of {self.robots} robots on {where}"


@dataclass(frozen=True, slots=True)
class Experiment:
    """An experiment. The case of an assignment and a map is the same in every profile with as many robots.

    `functions` names some without their endings: `_row` makes the row of a case, `_report` a report of rows and the
    number of robots, and `_figures`, if it is there, the figures of a summary. They are loaded when needed, for numba
    is slow to load.
    """

    name: str
    sentence: str
    full: Profile
    quick: Profile
    functions: str
    places: int = 400

    def cases(self, profile: Profile) -> Sequence[MapCase]:
        """The cases, assignment by assignment, so that a run that is stopped has whole assignments."""
        compute = resolve_name(f"carp_experiments.{self.functions}_row")
        places = product(range(profile.assignments), profile.maps)
        return [MapCase(compute, map, assignment, profile.robots) for assignment, map in places]

    def report(self, rows: Iterable[Row], robots: int) -> ExperimentReport:
        """The report of rows."""
        report: ExperimentReport = resolve_name(f"carp_experiments.{self.functions}_report")(rows, robots)
        return report

    @property
    def figures(self) -> Callable[[Any], Sequence[Figure]] | None:
        """What makes the figures of a summary, if it has any."""
        module, _, name = self.functions.partition(":")
        return getattr(resolve_name(f"carp_experiments.{module}"), f"{name}_figures", None)

    def refuse(self, profile: Profile) -> None:
        """Raise `Refusal` where the maps have no place for this many robots."""
        if not ends_suffice(self.places, profile.robots):
            message = f"{profile.robots} robots need as many distinct starts, and the map has {self.places}"
            raise Refusal("option", "$.robots", ends_suffice.id, message)


EXPERIMENTS = (
    Experiment(
        "quality",
        "Experiment 1 of the paper: failures and total cost, over the maps.",
        Profile(500, 100, ALL_MAPS),
        Profile(20, 30, SOME_MAPS),
        "paper.quality:quality",
    ),
    Experiment(
        "time",
        "Experiment 2 of the paper: time to plan when the k-th robot comes.",
        Profile(500, 100, (PAPERS_MAP,)),
        Profile(20, 50, (PAPERS_MAP,)),
        "paper.adding_time:time",
    ),
    Experiment(
        "reuse",
        "Queries asked to add a robot, avoided, and why.",
        Profile(500, 100, (PAPERS_MAP,)),
        Profile(20, 50, (PAPERS_MAP,)),
        "paper.reuse_counts:reuse",
    ),
    Experiment(
        "gap",
        "Small maps, 8 x 8, against the optimum.",
        Profile(100, 10, ALL_MAPS),
        Profile(20, 6, SOME_MAPS),
        "paper.small_gaps:gap",
        places=8 * 8,
    ),
    Experiment(
        "related",
        "Fixed paths, k shortest and k disjoint, and greedy best-first, against CARP.",
        Profile(100, 100, ALL_MAPS),
        Profile(5, 10, (10, 20)),
        "paper.related_work:related",
    ),
    Experiment(
        "polish",
        "The distance of the planner, and of polished plans, from a proved lower bound.",
        Profile(100, 100, ALL_MAPS),
        Profile(8, 20, (10, 20)),
        "paper.polishing:polish",
    ),
    Experiment(
        "conventions",
        "What the paper leaves open: under which conventions its numbers come out.",
        Profile(100, 100, (10, FULL_MAP)),
        Profile(2, 30, (10, FULL_MAP)),
        "paper.conventions:conventions",
    ),
    Experiment(
        "nearest",
        "The conventions that bring the paper's numbers out best, over more assignments.",
        Profile(100, 100, (10, FULL_MAP)),
        Profile(2, 30, (10, FULL_MAP)),
        "paper.conventions:nearest",
    ),
    Experiment(
        "remaining",
        "Conventions that the screening left out: divisors of the distance, and plans kept where CARP fails.",
        Profile(100, 100, (10, FULL_MAP)),
        Profile(2, 30, (10, FULL_MAP)),
        "paper.conventions:remaining",
    ),
    Experiment(
        "neighbours",
        "Where the neighbourhood planner helps: kinds of instances, M, and polish for the same time.",
        Profile(20, 100, (5, 10, 15, FULL_MAP)),
        Profile(2, 20, (10, FULL_MAP)),
        "beyond.neighbours:neighbours",
    ),
    Experiment(
        "left-out",
        "Robots that carproof plan leaves out, before and after its repair.",
        Profile(100, 100, ALL_MAPS),
        Profile(5, 60, SOME_MAPS),
        "beyond.left_out:left_out",
    ),
    Experiment(
        "execution",
        "Late robots on the clock, in order and switching: lateness, arrivals and collisions.",
        Profile(4, 40, (10, 15, FULL_MAP, WAREHOUSE)),
        Profile(2, 10, (10, 20)),
        "beyond.delayed:execution",
    ),
    Experiment(
        "following",
        "The price of plans without rotations: following forbidden, and rotations removed.",
        Profile(20, 60, (10, 15, FULL_MAP, WAREHOUSE)),
        Profile(4, 20, (10, FULL_MAP)),
        "beyond.following:following",
    ),
    Experiment(
        "people",
        "People with priority among robots: how early they arrive, and the cost for the robots.",
        Profile(20, 100, (FULL_MAP,)),
        Profile(5, 30, (FULL_MAP,)),
        "beyond.people:people",
    ),
    Experiment(
        "stream",
        "Robots that come at random, at several rates: throughput up to saturation, and waiting.",
        Profile(4, 500, (10, FULL_MAP, WAREHOUSE)),
        Profile(2, 200, (10, FULL_MAP)),
        "beyond.streams:stream",
        places=MOST_STREAMED,
    ),
    Experiment(
        "lifelong",
        "Pick-and-drop orders that come at random: throughput, time in the system and time an order.",
        Profile(4, 200, (10, FULL_MAP, WAREHOUSE, SORTING)),
        Profile(2, 30, (10, FULL_MAP)),
        "beyond.lifelong:lifelong",
        places=MOST_STREAMED,
    ),
)
