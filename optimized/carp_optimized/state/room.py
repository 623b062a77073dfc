"""Arrays of the sizes that a state, a query, an addition and a polish need, with nothing in them yet."""

import numpy as np
import numpy.typing as npt

from carp_optimized.jit.kinds import Ints, Longs
from carp_optimized.state.arrays import (
    ANSWERS,
    BLOCK,
    MOST_GATHERED,
    MOST_TURNS,
    NEVER,
    NONE,
    PLANS,
    UNASKED,
    Answers,
    Ending,
    Freed,
    Graph,
    Guides,
    Polish,
    Records,
    Rows,
    Search,
    Stops,
    Sweep,
    Work,
)

DETOUR = 8  # of the durations by which a guide goes further than to the start: seldom more are needed on large maps
GUIDE_PLACES = 1 << 26  # how many entries all guides together have at most, if that is room for 64 of them


def with_labels(stops: Stops, windows: int, edges: int) -> Stops:
    """The stops with room for the labels of that many windows."""
    if stops.place.size == 0:
        return stops
    labels, entries = stops.stride * windows, stops.stride * (windows // 4 + edges + 1)
    return stops._replace(
        reached=np.zeros(labels, np.int64),
        parent=np.zeros(labels, np.int32),
        keys=np.zeros(entries, np.int64),
        ties=np.zeros(entries, np.int64),
        labels=np.zeros(entries, np.int32),
    )


def no_guides(resources: int, goals: Ints, paces: Ints, has_ranks: bool, stops: int = 0) -> Guides:
    """Guides yet to be made: for all destinations, or as many as fit, but for twice the stops of a robot at least."""
    tables = 2 if has_ranks else 1
    slots = max(1, min(goals.size, max(64, 2 * stops, GUIDE_PLACES // max(1, resources * tables))))
    return Guides(
        ticks=np.empty((slots, resources), np.int32),
        rank=np.empty((slots, resources if has_ranks else 0), np.int32),
        slot=np.full(goals.size, NONE, np.int32),
        holds=np.full(slots, NONE, np.int32),
        next=np.zeros(1, np.int64),
        goal=goals,
        pace=paces,
        detour=DETOUR,
    )


def empty_rows(has_row: npt.NDArray[np.bool_], filled: bool, places: int) -> Rows:
    """Rows of the resources that have one, filled with one interval for ever or empty; the first block is no row's."""
    rows = int(has_row.sum())
    offset = np.zeros(has_row.size, np.int32)
    offset[has_row] = BLOCK * (1 + np.arange(rows))
    resource = np.zeros(places, np.int32)
    resource[BLOCK : BLOCK * (1 + rows)] = np.repeat(np.flatnonzero(has_row), BLOCK)
    start = np.full(places, NEVER, np.int32)
    if filled:
        start[offset[has_row]] = 0
    return Rows(
        offset=offset,
        room=np.where(has_row, BLOCK, 0).astype(np.int32),
        size=np.full(has_row.size, int(filled), np.int32),
        start=start,
        end=np.full(places, NEVER, np.int32),
        source=np.full(places, NONE, np.int32),
        robot=np.full(places, NONE, np.int32),
        rank=np.full(places, NONE, np.int32),
        resource=resource,
        used=np.array([BLOCK * (1 + rows)], np.int64),
    )


def no_search(windows: int, edges: int) -> Search:
    """The scratch of a query over that many window slots."""
    entries = windows // 4 + edges + 1
    return Search(
        generation=np.zeros(1, np.int64),
        goal=np.zeros(1, np.int64),
        reached=np.zeros(windows, np.int64),
        parent=np.zeros(windows, np.int32),
        keys=np.zeros(entries, np.int64),
        nodes=np.zeros(entries, np.int32),
        expanded=np.zeros(entries, np.int32),
        ready=np.zeros(entries, np.int32),
        popped=np.zeros(entries, np.int64),
        expansions=np.zeros(1, np.int64),
        ending=Ending(
            gathered=np.zeros(MOST_GATHERED, np.int32),
            place=np.zeros(windows, np.int32),
            reached=np.zeros(MOST_GATHERED, np.int64),
            parent=np.zeros(MOST_GATHERED, np.int32),
            until=np.zeros(MOST_GATHERED, np.int32),
            is_due=np.zeros(MOST_GATHERED, np.int32),
            trace=np.zeros(MOST_GATHERED, np.int64),
            until_by_window=np.zeros(windows, np.int64),
            counts=np.zeros(3, np.int64),
            keys=np.zeros(entries, np.int64),
            nodes=np.zeros(entries, np.int32),
        ),
    )


def no_records(records: int, visits: int, expansions: int) -> Records:
    """Room for records."""

    def ints(size: int) -> Ints:
        return np.zeros(size, np.int32)

    def longs(size: int) -> Longs:
        return np.zeros(size, np.int64)

    return Records(
        robot=ints(records),
        visits_at=longs(records),
        visits=ints(records),
        leave=ints(records),
        arrival=ints(records),
        expansions_at=longs(records),
        expansions=ints(records),
        regions=longs(records),
        spots=np.zeros((records, 8), np.int64),
        resource=ints(visits),
        enter=ints(visits),
        expanded=ints(expansions),
        ready=ints(expansions),
        until=ints(expansions),
        largest=longs(expansions),
        used=longs(3),
    )


def nothing_freed(resources: int) -> Freed:
    """No stay has been taken back."""
    return Freed(
        now=np.ones(1, np.int64),
        mark=np.zeros(resources, np.int64),
        earliest=np.zeros(resources, np.int32),
        latest=np.zeros(resources, np.int32),
        source=np.zeros(resources, np.int32),
        near_earliest=np.full(resources, NEVER, np.int32),
        near_latest=np.zeros(resources, np.int32),
        regions=np.zeros(1, np.int64),
    )


def all_free(graph: Graph, places: int) -> Rows:
    """The windows where no plan is reserved."""
    return empty_rows(np.ones(graph.capacity.size, np.bool_), filled=True, places=places)


def no_stays(graph: Graph, places: int) -> Rows:
    """The stays, of which there are none, where there is room for several robots."""
    several = np.ones(graph.room.size, np.bool_)
    several[: graph.capacity.size] = graph.capacity != 1
    return empty_rows(several, filled=False, places=places if several.any() else BLOCK)


def no_sweep(graph: Graph) -> Sweep:
    """The scratch for stays in groups."""
    most = 1 + int(np.diff(graph.groups_first).max(initial=0))
    return Sweep(
        into=np.zeros(most, np.int32),
        out=np.zeros(most, np.int32),
        mark=np.zeros(graph.capacity.size, np.int64),
        now=np.zeros(1, np.int64),
    )


def no_work(robots: int, members: int, sample: int) -> Work:
    """Room to add robots with neighbourhoods of that many members and that many orders drawn."""

    def ints(size: int) -> Ints:
        return np.full(size, NONE, np.int32)

    def longs(size: int) -> Longs:
        return np.zeros(size, np.int64)

    return Work(
        queue=ints(robots),
        stream=np.zeros(1, np.uint64),
        before=ints(robots),
        ended=ints(robots),
        held=ints(robots),
        trajectories=ints(robots),
        spots=np.zeros((8, robots), np.int64),
        away=longs(robots),
        near=longs(robots),
        outside=ints(robots),
        best_order=ints(robots),
        best_plans=ints(robots),
        members=ints(members),
        alone=ints(members),
        found_order=ints(members),
        found_plans=ints(members),
        order=ints(members),
        chosen=ints(members),
        least=longs(members),
        given=longs(members + 1),
        cost=longs(members + 1),
        rows=np.zeros((sample, members), np.int32),
        row_key=longs(sample),
        row_index=ints(sample),
        row_spare=ints(sample),
    )


def no_polish(costs: Longs, resources: int) -> Polish:
    """Room to polish, with the costs of the plans that the robots have alone, `NONE` for one without."""
    has_path = costs != NONE

    def ints(size: int) -> Ints:
        return np.full(size, NONE, np.int32)

    def longs(size: int) -> Longs:
        return np.zeros(size, np.int64)

    return Polish(
        queue=ints(costs.size),
        plans=ints(costs.size),
        counts=longs(7),
        stream=np.zeros(1, np.uint64),
        alone=np.where(has_path, np.int32(UNASKED), np.int32(NONE)),
        least=np.maximum(costs, 0),
        has_path=int(has_path.sum()),
        mark=longs(resources),
        first=ints(resources),
        last=ints(resources),
        marked=ints(resources),
        candidates=ints(max(costs.size, MOST_TURNS)),
        whole=longs(MOST_TURNS),
        rest=longs(MOST_TURNS),
        ticks=longs(MOST_TURNS),
        members=ints(MOST_TURNS),
        before=ints(MOST_TURNS),
        chosen=ints(MOST_TURNS),
        others=ints(costs.size),
    )


def no_answers(members: int, resources: int) -> Answers:
    """Room for the answers of a round."""
    return Answers(
        record=np.zeros(PLANS, np.int32),
        owner=np.zeros(PLANS, np.int32),
        clashes=np.zeros(PLANS, np.int64),
        compared=np.zeros(PLANS, np.int64),
        given=np.zeros(ANSWERS, np.int64),
        plan=np.zeros(ANSWERS, np.int32),
        least=np.zeros(ANSWERS, np.int64),
        found=np.zeros(ANSWERS, np.int32),
        newer=np.zeros(ANSWERS, np.int32),
        oldest=np.zeros(members, np.int32),
        newest=np.zeros(members, np.int32),
        read=np.zeros((resources, 8), np.int64),
        used=np.zeros(3, np.int64),
    )
