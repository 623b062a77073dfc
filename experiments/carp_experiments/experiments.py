"""All experiments by name: their sizes, their cases and their reports."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from carp_experiments import quality
from carp_experiments.campaign import Case
from carp_experiments.quality_report import quality_report
from carp_experiments.report import Report
from carp_experiments.store import Row
from carp_spec import Refusal

ALL_MAPS = tuple(range(quality.FULL_MAP + 1))
SOME_MAPS = (0, 5, 10, 15, 20)


@dataclass(frozen=True, slots=True)
class Profile:
    """How large an experiment is: assignments of start and goal to so many robots, each on every one of the maps."""

    assignments: int
    robots: int
    maps: tuple[int, ...]

    def __str__(self) -> str:
        """Print in words."""
        maps = "all maps" if self.maps == ALL_MAPS else f"maps {', '.join(map(str, self.maps))}"
        return f"{self.assignments} assignments of {self.robots} robots on {maps}"


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
        from carp_oracle.generate.options import ends_suffice  # noqa: PLC0415 - imports what imports this

        if not ends_suffice(self.places, profile.robots):
            message = f"{profile.robots} robots need as many distinct starts, and the map has {self.places}"
            raise Refusal("option", "$.robots", ends_suffice.id, message)


EXPERIMENTS = (
    Experiment(
        "quality",
        "Experiment 1 of the paper: failures and total cost, over the maps.",
        Profile(500, 100, ALL_MAPS),
        Profile(20, 50, SOME_MAPS),
        lambda profile: quality.quality_cases(profile.assignments, profile.maps, profile.robots),
        lambda rows, profile: quality_report(rows, profile.robots),
    ),
)
