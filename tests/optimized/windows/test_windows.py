"""The windows of the arrays are the free windows of the specification, and withdrawing a plan undoes reserving it."""

from collections.abc import Sequence
from random import Random

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.profiles import draws

from carp_optimized import passes
from carp_optimized.fleet import PlannedFleet
from carp_optimized.state.arrays import NEVER, Rows
from carp_spec import Instance, Plan
from carp_spec.windows import Window, constraints_on, free_windows
from carproof.testing.strategies import PlannedInstance, Sizes, planned_instances

SIZES = Sizes(resources=5, robots=6, groups=2)


def rows(table: Rows, resource: int) -> list[tuple[int, int, int, int]]:
    """The entries of a resource's row."""
    slots = range(table.offset[resource], table.offset[resource] + table.size[resource])
    columns = (table.start, table.end, table.source, table.robot)
    return [tuple(int(column[slot]) for column in columns) for slot in slots]  # type: ignore[misc]


def held(fleet: PlannedFleet) -> list[object]:
    """All that is reserved; stays that begin, or end, at a tick are in no order."""
    windows, stays = fleet.state.windows, fleet.state.stays
    reported: list[object] = [rows(windows, resource) for resource in range(windows.size.size)]
    for constraint in np.flatnonzero(stays.room).tolist():
        entries = rows(stays, constraint)
        reported.append((sorted((start, source) for start, _, source, _ in entries), [end for _, end, *_ in entries]))
    return reported


def assert_windows_are(fleet: PlannedFleet, instance: Instance, plans: Sequence[Plan]) -> None:
    for position, resource in enumerate(instance.graph.resources):
        windows = tuple(
            Window(start, None if end == NEVER else end)
            for start, end, *_ in rows(fleet.state.windows, position)
            if start < end  # between two stays without a tick between, too, there is a window, of no length
        )
        assert windows == free_windows(constraints_on(instance.graph, plans, resource.id))


def some_of(positions: Sequence[int], random: Random) -> list[int]:
    """Some of the positions, one at least."""
    return random.sample(positions, random.randint(1, len(positions)))


@settings(max_examples=draws(300))
@given(planned_instances(SIZES), st.randoms(use_true_random=False))
def test_withdrawing_undoes_reserving_in_any_order(planned: PlannedInstance, random: Random) -> None:
    plans = list(planned.solution.plans)
    fleet = PlannedFleet(planned.instance)
    records = np.array([fleet.record(plan) for plan in plans], np.int32)
    there: list[int] = []
    empty = held(fleet)
    for _ in range(2 * len(plans)):
        absent = [position for position in range(len(plans)) if position not in there]
        before = held(fleet)
        if absent and (not there or random.random() < 0.6):
            added = some_of(absent, random)
            passes.reserve_all(fleet.native, records[added])
            after = held(fleet)
            passes.withdraw_all(fleet.native, records[added])
            assert held(fleet) == before
            for position in added:
                passes.reserve_all(fleet.native, records[[position]])
            assert held(fleet) == after
            there += added
        elif there:
            gone = some_of(there, random)
            passes.withdraw_all(fleet.native, records[gone])
            there = [position for position in there if position not in gone]
        assert_windows_are(fleet, planned.instance, [plans[position] for position in there])
    passes.withdraw_all(fleet.native, records[there])
    assert held(fleet) == empty
