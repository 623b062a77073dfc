"""Whether many plans break no rule, by sorting and comparing whole arrays: ten times as fast as the rules one by one.

It decides only that they break none. Where it is not sure, `check` asks the rules, which find the violations and word
them: of instances with groups, or stops on the way, and of plans with something that no right plan has.
"""

from collections.abc import Sequence
from itertools import chain, repeat
from operator import attrgetter
from typing import TYPE_CHECKING

from carp_spec.model import Instance, Plan

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Longs = npt.NDArray[np.int64]

MANY = 20_000
"""Visits from which on it is worth to load numpy."""
LATEST = 1 << 30
"""Ticks from here on are left to the rules. So are numbers of resources and edges that are larger."""


def is_large(plans: Sequence[Plan]) -> bool:
    """Whether there are so many visits that this is quicker."""
    return sum(len(plan.visits) for plan in plans) >= MANY


def breaks_no_rule(instance: Instance, plans: Sequence[Plan]) -> bool:
    """Whether it is certain that plans of known robots break no rule `plan/...` or `joint/...`."""
    import numpy as np  # noqa: PLC0415 - slow to load

    graph = instance.graph
    robots = [instance.robot[plan.robot] for plan in plans]
    is_known = not graph.groups and all(len(each.stops) == 1 for each in robots)
    if not (is_known and plans and all(plan.visits for plan in plans)):
        return False
    visits = list(chain.from_iterable(plan.visits for plan in plans))
    index, unknown = dict(graph.index), len(graph.resources)
    places = list(map(index.get, map(attrgetter("resource"), visits), repeat(unknown)))
    enters, leaves = list(map(attrgetter("enter"), visits)), list(map(attrgetter("leave"), visits))
    left = [each for each in leaves if each is not None]
    durations = [each.duration for each in graph.resources]
    of_robots = [(each.release, each.pace, each.stops[0].service) for each in robots]
    numbers = (enters, left, durations, *of_robots, (unknown, len(graph.moves)))
    if max(places) == unknown or not all(min(each) >= 0 and max(each) < LATEST for each in numbers if each):
        return False
    place, enter, duration = (np.array(each, np.int64) for each in (places, enters, durations))
    leave = np.array([LATEST if each is None else each for each in leaves], np.int64)
    release, pace, service = np.array(of_robots, np.int64).T
    last = np.cumsum([len(plan.visits) for plan in plans]) - 1
    first = np.concatenate([[0], last[:-1] + 1])
    goes_on = np.ones(len(visits), np.bool_)
    goes_on[last] = False
    before = np.flatnonzero(goes_on)
    least = duration[place] * np.repeat(pace, last - first + 1)
    end = (
        np.full(last.size, LATEST) if instance.after_goal == "park" else enter[last] + np.maximum(least[last], service)
    )
    return bool(
        np.array_equal(place[first], [index[each.start] for each in robots])
        and np.array_equal(enter[first], release)
        and np.array_equal(place[last], [index[each.stops[0].resource] for each in robots])
        and np.array_equal(leave[last], end)
        and np.array_equal(leave[before], enter[before + 1])
        and (leave - enter >= least)[leave < LATEST].all()
        and _have_room(instance, place, enter, leave + instance.gap)
        and _moves_do_not_meet(instance, place[before], place[before + 1], leave[before])
    )


def _have_room(instance: Instance, place: "Longs", enter: "Longs", leave: "Longs") -> bool:
    """Whether each resource has room for all stays.

    In order of time, stay k begins in a resource of capacity c no earlier than the end that comes k - c ends after the
    first: then at most c have begun and not ended.
    """
    import numpy as np  # noqa: PLC0415 - slow to load

    begins, ends = np.sort(place * 2 * LATEST + enter), np.sort(place * 2 * LATEST + leave)
    rooms = [min(each.capacity, place.size) for each in instance.graph.resources]
    capacity = np.array(rooms, np.int64)[begins // (2 * LATEST)]
    later = np.flatnonzero(capacity <= np.arange(place.size))
    earlier = ends[later - capacity[later]]
    is_same = earlier // (2 * LATEST) == begins[later] // (2 * LATEST)
    return bool((earlier <= begins[later])[is_same].all())


def _moves_do_not_meet(instance: Instance, source: "Longs", target: "Longs", tick: "Longs") -> bool:
    """Whether all are moves of the graph, and none comes from where another goes at the same tick, and the reverse."""
    import numpy as np  # noqa: PLC0415 - slow to load

    graph, size = instance.graph, len(instance.graph.resources)
    ends = map(dict(graph.index).__getitem__, chain.from_iterable(graph.edges))
    one, other = np.fromiter(ends, np.int64).reshape(-1, 2).T
    moves = np.sort(np.concatenate([one * size + other, *([] if graph.directed else [other * size + one])]))
    made, reverse = source * size + target, target * size + source
    if not np.isin(made, moves).all():
        return False
    pair = np.searchsorted(moves, np.minimum(made, reverse))
    meeting = np.sort((pair * 2 * LATEST + tick) * 2 + (made > reverse))
    return not (np.diff(meeting) == 1)[meeting[:-1] % 2 == 0].any()
