"""Encodes an instance as the arrays of a state."""

import math
from functools import cache
from typing import TypeAlias

import numpy as np

from carp_optimized.jit.blocks import BLOCK
from carp_optimized.jit.kinds import Ints, Longs
from carp_optimized.state.arrays import COUNTERS, GROUPED, NEVER, NONE, UNKNOWN, Graph, Records, Robots, State, Stops
from carp_optimized.state.room import (
    all_free,
    no_guides,
    no_records,
    no_search,
    no_stays,
    no_sweep,
    nothing_freed,
    with_labels,
)
from carp_spec import Instance, Robot, Stop

ROOTS = 1024  # squares of small distances, whose terms are looked up
Destination: TypeAlias = tuple[int, int, bool]
Destinations: TypeAlias = dict[Destination, int]
STRIPS = 7  # its square is the number of regions; a number of 64 bits has room for 63


def _edges(lists: list[list[int]]) -> tuple[Ints, Ints]:
    """Lists of neighbours as one array, and where each list begins in it."""
    first = np.zeros(len(lists) + 1, np.int32)
    first[1:] = np.cumsum([len(each) for each in lists])
    return first, np.array([neighbour for each in lists for neighbour in each], np.int32)


def encode_graph(instance: Instance) -> Graph:
    """The resource graph."""
    graph = instance.graph
    forward: list[list[int]] = [[] for _ in graph.resources]
    backward: list[list[int]] = [[] for _ in graph.resources]
    for resource, targets in graph.successors.items():
        source = graph.index[resource]
        for target in targets:
            forward[source].append(graph.index[target])
            backward[graph.index[target]].append(source)
    x = np.array([each.x or 0 for each in graph.resources], np.int64)
    y = np.array([each.y or 0 for each in graph.resources], np.int64)
    groups_first, group = np.zeros(len(graph.resources) + 1, np.int32), np.zeros(0, np.int32)
    if graph.groups:
        groups_first, group = _edges([[*graph.groups_of.get(each.id, ())] for each in graph.resources])
    members_first, member = _edges([[graph.index[each] for each in group.resources] for group in graph.groups])
    capacities = [each.capacity for each in graph.resources] + [each.capacity for each in graph.groups]
    room = np.array([min(each, NEVER) for each in capacities], np.int32)
    capacity = room[: len(graph.resources)].copy()
    capacity[np.diff(groups_first) > 0] = GROUPED
    return Graph(
        *_edges(forward),
        *_edges(backward),
        duration=np.array([each.duration for each in graph.resources], np.int32),
        capacity=capacity,
        x=x,
        y=y,
        region=np.left_shift(np.int64(1), strips(x) * STRIPS + strips(y)),
        groups_first=groups_first,
        group=group,
        members_first=members_first,
        member=member,
        room=room,
    )


def strips(places: Longs) -> Longs:
    """Which of `STRIPS` strips of equal width each place is in."""
    if places.size == 0:
        return places
    first = int(places.min())
    width = (int(places.max()) - first) // STRIPS + 1
    return (places - first) // width


def stops_of(robot: Robot) -> tuple[Stop, ...]:
    """The stops of a robot that has more than a goal alone."""
    return () if robot.has_goal_alone else robot.stops


def encode_stops(instance: Instance, destination: Ints) -> Stops:
    """The stops, without room for labels."""
    stops = [stop for each in instance.robots for stop in stops_of(each)]
    counts = [len(stops_of(each)) for each in instance.robots]
    most = max(counts, default=0)
    return Stops(
        first=np.array([0, *np.cumsum(counts)], np.int32),
        place=np.array([instance.graph.index[stop.resource] for stop in stops], np.int32),
        service=np.array([stop.service for stop in stops], np.int32),
        destination=destination,
        stay=np.array([instance.stay(each.id, each.stops[-1]) for each in instance.robots], np.int32),
        stride=max(most, 1),
        slot=np.zeros(most, np.int32),
        rest=np.zeros(most, np.int64),
        reached=np.zeros(0, np.int64),
        parent=np.zeros(0, np.int32),
        expanded=np.zeros(0, np.int32),
        entered=np.zeros(0, np.int32),
        came=np.zeros(0, np.int32),
        keys=np.zeros(0, np.int64),
        ties=np.zeros(0, np.int64),
        labels=np.zeros(0, np.int32),
    )


def encode_robots(instance: Instance) -> tuple[Robots, Ints, Ints, Ints]:
    """The robots, the goals and paces of their destinations, and the destinations of stops."""
    index = instance.graph.index
    destinations: Destinations = {}
    ends = [destinations_of(instance, each) for each in instance.robots]
    destination = [destinations.setdefault(each[-1], len(destinations)) for each in ends]
    of_stops = [destinations.setdefault(end, len(destinations)) for each in ends for end in each if not end[-1]]
    robots = Robots(
        start=np.array([index[each.start] for each in instance.robots], np.int32),
        goal=np.array([index[each.goal] for each in instance.robots], np.int32),
        release=np.array([each.release for each in instance.robots], np.int32),
        pace=np.array([each.pace for each in instance.robots], np.int32),
        destination=np.array(destination, np.int32),
    )
    goals = np.array([goal for goal, _, _ in destinations], np.int32)
    paces = np.array([pace for _, pace, _ in destinations], np.int32)
    return robots, goals, paces, np.array(of_stops, np.int32)


def write_robot(state: State, instance: Instance, robot: Robot, place: int, destinations: Destinations) -> None:
    """Write a robot over the one at that place, with its stops and its destinations, which have numbers."""
    index, guides, stops = instance.graph.index, state.guides, state.stops
    ends = destinations_of(instance, robot)
    for goal, pace, alone in ends:
        number = destinations[goal, pace, alone]
        guides.goal[number], guides.pace[number] = goal, pace
    values = index[robot.start], index[robot.goal], robot.release, robot.pace, destinations[ends[-1]]
    for array, value in zip(state.robots, values, strict=True):
        array[place] = value
    own = stops_of(robot)
    at, end = _room_for_stops(stops, place, len(own))
    stops.place[at:end] = [index[stop.resource] for stop in own]
    stops.service[at:end] = [stop.service for stop in own]
    stops.destination[at:end] = [destinations[each] for each in ends[: len(own)]]
    last = robot.stops[-1]
    stops.stay[place] = max(robot.pace * instance.graph.resource[last.resource].duration, last.service)


def forget_stops(state: State, place: int) -> None:
    """Leave the robot at that place without stops."""
    _room_for_stops(state.stops, place, 0)


def _room_for_stops(stops: Stops, place: int, count: int) -> tuple[int, int]:
    """Move the stops of later robots so that this one has that many: where they begin and end."""
    used, at, end = int(stops.first[-1]), int(stops.first[place]), int(stops.first[place + 1])
    more = count - (end - at)
    for array in (stops.place, stops.service, stops.destination):
        array[end + more : used + more] = array[end:used].copy()
    stops.first[place + 1 :] += more
    return at, at + count


def destinations_of(instance: Instance, robot: Robot) -> tuple[Destination, ...]:
    """The destinations of a robot, in the order of its stops: resource and pace, and whether of a goal alone.

    The guide of a stop is made to its end, that of a goal alone may not be.
    """
    index = instance.graph.index
    return tuple((index[stop.resource], robot.pace, robot.has_goal_alone) for stop in robot.stops)


def destinations_in_use(state: State) -> Destinations:
    """The numbers of the destinations of all robots."""
    of_stops = state.stops.destination[: state.stops.first[-1]].tolist()
    numbers = {*state.robots.destination.tolist(), *of_stops}
    ends = zip(state.guides.goal[[*numbers]].tolist(), state.guides.pace[[*numbers]].tolist(), numbers, strict=True)
    stopping = {*of_stops}
    return {(goal, pace, number not in stopping): number for goal, pace, number in ends}


def has_room_for_stops(state: State, place: int, robot: Robot) -> bool:
    """Whether the stops of a robot fit in, over those of the robot at that place."""
    stops, own = state.stops, stops_of(robot)
    more = len(own) - int(stops.first[place + 1] - stops.first[place])
    return len(own) <= stops.slot.size and int(stops.first[-1]) + more <= stops.place.size


def with_stops(state: State, robot: Robot) -> State:
    """The state with room for the stops of one more robot, and as many again."""
    stops, own = state.stops, stops_of(robot)
    size, stride = 2 * (stops.place.size + len(own)), max(stops.slot.size, 2 * len(own))
    larger = stops._replace(
        place=_enlarged(stops.place, size),
        service=_enlarged(stops.service, size),
        destination=_enlarged(stops.destination, size),
        stride=stride,
        slot=np.zeros(stride, np.int32),
        rest=np.zeros(stride, np.int64),
    )
    windows, edges, resources = state.windows.start.size, state.graph.target.size, state.graph.duration.size
    guides = state.guides
    if guides.holds.size < guides.goal.size and guides.holds.size < 2 * stride:
        guides = no_guides(resources, guides.goal, guides.pace, has_ranks=state.scale == 0, stops=stride)
    return state._replace(stops=with_labels(larger, windows, edges), guides=guides)


def _enlarged(array: Ints, size: int, value: int = 0) -> Ints:
    return np.concatenate([array, np.full(size - array.size, value, np.int32)])


def with_robots(state: State, size: int, pace: int, more: int) -> tuple[State, int]:
    """The state with room for that many robots, up to that pace, and for `more` destinations than are in use.

    Also returns how many are in use, which have the first numbers. Guides are made again. What queries have read is
    forgotten if their keys change.
    """
    robots, stops, used = state.robots, state.stops, int(state.stops.first[-1])
    numbers = np.concatenate([robots.destination, stops.destination[:used]])
    kept, renumbered = np.unique(numbers, return_inverse=True)
    goals = _enlarged(state.guides.goal[kept], kept.size + more)
    paces = _enlarged(state.guides.pace[kept], kept.size + more)
    places = [_enlarged(each, size) for each in (*robots[:-1], renumbered[: robots.start.size].astype(np.int32))]
    of_stops = stops.destination.copy()
    of_stops[:used] = renumbered[robots.start.size :]
    resources = state.graph.duration.size
    scale = scale_of_tolls(resources, state.longest, np.append(paces, np.int32(pace))) if state.scale else 0
    if scale != state.scale:
        state.records.expansions[:] = UNKNOWN
    larger = state._replace(
        robots=Robots._make(places),
        stops=stops._replace(
            first=_enlarged(stops.first, size + 1, used), stay=_enlarged(stops.stay, size), destination=of_stops
        ),
        guides=no_guides(resources, goals, paces, has_ranks=scale == 0, stops=stops.stride),
        reserved=_enlarged(state.reserved, size, NONE),
        rank=_enlarged(state.rank, size),
        scale=scale,
    )
    return larger, kept.size


def scale_of_tolls(resources: int, longest: int, paces: Ints) -> int:
    """2^32 plus the power of two above all indices; 0 if ticks to the goal times that might not fit into 32 bits."""
    bits = resources.bit_length()
    most = resources * longest * int(paces.max(initial=1))
    return 0 if most >> (32 - bits) else (1 << 32) + (1 << bits)


def has_scale(state: State, pace: int) -> bool:
    """Whether tolls are scaled right for robots of that pace too."""
    return state.scale in (0, scale_of_tolls(state.graph.duration.size, state.longest, np.array([pace], np.int32)))


@cache
def roots_of_small_squares() -> Longs:
    """The terms of `neighbourhood/distance` by the square of the distance."""
    return np.array([math.isqrt(squared << 32) for squared in range(ROOTS)], np.int64)


def split_of_terms(graph: Graph) -> int:
    """By how many bits a term of `neighbourhood/distance` is split so that the sums fit in 64 bits."""
    if graph.x.size == 0:
        return 0
    largest = (int(np.ptp(graph.x)) + int(np.ptp(graph.y))) << 16
    return max(0, largest.bit_length() - 31)


def encode(instance: Instance) -> State:
    """A state in which no plan is reserved."""
    graph = encode_graph(instance)
    robots, goals, paces, of_stops = encode_robots(instance)
    stops = encode_stops(instance, of_stops)
    resources = graph.duration.size
    places = BLOCK * (1 + 2 * graph.room.size)
    visits = 64 * max(64, robots.start.size)
    longest = int(graph.duration.max(initial=1))
    scale = scale_of_tolls(resources, longest, paces)
    return State(
        graph=graph,
        robots=robots,
        stops=with_labels(stops, places, graph.target.size),
        windows=all_free(graph, places),
        stays=no_stays(graph, places),
        sweep=no_sweep(graph),
        guides=no_guides(resources, goals, paces, has_ranks=scale == 0, stops=stops.stride),
        search=no_search(places, graph.target.size),
        records=no_records(max(256, 8 * robots.start.size), visits, visits),
        freed=nothing_freed(resources),
        reserved=np.full(robots.start.size, NONE, np.int32),
        rank=np.zeros(robots.start.size, np.int32),
        counters=np.zeros(COUNTERS, np.int64),
        longest=longest,
        last_alike=bool((graph.duration == longest).all()),
        scale=scale,
        roots=roots_of_small_squares(),
        split=split_of_terms(graph),
        parks=instance.after_goal == "park",
        gap=instance.gap,
    )


def with_room(state: State, places: int, records: Records) -> State:
    """The state with that many places for windows and with these records, and without reservations."""
    return state._replace(
        windows=all_free(state.graph, places),
        stays=no_stays(state.graph, places),
        stops=with_labels(state.stops, places, state.graph.target.size),
        search=no_search(places, state.graph.target.size),
        records=records,
        reserved=np.full(state.reserved.size, NONE, np.int32),
    )


def without_reservations(state: State) -> State:
    """The state on the empty graph; all else is shared."""
    return state._replace(
        windows=all_free(state.graph, BLOCK * (1 + state.graph.duration.size)),
        stays=no_stays(state.graph, BLOCK * (1 + state.graph.room.size)),
        reserved=np.full(state.reserved.size, NONE, np.int32),
    )
