"""The best prices, by column generation: the duals of the linear programme of all ways.

The programme has a column for each way that was the cheapest once, with its cost, and one for all that are too late for
the nodes of `carp_optimum.lagrangian.priced_paths`. It shares each robot out among its columns. A row says that a
robot's shares add up to 1; that no more than its capacity use a constraint or an exchange row at a tick; that of a
group's robots all but one keep their deadlines. Its duals are prices. Under these each robot's cheapest way is a column
more, until the bound is what the programme costs: then no prices prove more. Rows are added where shares break them.

The duals jump from one solution to the next. So ways are asked for prices between them and the best ones so far. Each
trial proves a bound in whole numbers, whatever the solver rounds. Source: Dantzig and Wolfe 1960; the smoothing of
Wentges 1997; for robots, with other cuts, Lam, Le Bodic, Harabor and Stuckey 2019.
"""

from collections import defaultdict
from collections.abc import Callable
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from carp_optimized.jit.kinds import Longs, LongTable, ShortTable
from carp_optimized.state.arrays import NONE
from carp_optimum.lagrangian.deadlines import Deadlines, Member
from carp_optimum.lagrangian.linear_programme import Floats, LinearProgramme
from carp_optimum.lagrangian.price_search import PriceSearch

UNBOUNDED = -np.inf
LEAST_EXCESS = 1e-6  # of shares above a capacity
LEAST_SHARE = 1e-7
KEPT = 0.5  # of the best prices, in the next trial
CLOSE = 0.02  # ticks from the bound to what the programme costs


class Column(NamedTuple):
    """A way: its robot, its delay, and where it has the robot at each tick."""

    robot: int
    delay: int
    places: Longs


class ColumnGeneration:
    """The linear programme over a search for prices, which gets its duals as prices.

    A cell is a number times the horizon, and a tick; the number is that of a constraint or, behind these, of a move.
    """

    def __init__(self, search: PriceSearch) -> None:
        self.search = search
        self.programme = LinearProgramme()
        graph = search.dual.graph
        self.constraints = graph.room.size
        self.source = np.repeat(np.arange(graph.duration.size), np.diff(graph.first))
        self.capacity = np.concatenate([graph.room, graph.capacity[self.source]])
        self.columns: list[Column] = []
        self.known: set[tuple[int, bytes, bytes]] = set()
        self.cells = self.column = np.zeros(0, np.int64)  # of all columns, one after the other
        self.cell_of_row = self.row_of_cell = np.zeros(0, np.int64)
        self.deadlines: list[tuple[int, Deadlines]] = []  # each with its row
        self.members: defaultdict[int, list[tuple[int, Member]]] = defaultdict(list)
        self.best = -1
        self.kept: tuple[Longs, Floats, Floats] = self.cells, np.zeros(0), np.zeros(0)
        self.robots = np.flatnonzero(search.dual.requests.earliest != NONE).tolist()
        none = [self.cells] * len(self.robots)
        self.programme.add_rows(1, [1.0] * len(self.robots), none, none)
        self.row_of_robot = {robot: row for row, robot in enumerate(self.robots)}
        one = np.ones(1, np.int64)
        for robot, row in self.row_of_robot.items():
            self.programme.add_column(self._cost(robot, search.dual.delays), row * one, one)
        self._take_ways()

    def climb(self, check: Callable[[], None]) -> None:
        """Add columns and rows until no prices prove more; `check` is called before and during steps, and may raise."""
        added = -1
        while added != 0:
            check()
            self.programme.solve(check)
            rows = self._add_rows(self._exceeded())
            added = self._try(KEPT)
            if added == 0 and rows == 0:
                added = self._try(0)
            if rows > 0:
                added = -1
            elif self.programme.objective - self.best / self.search.scale < CLOSE:
                added = 0

    def _try(self, kept: float) -> int:
        """Try prices between the programme's duals and the best ones, of which a part is kept: how many ways are new.

        The best prices are those that prove most since deadlines were added.
        """
        cells, best, best_fees = self.kept
        duals = np.zeros(self.programme.rows)
        duals[: self.programme.duals.size] = np.maximum(self.programme.duals, 0)
        fees = duals[np.array([row for row, _ in self.deadlines], np.int64)]
        prices = duals[self.row_of_cell]
        if self.best >= 0:
            prices *= 1 - kept
            prices[np.searchsorted(self.cell_of_row, cells)] += kept * best
            fees *= 1 - kept
            fees[: best_fees.size] += kept * best_fees
        scale = self.search.scale
        bound = self.search.try_prices(
            self.cell_of_row, *(np.rint(each * scale).astype(np.int64) for each in (prices, fees))
        )
        if bound > self.best:
            self.best = bound
            self.kept = self.cell_of_row, prices, fees
        return self._take_ways()

    def _take_ways(self) -> int:
        """Add a column for each robot's cheapest way that is not known: how many there are."""
        dual = self.search.dual
        places = self.search.places()
        new: list[Longs] = []
        first = len(self.columns)
        for robot in self.robots:
            length = int(dual.ways.length[robot])
            resources, enters = dual.ways.resource[robot][:length], dual.ways.enter[robot][:length]
            way = robot, resources.tobytes(), enters.tobytes()
            if way not in self.known:
                self.known.add(way)
                cells = self._cells_of(robot, resources.astype(np.int64), enters.astype(np.int64))
                delay = int(enters[-1] - dual.requests.earliest[robot])
                self._add_column(Column(robot, delay, places[robot].astype(np.int64)), cells)
                new.append(cells)
        self.cells = np.concatenate([self.cells, *new])
        self.column = np.concatenate([self.column, np.repeat(np.arange(first, len(self.columns)), [*map(len, new)])])
        return len(new)

    def _cost(self, robot: int, delay: int) -> int:
        requests = self.search.dual.requests
        return int(requests.earliest[robot] - requests.release[robot]) + delay

    def _add_column(self, column: Column, cells: Longs) -> None:
        priced = self.row_of_cell[np.isin(self.cell_of_row, cells)]
        kept = [row for row, member in self.members[column.robot] if self._keeps(member, column)]
        rows = np.concatenate([[self.row_of_robot[column.robot]], priced, kept]).astype(np.int64)
        rows, counts = np.unique(rows, return_counts=True)
        self.columns.append(column)
        self.programme.add_column(self._cost(column.robot, column.delay), rows, counts)

    def _cells_of(self, robot: int, resources: Longs, enters: Longs) -> Longs:
        """The cells that a way uses: constraints at the ticks of stays, exchange rows for moves and between ticks."""
        dual = self.search.dual
        graph, back, horizon = dual.graph, dual.prices.back, self.search.horizon
        stays = int(dual.requests.pace[robot]) * int(graph.duration[resources[-1]])
        last = horizon if dual.parks else int(enters[-1]) + stays
        leaves = np.minimum(np.append(enters[1:], last), horizon)
        cells: list[Longs] = []
        for here, enter, leave in zip(resources.tolist(), enters.tolist(), leaves.tolist(), strict=True):
            ticks = np.arange(enter, leave)
            groups = graph.group[graph.groups_first[here] : graph.groups_first[here + 1]]
            moves = np.arange(graph.first[here], graph.first[here + 1])
            cells += [number * horizon + ticks for number in (here, *(groups + graph.duration.size).tolist())]
            cells += [(move + self.constraints) * horizon + ticks[1:] for move in moves[back[moves] != NONE].tolist()]
        for (here, after), tick in zip(pairwise(resources.tolist()), enters[1:].tolist(), strict=True):
            move = int(graph.first[here]) + int(np.argmax(graph.target[graph.first[here] :] == after))
            if tick < horizon and back[move] != NONE:
                cells.append((np.array([move, back[move]], np.int64) + self.constraints) * horizon + tick)
        used: Longs = np.concatenate(cells)
        return used

    def _exceeded(self) -> Longs:
        """Cells without a row where the shares exceed the capacity: those of constraints, or else of exchanges."""
        shares = self._shares()
        used = shares[self.column] > LEAST_SHARE
        cells, place = np.unique(self.cells[used], return_inverse=True)
        excess = np.bincount(place, shares[self.column[used]], cells.size) - self.capacity[cells // self.search.horizon]
        cells = cells[excess > LEAST_EXCESS]
        cells = cells[~np.isin(cells, self.cell_of_row)]
        of_constraints: Longs = cells[cells < self.constraints * self.search.horizon]
        return of_constraints if of_constraints.size > 0 else cells

    def _add_rows(self, cells: Longs) -> int:
        """Add rows for cells, in ascending order: how many there are."""
        used = np.isin(self.cells, cells)
        order = np.argsort(self.cells[used], kind="stable")
        columns = np.split(self.column[used][order], np.searchsorted(self.cells[used][order], cells)[1:])
        columns = [each + len(self.robots) for each in columns[: cells.size]]
        most = self.capacity[cells // self.search.horizon].tolist()
        first = self.programme.add_rows(UNBOUNDED, most, columns, [np.ones_like(each) for each in columns])
        place = np.searchsorted(self.cell_of_row, cells)
        self.cell_of_row = np.insert(self.cell_of_row, place, cells)
        self.row_of_cell = np.insert(self.row_of_cell, place, np.arange(first, first + cells.size))
        return cells.size

    def add_deadlines(self) -> None:
        """Add rows for the deadlines that the search for prices has more."""
        for each in self.search.deadlines[len(self.deadlines) :]:
            columns, counts = [], []
            for number, column in enumerate(self.columns):
                count = sum(m.robot == column.robot and self._keeps(m, column) for m in each.members)
                if count > 0:
                    columns.append(number + len(self.robots))
                    counts.append(count)
            rows = [np.array(columns, np.int64)], [np.array(counts, np.int64)]
            row = self.programme.add_rows(UNBOUNDED, [len(each.members) - 1], *rows)
            self.deadlines.append((row, each))
            for member in each.members:
                self.members[member.robot].append((row, member))

    def keep_deadlines(self) -> None:
        """Drop the rows of deadlines that the search for prices has dropped."""
        kept = {tuple(each.members) for each in self.search.deadlines}
        dropped = {row for row, each in self.deadlines if tuple(each.members) not in kept}
        for row in dropped:
            self.programme.drop_row(row)
        self.deadlines = [(row, each) for row, each in self.deadlines if row not in dropped]
        for members in self.members.values():
            members[:] = [(row, member) for row, member in members if row not in dropped]
        self.best = -1

    def _keeps(self, member: Member, column: Column) -> bool:
        """Whether a way of the member keeps its deadline."""
        arrival = int(self.search.dual.requests.earliest[member.robot]) + column.delay
        return arrival <= member.arrival or int(column.places[member.seen]) in member.places

    def _shares(self) -> Floats:
        return self.programme.shares[len(self.robots) : len(self.robots) + len(self.columns)]

    def ways(self, steps: int) -> tuple[LongTable, ShortTable]:
        """The shares as so many steps, in each of which every robot has one way: its delay, and its place by tick."""
        robots = len(self.search.instance.robots)
        delays = np.zeros((steps, robots), np.int64)
        places = np.full((steps, robots, self.search.horizon), NONE, np.int16)
        shares = self._shares()
        for robot in self.robots:
            numbers = [number for number in np.flatnonzero(shares > LEAST_SHARE) if self.columns[number].robot == robot]
            ends = np.cumsum(shares[numbers])
            first = 0
            for number, end in zip(numbers, np.rint(ends / ends[-1:] * steps).astype(np.int64).tolist(), strict=True):
                delays[first:end, robot] = self.columns[number].delay
                places[first:end, robot] = self.columns[number].places
                first = end
        return delays, places
