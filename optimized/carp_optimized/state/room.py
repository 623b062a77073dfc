"""Arrays of the sizes that a state, a query, an addition and a polish need, with nothing in them yet."""

import numpy as np

from carp_optimized.jit.blocks import BLOCK
from carp_optimized.jit.kinds import Flags, Ints, Longs
from carp_optimized.state.arrays import (
    ANSWERS,
    MOST_TURNS,
    NEVER,
    NONE,
    PLANS,
    UNASKED,
    Answers,
    Freed,
    Graph,
    Guides,
    Polish,
    Records,
    Rows,
    Search,
    Stops,
    Sweep,
    WaysBack,
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
        reached=_longs(labels),
        parent=_ints(labels),
        expanded=_ints(entries),
        entered=_ints(entries),
        came=_ints(entries),
        keys=_longs(entries),
        ties=_longs(entries),
        labels=_ints(entries),
    )


def no_guides(resources: int, goals: Ints, paces: Ints, has_ranks: bool, stops: int = 0) -> Guides:
    """Guides yet to be made: for all destinations, or as many as fit, but for twice the stops of a robot at least."""
    tables = 2 if has_ranks else 1
    slots = max(1, min(goals.size, max(64, 2 * stops, GUIDE_PLACES // max(1, resources * tables))))
    return Guides(
        ticks=np.empty((slots, resources), np.int32),
        rank=np.empty((slots, resources if has_ranks else 0), np.int32),
        slot=_nones(goals.size),
        holds=_nones(slots),
        next=_longs(1),
        goal=goals,
        pace=paces,
        detour=DETOUR,
    )


def empty_rows(has_row: Flags, filled: bool, places: int) -> Rows:
    """Rows of the resources that have one, filled with one interval for ever or empty; the first block is no row's."""
    rows = int(has_row.sum())
    offset = _ints(has_row.size)
    offset[has_row] = BLOCK * (1 + np.arange(rows))
    resource = _ints(places)
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
        source=_nones(places),
        robot=_nones(places),
        rank=_nones(places),
        resource=resource,
        used=np.array([BLOCK * (1 + rows)], np.int64),
    )


def no_search(windows: int, edges: int) -> Search:
    """The scratch of a query over that many window slots."""
    entries = windows // 4 + edges + 1
    return Search(
        generation=_longs(1),
        opens=_longs(1),
        least=_longs(1),
        reached=_longs(windows),
        parent=_ints(windows),
        keys=_longs(entries),
        nodes=_ints(entries),
        expanded=_ints(entries),
        entered=_ints(entries),
        ready=_ints(entries),
        came=_ints(entries),
        popped=_longs(entries),
        expansions=_longs(1),
        back=WaysBack(
            looks=_longs(1),
            until=_longs(windows),
            keys=_longs(entries),
            nodes=_ints(entries),
        ),
    )


def no_records(records: int, visits: int, expansions: int) -> Records:
    """Room for records."""
    return Records(
        robot=_ints(records),
        visits_at=_longs(records),
        visits=_ints(records),
        leave=_ints(records),
        arrival=_ints(records),
        expansions_at=_longs(records),
        expansions=_ints(records),
        regions=_longs(records),
        opens=_ints(records),
        least=_ints(records),
        spots=np.zeros((records, 8), np.int64),
        resource=_ints(visits),
        enter=_ints(visits),
        expanded=_ints(expansions),
        ready=_ints(expansions),
        until=_ints(expansions),
        largest=_longs(expansions),
        used=_longs(3),
    )


def nothing_freed(resources: int) -> Freed:
    """No stay has been taken back."""
    return Freed(
        now=np.ones(1, np.int64),
        mark=_longs(resources),
        earliest=_ints(resources),
        latest=_ints(resources),
        source=_ints(resources),
        near_earliest=np.full(resources, NEVER, np.int32),
        near_latest=_ints(resources),
        regions=_longs(1),
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
        into=_ints(most),
        out=_ints(most),
        mark=_longs(graph.capacity.size),
        now=_longs(1),
    )


def no_work(robots: int, members: int, sample: int) -> Work:
    """Room to add robots with neighbourhoods of that many members and that many orders drawn."""
    return Work(
        queue=_nones(robots),
        stream=np.zeros(1, np.uint64),
        before=_nones(robots),
        ended=_nones(robots),
        held=_nones(robots),
        trajectories=_nones(robots),
        spots=np.zeros((8, robots), np.int64),
        away=_longs(robots),
        near=_longs(robots),
        outside=_nones(robots),
        best_order=_nones(robots),
        best_plans=_nones(robots),
        members=_nones(members),
        alone=_nones(members),
        found_order=_nones(members),
        found_plans=_nones(members),
        order=_nones(members),
        chosen=_nones(members),
        least=_longs(members),
        given=_longs(members + 1),
        cost=_longs(members + 1),
        rows=np.zeros((sample, members), np.int32),
        row_key=_longs(sample),
        row_index=_nones(sample),
        row_spare=_nones(sample),
    )


def no_polish(costs: Longs, past: Ints, resources: int) -> Polish:
    """Room to polish, with the costs of the plans that the robots have alone, `NONE` for one without."""
    has_path = costs != NONE
    return Polish(
        queue=_nones(costs.size),
        plans=_nones(costs.size),
        counts=_longs(7),
        stream=np.zeros(1, np.uint64),
        alone=np.where(has_path, np.int32(UNASKED), np.int32(NONE)),
        least=np.maximum(costs, 0),
        has_path=int(has_path.sum()),
        past=past,
        mark=_longs(resources),
        first=_nones(resources),
        last=_nones(resources),
        marked=_nones(resources),
        candidates=_nones(max(costs.size, MOST_TURNS)),
        whole=_longs(MOST_TURNS),
        rest=_longs(MOST_TURNS),
        ticks=_longs(MOST_TURNS),
        members=_nones(MOST_TURNS),
        before=_nones(MOST_TURNS),
        chosen=_nones(MOST_TURNS),
        others=_nones(costs.size),
    )


def no_answers(members: int, resources: int) -> Answers:
    """Room for the answers of a round."""
    return Answers(
        record=_ints(PLANS),
        owner=_ints(PLANS),
        clashes=_longs(PLANS),
        compared=_longs(PLANS),
        given=_longs(ANSWERS),
        plan=_ints(ANSWERS),
        least=_longs(ANSWERS),
        found=_ints(ANSWERS),
        newer=_ints(ANSWERS),
        oldest=_ints(members),
        newest=_ints(members),
        read=np.zeros((resources, 8), np.int64),
        used=_longs(3),
    )


def _ints(size: int) -> Ints:
    return np.zeros(size, np.int32)


def _longs(size: int) -> Longs:
    return np.zeros(size, np.int64)


def _nones(size: int) -> Ints:
    return np.full(size, NONE, np.int32)
