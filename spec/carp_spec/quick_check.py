"""Whether many plans break no rule, by sorting and comparing whole arrays: ten times as fast as the rules one by one.

It decides only that they break none. Where it is not sure, `check` asks the rules, which find the violations and word
them: of plans with something that no right plan has, and of moves within a group where following is forbidden. Of plans
with stops on the way, the rules `plan/...` are asked one by one.
"""

from collections.abc import Mapping, Sequence
from itertools import chain, repeat
from operator import attrgetter
from typing import TYPE_CHECKING

from carp_spec.model import Group, Instance, Plan, Resource, ResourceGraph, ResourceId
from carp_spec.plan_rules import PLAN_RULES

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt

    Longs = npt.NDArray[np.int64]

MANY = 20_000
"""Visits from which on it is worth to load numpy."""
LATEST = 1 << 30
"""Ticks from here on are left to the rules. So are numbers of resources and edges that are larger."""
LARGEST = 2**63 - 1
"""Of a whole number in an array."""
MOST_WAYS = 3_000_000
"""Ways from areas into areas that are looked at together; more at one tick are left to the rules."""


def is_large(plans: Sequence[Plan]) -> bool:
    """Whether there are so many visits that this is quicker."""
    return sum(len(plan.visits) for plan in plans) >= MANY


def breaks_no_rule(instance: Instance, plans: Sequence[Plan], now: int | None = None) -> bool:
    """Whether it is certain that plans of known robots break no rule `plan/...` or `joint/...`.

    With `now` they are what the robots have done up to that tick, and none of them has left.
    """
    import numpy as np  # noqa: PLC0415 - slow to load

    graph = instance.graph
    robots = [instance.robot[plan.robot] for plan in plans]
    if not plans or not all(plan.visits for plan in plans):
        return False
    with_stops = [plan for plan, robot in zip(plans, robots, strict=True) if now is None and len(robot.stops) > 1]
    if any(True for each in PLAN_RULES for plan in with_stops for _ in each(instance, plan)):
        return False
    index, unknown = dict(graph.index), len(graph.resources)
    numbers = (unknown, len(graph.moves), now or 0, *(each.duration for each in graph.resources))
    of_robots = [(each.release, each.pace, each.stops[-1].service) for each in robots]
    ends = [plan.visits[-1].leave for plan in plans]
    columns = _columns(plans, index, unknown)
    if columns is None or not all(0 <= each < LATEST for each in chain(numbers, *of_robots, filter(None, ends))):
        return False
    place, enter, left = columns
    release, pace, service = np.array(of_robots, np.int64).T
    duration = np.array([each.duration for each in graph.resources], np.int64)
    sizes = np.array([len(plan.visits) for plan in plans])
    last = np.cumsum(sizes) - 1
    first = last - sizes + 1
    before = np.delete(np.arange(place.size), last)
    if now is not None:
        right, end = [None] * len(plans), np.full(last.size, now + 1)
    elif instance.after_goal == "park":
        right, end = [None] * len(plans), np.full(last.size, LATEST)
    else:
        end = enter[last] + np.maximum(duration[place[last]] * pace, service)
        right = end.tolist()
    leave = np.append(enter[1:], 0)
    leave[last] = end
    visit, group = _each_of([graph.groups_of.get(each.id, ()) for each in graph.resources], place)
    return bool(
        ends == right
        and np.array_equal(place[first], [index[each.start] for each in robots])
        and np.array_equal(enter[first], release)
        and (now is not None or np.array_equal(place[last], [index[each.goal] for each in robots]))
        and np.array_equal(left, leave[before])
        and (left - enter[before] >= (duration[place] * np.repeat(pace, sizes))[before]).all()
        and _have_room(graph.resources, place, enter, leave + instance.gap)
        and _have_room(graph.groups, group, enter[visit], (leave + instance.gap)[visit])
        and _moves_do_not_meet(graph, place[before], place[before + 1], left)
    )


def _columns(
    plans: Sequence[Plan], index: Mapping[ResourceId, int], unknown: int
) -> "tuple[Longs, Longs, Longs] | None":
    """The resources and ticks of entry of all visits, and when all but the last of each plan are left.

    `None` if there is an unknown resource, or a tick that no right plan has, or that the arrays do not hold.
    """
    import numpy as np  # noqa: PLC0415 - slow to load

    columns: tuple[list[Longs], list[Longs], list[Longs]] = [], [], []
    try:
        for plan in plans:  # one after the other, as its visits are then in the cache for all three
            visits, size = plan.visits, len(plan.visits)
            places = map(index.get, map(attrgetter("resource"), visits), repeat(unknown))
            columns[0].append(np.fromiter(places, np.int64, size))
            columns[1].append(np.fromiter(map(attrgetter("enter"), visits), np.int64, size))
            columns[2].append(np.fromiter(map(attrgetter("leave"), visits[:-1]), np.int64, size - 1))
    except (OverflowError, TypeError):
        return None
    place, enter, left = map(np.concatenate, columns)
    is_held = all(each.min(initial=0) >= 0 and each.max(initial=0) < LATEST for each in (enter, left))
    return (place, enter, left) if is_held and place.max() < unknown else None


def _have_room(limits: "Sequence[Resource | Group]", place: "Longs", enter: "Longs", leave: "Longs") -> bool:
    """Whether each of these places has room for all stays in it; a place is an index.

    In order of time, stay k begins in a place of capacity c no earlier than the end that comes k - c ends after the
    first: then at most c have begun and not ended.
    """
    import numpy as np  # noqa: PLC0415 - slow to load

    begins, ends = np.sort(place * 2 * LATEST + enter), np.sort(place * 2 * LATEST + leave)
    rooms = [min(each.capacity, place.size) for each in limits]
    capacity = np.array(rooms, np.int64)[begins // (2 * LATEST)]
    later = np.flatnonzero(capacity <= np.arange(place.size))
    earlier = ends[later - capacity[later]]
    is_same = earlier // (2 * LATEST) == begins[later] // (2 * LATEST)
    return bool((earlier <= begins[later])[is_same].all())


def _each_of(values: "Sequence[Sequence[int]]", place: "Longs") -> "tuple[Longs, Longs]":
    """The values of each place, one after the other, and the position of the place that has them."""
    import numpy as np  # noqa: PLC0415 - slow to load

    sizes = np.array([*map(len, values)], np.int64)
    flat = np.fromiter(chain.from_iterable(values), np.int64)
    position = np.repeat(np.arange(place.size), sizes[place])
    number = np.arange(position.size) - (np.cumsum(sizes[place]) - sizes[place])[position]
    return position, flat[(np.cumsum(sizes) - sizes)[place[position]] + number]


def _moves_do_not_meet(graph: ResourceGraph, source: "Longs", target: "Longs", tick: "Longs") -> bool:
    """Whether all are moves of the graph, and no two at a tick lead from areas into each other.

    A way leads from one area into another. Who moves within an area, a group of capacity 1, is alone there if groups
    have room for all, so that nobody moves out of it then: stays last a tick at least.
    """
    import numpy as np  # noqa: PLC0415 - slow to load

    size = len(graph.resources)
    ends = map(dict(graph.index).__getitem__, chain.from_iterable(graph.edges))
    one, other = np.fromiter(ends, np.int64).reshape(-1, 2).T
    moves = np.sort(np.concatenate([one * size + other, *([] if graph.directed else [other * size + one])]))
    made = source * size + target
    if not made.size:
        return True
    if not moves.size or not _are_among(made, moves).all():
        return False
    size += len(graph.groups)
    if size * size * max((int(tick.max()) + 1) * 2, made.size) > LARGEST:
        return False
    if not graph.groups:
        return _ways_do_not_meet(size, source, target, tick)
    areas = [graph.areas_of(each.id) for each in graph.resources]
    sizes = np.array([*map(len, areas)], np.int64)
    in_time = np.argsort(tick, kind="stable")
    begins = np.flatnonzero(np.diff(tick[in_time], prepend=-1))
    ways = np.add.reduceat((sizes[source] * sizes[target])[in_time], begins)
    cuts = begins[1:][np.diff((np.cumsum(ways) - ways) // MOST_WAYS) > 0]
    return bool(ways.max() <= MOST_WAYS) and all(
        _ways_do_not_meet(size, *_ways_of(areas, size, source[part], target[part], tick[part]))
        for part in np.split(in_time, cuts)
    )


def _ways_of(
    areas: Sequence[Sequence[int]], size: int, source: "Longs", target: "Longs", tick: "Longs"
) -> "tuple[Longs, Longs, Longs]":
    """The ways of moves, but for those into areas where the robot is already."""
    import numpy as np  # noqa: PLC0415 - slow to load

    resource, area = _each_of(areas, np.arange(len(areas)))
    inside = np.sort(resource * size + area)
    move, one = _each_of(areas, source)
    way, other = _each_of(areas, target[move])
    move, one = move[way], one[way]
    is_there = _are_among(source[move] * size + other, inside)
    return one[~is_there], other[~is_there], tick[move][~is_there]


def _are_among(keys: "Longs", known: "Longs") -> "npt.NDArray[np.bool_]":
    """Of each key, whether it is one of those known, which are in order and at least one."""
    import numpy as np  # noqa: PLC0415 - slow to load

    return np.equal(known.take(np.searchsorted(known, keys), mode="clip"), keys)


def _ways_do_not_meet(size: int, source: "Longs", target: "Longs", tick: "Longs") -> bool:
    """Whether no two ways at a tick lead from areas, of which there are so many, into each other."""
    import numpy as np  # noqa: PLC0415 - slow to load

    pair = np.minimum(source, target) * size + np.maximum(source, target)
    ways = np.sort((pair * (int(tick.max(initial=0)) + 1) + tick) * 2 + (source > target))
    return not (np.diff(ways) == 1)[ways[:-1] % 2 == 0].any()
