"""The distance of planners from the optimum on a family of generated grids: mean gaps with 95 % intervals.

Seeds decide everything but the time limit of a search. Means are floats; they report, and decide nothing.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from carp_optimum.gap import Gap, gap
from carp_spec import AfterGoal, Instance, Planner
from carproof.gap.statistics import Excess, excess
from carproof.generate import Fleet, Grid, Range, grid_instance


@dataclass(frozen=True, slots=True)
class Family:
    """Square grids of each size and each of the paper's maps, `count` instances of each.

    Instance i has a map, starts and goals of the seed + i; if `robots` is `None`, as many robots as the grid is wide.
    """

    sizes: Range
    maps: tuple[int, ...]
    robots: int | None = None
    count: int = 20
    seed: int = 0
    after_goal: AfterGoal = "vanish"

    @property
    def cells(self) -> Sequence[tuple[int, int]]:
        """Size and map of each cell of the table."""
        return [(size, map) for size in range(self.sizes.low, self.sizes.high + 1) for map in self.maps]

    def robots_on(self, size: int) -> int:
        """The number of robots on a grid of the size."""
        return size if self.robots is None else self.robots

    @property
    def seeds(self) -> range:
        """The seeds of the instances of a cell."""
        return range(self.seed, self.seed + self.count)

    def instance(self, size: int, map: int, seed: int) -> Instance:
        """The instance of a seed; raises `Refusal` for impossible options."""
        return grid_instance(Grid(size, size, map, seed), Fleet(self.robots_on(size), seed, self.after_goal))


@dataclass(frozen=True, slots=True)
class Cell:
    """The gaps of the instances of one size and map, by seed; those without a known optimum are in no mean."""

    size: int
    map: int
    robots: int
    seeds: range
    gaps: tuple[Gap, ...]

    @property
    def decided(self) -> list[Gap]:
        """The gaps of instances with a known optimum."""
        return [each for each in self.gaps if each.optimum.decided and each.optimum.cost is not None]

    @property
    def delay(self) -> Excess:
        """The optimum above the sum of the shortest paths, in per cent of the latter."""
        return excess((each.optimum.cost, each.optimum.shortest, each.optimum.shortest) for each in self.decided)

    @property
    def price_of_an_order(self) -> Excess:
        """The best order above the optimum, where it is known."""
        return excess((each.best_order, each.optimum.cost, each.optimum.cost) for each in self.decided)

    def above_optimum(self, planner: int) -> Excess:
        """The planner of that position above the optimum, where it planned all robots."""
        return excess((_total(each, planner), each.optimum.cost, each.optimum.cost) for each in self.decided)

    def price_of_the_search(self, planner: int) -> Excess:
        """The planner of that position above the best order, where both are known."""
        return excess((_total(each, planner), each.best_order, each.optimum.cost) for each in self.decided)


def measured(
    family: Family, planners: Sequence[Planner], limit: float, advance: Callable[[], None] = lambda: None
) -> Iterator[Cell]:
    """Measure cell after cell; each search takes `limit` seconds at most, and `advance` is called after an instance.

    Raises `Refusal` for a family that has more robots than its smallest grid has cells.
    """
    for size, map in family.cells:
        gaps = []
        for seed in family.seeds:
            gaps.append(gap(family.instance(size, map, seed), planners, limit))
            advance()
        yield Cell(size, map, family.robots_on(size), family.seeds, tuple(gaps))


def _total(gap: Gap, planner: int) -> int | None:
    """The planner's total, if it planned all robots."""
    reached = gap.planners[planner]
    return None if reached.unplanned else reached.total
