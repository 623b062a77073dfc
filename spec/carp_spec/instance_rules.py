"""The rules of an instance, `instance/...`: each yields its faults with their paths in the instance document."""

from collections.abc import Iterator, Sequence

from carp_spec.model import Group, Instance, Resource, Robot
from carp_spec.rule import DESIGN, MORS, Fault, Found, Rule, fault_rule, is_whole

PAPER = "paper, section II"


def _wrong_ids(path: str, entries: Sequence[Resource | Robot | Group]) -> Found:
    first_at: dict[object, int] = {}
    for position, entry in enumerate(entries):
        here = f"{path}[{position}].id"
        if not (is_whole(entry.id) or isinstance(entry.id, str)):
            yield here, f"the id must be a string or a whole number, not {entry.id!r}"
        elif isinstance(entry.id, str) and not entry.id.isascii() and _has_half_a_character(entry.id):
            yield here, f"the id must be text that UTF-8 can express, not {entry.id!r}"
        elif first_at.setdefault(entry.id, position) < position:
            yield here, f"{entry.id!r} is the id of entry {first_at[entry.id]} too; ids must be unique"


def _has_half_a_character(text: str) -> bool:
    """Whether the text has a surrogate, which no document can hold."""
    return any("\ud800" <= each <= "\udfff" for each in text)


def _wrong_numbers(path: str, entries: Sequence[Resource | Robot | Group], name: str, least: int) -> Found:
    for position, entry in enumerate(entries):
        value = getattr(entry, name)
        if not is_whole(value) or value < least:
            yield f"{path}[{position}].{name}", f"the {name} must be a whole number of at least {least}, not {value!r}"


@fault_rule(
    "instance/resource-id",
    "Resource ids are text that UTF-8 can express, or whole numbers; no two are the same.",
    DESIGN,
)
def resource_ids_are_unique(instance: Instance) -> Found:
    return _wrong_ids("$.graph.nodes", instance.graph.resources)


@fault_rule("instance/capacity", "A resource's capacity is a whole number of at least 1.", f"{PAPER}; {MORS}")
def capacities_are_positive(instance: Instance) -> Found:
    return _wrong_numbers("$.graph.nodes", instance.graph.resources, "capacity", 1)


@fault_rule("instance/duration", "A resource's duration is a whole number of ticks, at least 1.", f"{PAPER}; {MORS}")
def durations_are_positive(instance: Instance) -> Found:
    return _wrong_numbers("$.graph.nodes", instance.graph.resources, "duration", 1)


@fault_rule("instance/position", "A resource's x and y are both whole numbers or both absent.", DESIGN)
def positions_are_whole(instance: Instance) -> Found:
    for position, resource in enumerate(instance.graph.resources):
        x, y = resource.x, resource.y
        if not (is_whole(x) and is_whole(y)) and not (x is None and y is None):
            message = f"x and y must both be whole numbers or both be absent, not {x!r} and {y!r}"
            yield f"$.graph.nodes[{position}]", message


def _edge(position: int) -> str:
    return f"$.graph.edges[{position}]"


@fault_rule(
    "instance/edge",
    "An edge joins two different resources of the graph, and no edge is listed twice "
    "(in an undirected graph, not in the other direction either).",
    DESIGN,
)
def edges_join_resources(instance: Instance) -> Found:
    graph = instance.graph
    first_at: dict[object, int] = {}
    for position, (source, target) in enumerate(graph.edges):
        for name, end in (("source", source), ("target", target)):
            if end not in graph.index:
                yield f"{_edge(position)}.{name}", f"{end!r} must be the id of a resource, and is not"
        if source == target:
            yield _edge(position), f"it must join two different resources, and joins {source!r} to itself"
        edge = (source, target) if graph.directed else frozenset((source, target))
        if first_at.setdefault(edge, position) < position:
            yield _edge(position), f"it must be listed once, and is entry {first_at[edge]} too"


@fault_rule(
    "instance/group",
    "Group ids are text that UTF-8 can express, or whole numbers; no two are the same. A group names at least one "
    "resource, each of the graph and each once; its capacity is a whole number of at least 1.",
    DESIGN,
)
def groups_are_of_resources(instance: Instance) -> Found:
    graph = instance.graph
    yield from _wrong_ids("$.graph.groups", graph.groups)
    yield from _wrong_numbers("$.graph.groups", graph.groups, "capacity", 1)
    for position, group in enumerate(graph.groups):
        path = f"$.graph.groups[{position}].resources"
        if not group.resources:
            yield path, "a group must name at least one resource"
        first_at: dict[object, int] = {}
        for place, resource in enumerate(group.resources):
            if resource not in graph.index:
                yield f"{path}[{place}]", f"{resource!r} must be the id of a resource, and is not"
            elif first_at.setdefault(resource, place) < place:
                yield f"{path}[{place}]", f"{resource!r} must be named once, and is entry {first_at[resource]} too"


@fault_rule(
    "instance/robot-id", "Robot ids are text that UTF-8 can express, or whole numbers; no two are the same.", DESIGN
)
def robot_ids_are_unique(instance: Instance) -> Found:
    return _wrong_ids("$.robots", instance.robots)


@fault_rule(
    "instance/endpoint",
    "A robot's start is a resource of the graph, and so is its goal, where it has one in place of stops.",
    PAPER,
)
def endpoints_are_resources(instance: Instance) -> Found:
    for position, robot in enumerate(instance.robots):
        for name, end in (("start", robot.start), *([("goal", robot.goal)] if robot.has_goal_alone else [])):
            if end not in instance.graph.index:
                message = f"the {name} must be the id of a resource, and {end!r} is not"
                yield f"$.robots[{position}].{name}", message


@fault_rule(
    "instance/stops",
    "A robot has at least one stop. Each names a resource of the graph, other than the stop before it does, and its "
    "service is a whole number of ticks, at least 0.",
    DESIGN,
)
def stops_are_places_to_serve(instance: Instance) -> Found:
    for position, robot in enumerate(instance.robots):
        path = f"$.robots[{position}].stops"
        if not robot.stops:
            yield path, "there must be at least one stop"
        for place, stop in enumerate(() if robot.has_goal_alone else robot.stops):
            if stop.resource not in instance.graph.index:
                message = f"it must be the id of a resource, and {stop.resource!r} is not"
                yield f"{path}[{place}].resource", message
            if not is_whole(stop.service) or stop.service < 0:
                message = f"the service must be a whole number of at least 0, not {stop.service!r}"
                yield f"{path}[{place}].service", message
            if place > 0 and stop.resource == robot.stops[place - 1].resource:
                message = f"it must be at another resource than the stop before it, and both are at {stop.resource!r}"
                yield f"{path}[{place}].resource", message


@fault_rule("instance/release", "A robot's release is a tick: a whole number of at least 0.", DESIGN)
def releases_are_ticks(instance: Instance) -> Found:
    return _wrong_numbers("$.robots", instance.robots, "release", 0)


@fault_rule(
    "instance/pace",
    "A robot's pace is a whole number of at least 1.",
    "paper, section V (heterogeneous robots)",
)
def paces_are_positive(instance: Instance) -> Found:
    return _wrong_numbers("$.robots", instance.robots, "pace", 1)


@fault_rule("instance/after-goal", 'After its goal a robot is to "vanish" or to "park".', DESIGN)
def after_goal_is_known(instance: Instance) -> Found:
    if instance.after_goal not in ("vanish", "park"):
        yield "$.after_goal", f'it must be "vanish" or "park", not {instance.after_goal!r}'


@fault_rule("instance/following", 'Following is "allowed" or "forbidden"; where it is left out, it is allowed.', DESIGN)
def following_is_known(instance: Instance) -> Found:
    if instance.following not in ("allowed", "forbidden"):
        yield "$.following", f'it must be "allowed" or "forbidden", not {instance.following!r}'


ROBOT_RULES: tuple[Rule[[Instance], Iterator[Fault]], ...] = (
    robot_ids_are_unique,
    endpoints_are_resources,
    stops_are_places_to_serve,
    releases_are_ticks,
    paces_are_positive,
)
"""Those about robots, which take no longer on large graphs."""
GRAPH_RULES: tuple[Rule[[Instance], Iterator[Fault]], ...] = (
    resource_ids_are_unique,
    capacities_are_positive,
    durations_are_positive,
    positions_are_whole,
    edges_join_resources,
    groups_are_of_resources,
)
"""Those about the resource graph alone."""
INSTANCE_RULES: tuple[Rule[[Instance], Iterator[Fault]], ...] = (
    *GRAPH_RULES,
    *ROBOT_RULES,
    after_goal_is_known,
    following_is_known,
)


def instance_faults(instance: Instance) -> tuple[Fault, ...]:
    """All faults of the instance, in the order of the rules; a graph that is known to be right is not looked at."""
    rules = INSTANCE_RULES[len(GRAPH_RULES) :] if instance.graph.seen else INSTANCE_RULES
    return tuple(fault for each in rules for fault in each(instance))
