"""All experiments by name: their sizes, their cases and their reports."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product

from carp_experiments.beyond.delayed import execution_report, execution_row
from carp_experiments.beyond.following import following_report, following_row
from carp_experiments.beyond.left_out import left_out_report, left_out_row
from carp_experiments.beyond.lifelong import lifelong_report, lifelong_row
from carp_experiments.beyond.neighbours import neighbours_report, neighbours_row
from carp_experiments.beyond.people import people_report, people_row
from carp_experiments.beyond.streams import stream_report, stream_row
from carp_experiments.paper.adding_time import PAPERS_MAP, time_report, time_row
from carp_experiments.paper.conventions import CONVENTIONS, NEAREST, remaining_row, row_under
from carp_experiments.paper.conventions_report import conventions_report
from carp_experiments.paper.map_cases import FULL_MAP, SORTING, WAREHOUSE, MapCase
from carp_experiments.paper.polishing import polish_report, polish_row
from carp_experiments.paper.quality import quality_row
from carp_experiments.paper.quality_report import quality_report
from carp_experiments.paper.related_work import related_report, related_row
from carp_experiments.paper.reuse_counts import reuse_report, reuse_row
from carp_experiments.paper.small_gaps import SIDE, gap_report, gap_row
from carp_experiments.report import ExperimentReport
from carp_experiments.store import Row
from carp_spec import Refusal

ALL_MAPS = tuple(range(FULL_MAP + 1))
SOME_MAPS = (0, 5, 10, 15, 20)
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
    """An experiment. The case of an assignment and a map is the same in every profile with as many robots."""

    name: str
    sentence: str
    full: Profile
    quick: Profile
    compute: Callable[[MapCase], Row]
    report: Callable[[Iterable[Row], int], ExperimentReport]
    places: int = 400

    def cases(self, profile: Profile) -> Sequence[MapCase]:
        """The cases, assignment by assignment, so that a run that is stopped has whole assignments."""
        places = product(range(profile.assignments), profile.maps)
        return [MapCase(self.compute, map, assignment, profile.robots) for assignment, map in places]

    def refuse(self, profile: Profile) -> None:
        """Raise `Refusal` where the maps have no place for this many robots."""
        from carproof.generate.options import ends_suffice  # noqa: PLC0415 - imports what imports this

        if not ends_suffice(self.places, profile.robots):
            message = f"{profile.robots} robots need as many distinct starts, and the map has {self.places}"
            raise Refusal("option", "$.robots", ends_suffice.id, message)


EXPERIMENTS = (
    Experiment(
        "quality",
        "Experiment 1 of the paper: failures and total cost, over the maps.",
        Profile(500, 100, ALL_MAPS),
        Profile(20, 30, SOME_MAPS),
        quality_row,
        quality_report,
    ),
    Experiment(
        "time",
        "Experiment 2 of the paper: time to plan when the k-th robot comes.",
        Profile(500, 100, (PAPERS_MAP,)),
        Profile(20, 50, (PAPERS_MAP,)),
        time_row,
        lambda rows, _: time_report(rows),
    ),
    Experiment(
        "reuse",
        "Queries asked to add a robot, avoided, and why.",
        Profile(500, 100, (PAPERS_MAP,)),
        Profile(20, 50, (PAPERS_MAP,)),
        reuse_row,
        reuse_report,
    ),
    Experiment(
        "gap",
        f"Small maps, {SIDE} x {SIDE}, against the optimum.",
        Profile(100, 10, ALL_MAPS),
        Profile(20, 6, SOME_MAPS),
        gap_row,
        gap_report,
        places=SIDE * SIDE,
    ),
    Experiment(
        "related",
        "Fixed paths, k shortest and k disjoint, and greedy best-first, against CARP.",
        Profile(100, 100, ALL_MAPS),
        Profile(5, 10, (10, 20)),
        related_row,
        related_report,
    ),
    Experiment(
        "polish",
        "The distance of the planner, and of polished plans, from a proved lower bound.",
        Profile(100, 100, ALL_MAPS),
        Profile(8, 20, (10, 20)),
        polish_row,
        polish_report,
    ),
    Experiment(
        "conventions",
        "What the paper leaves open: under which conventions its numbers come out.",
        Profile(100, 100, (10, FULL_MAP)),
        Profile(2, 30, (10, FULL_MAP)),
        partial(row_under, CONVENTIONS),
        conventions_report,
    ),
    Experiment(
        "nearest",
        "The conventions that bring the paper's numbers out best, over more assignments.",
        Profile(100, 100, (10, FULL_MAP)),
        Profile(2, 30, (10, FULL_MAP)),
        partial(row_under, NEAREST),
        conventions_report,
    ),
    Experiment(
        "remaining",
        "Conventions that the screening left out: divisors of the distance, and plans kept where CARP fails.",
        Profile(100, 100, (10, FULL_MAP)),
        Profile(2, 30, (10, FULL_MAP)),
        remaining_row,
        conventions_report,
    ),
    Experiment(
        "neighbours",
        "Where the neighbourhood planner helps: kinds of instances, M, and polish for the same time.",
        Profile(20, 100, (5, 10, 15, FULL_MAP)),
        Profile(2, 20, (10, FULL_MAP)),
        neighbours_row,
        lambda rows, _: neighbours_report(rows),
    ),
    Experiment(
        "left-out",
        "Robots that carproof plan leaves out, before and after its repair.",
        Profile(100, 100, ALL_MAPS),
        Profile(5, 60, SOME_MAPS),
        left_out_row,
        lambda rows, _: left_out_report(rows),
    ),
    Experiment(
        "execution",
        "Late robots on the clock, in order and switching: lateness, arrivals and collisions.",
        Profile(4, 40, (10, 15, FULL_MAP, WAREHOUSE)),
        Profile(2, 10, (10, 20)),
        execution_row,
        lambda rows, _: execution_report(rows),
    ),
    Experiment(
        "following",
        "The price of plans without rotations: following forbidden, and rotations removed.",
        Profile(20, 60, (10, 15, FULL_MAP, WAREHOUSE)),
        Profile(4, 20, (10, FULL_MAP)),
        following_row,
        lambda rows, _: following_report(rows),
    ),
    Experiment(
        "people",
        "People with priority among robots: how early they arrive, and the cost for the robots.",
        Profile(20, 100, (FULL_MAP,)),
        Profile(5, 30, (FULL_MAP,)),
        people_row,
        people_report,
    ),
    Experiment(
        "stream",
        "Robots that come at random, at several rates: throughput up to saturation, and waiting.",
        Profile(4, 500, (10, FULL_MAP, WAREHOUSE)),
        Profile(2, 200, (10, FULL_MAP)),
        stream_row,
        stream_report,
        places=MOST_STREAMED,
    ),
    Experiment(
        "lifelong",
        "Pick-and-drop orders that come at random: throughput, time in the system and time an order.",
        Profile(4, 200, (10, FULL_MAP, WAREHOUSE, SORTING)),
        Profile(2, 30, (10, FULL_MAP)),
        lifelong_row,
        lifelong_report,
        places=MOST_STREAMED,
    ),
)
