"""Cases of the experiments on the paper's maps: an assignment of start and goal to robots, on one of the maps."""

from collections import defaultdict
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TypeVar, cast

import msgspec

from carp_experiments.paper.sorting import sorting_instance
from carp_experiments.store import Row
from carp_spec import Instance
from carproof.generate import Fleet, Grid, Warehouse, grid_instance, warehouse_instance

ROBOTS = 100
TENTH_MAP = 10
FULL_MAP = 20
WAREHOUSE = 21
"""The number that a warehouse of the generator has beside the paper's maps."""
SORTING = 22
"""That of a sorting centre."""
STATIONS = 20
MAP_AXIS = f"map (0: spanning tree, {FULL_MAP}: full grid)"
SHOWN_MAPS = (0, 5, 10, 15, 20)


R = TypeVar("R")


@dataclass(frozen=True, slots=True)
class MapCase:
    """One assignment of this many robots on one map, and the function that computes its row."""

    compute: "Callable[[MapCase], Row]"
    map: int
    assignment: int
    robots: int = ROBOTS

    @property
    def key(self) -> str:
        """Assignments and maps in their order."""
        return f"assignment {self.assignment:03} map {self.map:02}"

    def run(self) -> Row:
        """The row that is computed, with map and assignment."""
        return {"map": self.map, "assignment": self.assignment, **msgspec.to_builtins(self.compute(self))}


def instance_of(case: MapCase) -> Instance:
    """The map with the robots; raises `Refusal` where they have no place on it."""
    fleet = Fleet(robots=case.robots, seed=case.assignment)
    return map_instance(case.map, replace(fleet, distinct="starts") if case.map > FULL_MAP else fleet)


def map_instance(map: int, fleet: Fleet) -> Instance:
    """A map, the warehouse or the sorting centre with a fleet; raises `Refusal` where it has no place on it."""
    if map == WAREHOUSE:
        return warehouse_instance(Warehouse(stations=STATIONS), fleet)
    if map == SORTING:
        return sorting_instance(fleet)
    return grid_instance(Grid(map=map), fleet)


def rows_by_map(rows: Iterable[Row], shape: type[R]) -> dict[int, list[R]]:
    """The stored rows of each map, the maps in their order."""
    by_map: dict[int, list[R]] = defaultdict(list)
    for row in rows:
        by_map[cast("int", row["map"])].append(msgspec.convert(row, shape))
    return dict(sorted(by_map.items()))


def place_name(map: int) -> str:
    """The name of a map for people."""
    return {WAREHOUSE: "the warehouse", SORTING: "the sorting centre"}.get(map, f"map {map}")


def shown_maps(maps: Iterable[int]) -> list[int]:
    """The maps that a table shows: some of those measured, or all."""
    measured = sorted(set(maps))
    return [map for map in SHOWN_MAPS if map in measured] or measured
