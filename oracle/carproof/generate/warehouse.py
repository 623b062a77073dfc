"""Warehouses: blocks of racks, aisles between and around them, and picking stations at the left side."""

from dataclasses import dataclass

from carp_spec import Instance
from carp_spec.permutations import splitmix64
from carproof.generate.fleet import Fleet, random_robots
from carproof.generate.grid import NO_FLEET, NO_TRAITS, cell_edges, cell_graph, cell_id
from carproof.generate.options import Side, Traits, refuse_large_maps, refuse_wrong_options


@dataclass(frozen=True, slots=True)
class Warehouse:
    """The plan of a warehouse, in cells.

    `columns` times `rows` racks, each `rack_length` cells wide and `rack_depth` deep, stand with aisles `aisle` cells
    wide between and around them. The stations, spread evenly, are bays in front of the left aisle. Robots start at
    cells beside the racks and end at stations, or the other way round, by `start_at`. What they pick up is at cells
    beside the racks, and they drop it at stations.
    """

    columns: int = 4
    rows: int = 5
    rack_length: int = 8
    rack_depth: int = 2
    aisle: int = 2
    stations: int = 6
    start_at: Side = "racks"
    map_seed: int = 0

    @property
    def width(self) -> int:
        """Cells from left to right: the stations' bays, then racks and aisles."""
        return 1 + self.aisle + self.columns * (self.rack_length + self.aisle)

    @property
    def height(self) -> int:
        """Cells from top to bottom."""
        return self.aisle + self.rows * (self.rack_depth + self.aisle)

    def is_rack(self, x: int, y: int) -> bool:
        """Whether a rack stands on the cell."""
        right, down = x - 1 - self.aisle, y - self.aisle
        if not (0 <= right < self.width and 0 <= down < self.height):
            return False
        along = right % (self.rack_length + self.aisle) < self.rack_length
        across = down % (self.rack_depth + self.aisle) < self.rack_depth
        return along and across and x < self.width and y < self.height


def warehouse_instance(warehouse: Warehouse, fleet: Fleet = NO_FLEET, traits: Traits = NO_TRAITS) -> Instance:
    """Make a warehouse and its robots."""
    refuse_wrong_options(warehouse=(warehouse, Warehouse), fleet=(fleet, Fleet), traits=(traits, Traits))
    refuse_large_maps(warehouse.width, warehouse.height)
    bays = _station_bays(warehouse)
    aisles = [(x, y) for y in range(warehouse.height) for x in range(1, warehouse.width) if not warehouse.is_rack(x, y)]
    cells = sorted([*bays, *aisles], key=lambda cell: (cell[1], cell[0]))
    graph = cell_graph(cells, list(cell_edges(cells)), traits, splitmix64(warehouse.map_seed))
    stations = [cell_id(*bay) for bay in bays]
    shelves = [cell_id(x, y) for x, y in aisles if _is_beside_rack(warehouse, x, y)]
    starts, goals = (shelves, stations) if warehouse.start_at == "racks" else (stations, shelves)
    goals = stations if fleet.orders == "pick-and-drop" else goals
    return Instance(graph, random_robots(fleet, starts, goals, shelves), fleet.after_goal)


def _station_bays(warehouse: Warehouse) -> list[tuple[int, int]]:
    """The stations' cells, at the middles of equal parts of the left side."""
    parts = min(warehouse.stations, warehouse.height)
    return [(0, (2 * part + 1) * warehouse.height // (2 * parts)) for part in range(parts)]


def _is_beside_rack(warehouse: Warehouse, x: int, y: int) -> bool:
    return any(warehouse.is_rack(*cell) for cell in ((x - 1, y), (x + 1, y), (x, y - 1), (x, y + 1)))
