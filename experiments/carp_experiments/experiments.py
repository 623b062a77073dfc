"""All experiments by name: their sizes, their cases and their reports."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from carp_experiments import quality
from carp_experiments.adding_time import PAPERS_MAP, TimeCase, time_report
from carp_experiments.campaign import Case, over_maps
from carp_experiments.polishing import PolishCase, polish_report
from carp_experiments.quality_report import quality_report
from carp_experiments.related_work import RelatedCase, related_report
from carp_experiments.report import Report
from carp_experiments.reuse_counts import ReuseCase, reuse_report
from carp_experiments.small_gaps import SIDE, GapCase, gap_report
from carp_experiments.store import Row
from carp_experiments.unplanned import UnplannedCase, unplanned_report
from carp_spec import Refusal

ALL_MAPS = tuple(range(quality.FULL_MAP + 1))
SOME_MAPS = (0, 5, 10, 15, 20)
SPARSE_MAPS = tuple(range(8))


@dataclass(frozen=True, slots=True)
class Profile:
    """How large an experiment is: assignments of start and goal to so many robots, each on every one of the maps."""

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
    """An experiment. The case of an assignment and a map is the same in every profile of as many robots."""

    name: str
    sentence: str
    full: Profile
    quick: Profile
    cases: Callable[[Profile], Sequence[Case]]
    report: Callable[[Iterable[Row], Profile], Report]
    places: int = 400

    def refuse(self, profile: Profile) -> None:
        """Raise `Refusal` where the maps have no place for so many robots."""
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
        lambda profile: over_maps(quality.QualityCase, profile.assignments, profile.maps, profile.robots),
        lambda rows, profile: quality_report(rows, profile.robots),
    ),
    Experiment(
        "time",
        "Experiment 2 of the paper: time to plan when the k-th robot comes.",
        Profile(500, 100, (PAPERS_MAP,)),
        Profile(20, 50, (PAPERS_MAP,)),
        lambda profile: over_maps(TimeCase, profile.assignments, profile.maps, profile.robots),
        lambda rows, _: time_report(rows),
    ),
    Experiment(
        "reuse",
        "Queries asked to add a robot, avoided, and why.",
        Profile(500, 100, (PAPERS_MAP,)),
        Profile(20, 50, (PAPERS_MAP,)),
        lambda profile: over_maps(ReuseCase, profile.assignments, profile.maps, profile.robots),
        lambda rows, profile: reuse_report(rows, profile.robots),
    ),
    Experiment(
        "gap",
        f"Small maps, {SIDE} x {SIDE}, against the optimum.",
        Profile(100, 10, ALL_MAPS),
        Profile(20, 6, SOME_MAPS),
        lambda profile: over_maps(GapCase, profile.assignments, profile.maps, profile.robots),
        lambda rows, profile: gap_report(rows, profile.robots),
        places=SIDE * SIDE,
    ),
    Experiment(
        "related",
        "Fixed paths, k shortest and k disjoint, and greedy best-first, against CARP.",
        Profile(100, 100, ALL_MAPS),
        Profile(5, 10, (10, 20)),
        lambda profile: over_maps(RelatedCase, profile.assignments, profile.maps, profile.robots),
        lambda rows, profile: related_report(rows, profile.robots),
    ),
    Experiment(
        "polish",
        "How far the planner is from a proved lower bound, and the polished planner.",
        Profile(100, 100, ALL_MAPS),
        Profile(8, 20, (10, 20)),
        lambda profile: over_maps(PolishCase, profile.assignments, profile.maps, profile.robots),
        lambda rows, profile: polish_report(rows, profile.robots),
    ),
    Experiment(
        "unplanned",
        "What polish leaves unplanned on the sparse maps, and whether it could be planned.",
        Profile(20, 100, SPARSE_MAPS),
        Profile(5, 60, (0, 5)),
        lambda profile: over_maps(UnplannedCase, profile.assignments, profile.maps, profile.robots),
        lambda rows, _: unplanned_report(rows),
    ),
)
