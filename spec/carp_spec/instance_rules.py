"""The rules of an instance: `instance/...`.

Each predicate takes the instance and yields its faults, each with its path in the instance document.
"""

from collections.abc import Iterable, Iterator, Sequence

from carp_spec.model import Instance
from carp_spec.rule import DESIGN, MORS, Fault, Rule, fault_rule, is_whole

PAPER = "paper, section II"


def _id_faults(path: str, ids: Sequence[object]) -> Iterator[tuple[str, str]]:
    first_at: dict[object, int] = {}
    for position, id in enumerate(ids):
        here = f"{path}[{position}].id"
        if not (is_whole(id) or isinstance(id, str)):
            yield here, f"the id must be a string or a whole number, not {id!r}"
        elif id in first_at:
            yield here, f"{id!r} is the id of entry {first_at[id]} too; ids must be unique"
        else:
            first_at[id] = position


def _number_faults(path: str, name: str, values: Iterable[object], least: int) -> Iterator[tuple[str, str]]:
    for position, value in enumerate(values):
        if not is_whole(value) or value < least:
            message = f"the {name} must be a whole number of at least {least}, not {value!r}"
            yield f"{path}[{position}].{name}", message


@fault_rule("instance/resource-id", "Resource ids are strings or whole numbers, and no two are the same.", DESIGN)
def resource_ids_are_unique(instance: Instance) -> Iterator[tuple[str, str]]:
    ids = [resource.id for resource in instance.graph.resources]
    yield from _id_faults("$.graph.nodes", ids)


@fault_rule("instance/capacity", "A resource's capacity is a whole number of at least 1.", f"{PAPER}; {MORS}")
def capacities_are_positive(instance: Instance) -> Iterator[tuple[str, str]]:
    capacities = (resource.capacity for resource in instance.graph.resources)
    yield from _number_faults("$.graph.nodes", "capacity", capacities, 1)


@fault_rule("instance/duration", "A resource's duration is a whole number of ticks, at least 1.", f"{PAPER}; {MORS}")
def durations_are_positive(instance: Instance) -> Iterator[tuple[str, str]]:
    durations = (resource.duration for resource in instance.graph.resources)
    yield from _number_faults("$.graph.nodes", "duration", durations, 1)


@fault_rule("instance/position", "A resource's x and y are both whole numbers or both absent.", DESIGN)
def positions_are_whole(instance: Instance) -> Iterator[tuple[str, str]]:
    for position, resource in enumerate(instance.graph.resources):
        both_whole = is_whole(resource.x) and is_whole(resource.y)
        both_absent = resource.x is None and resource.y is None
        if not (both_whole or both_absent):
            message = f"x and y must both be whole numbers or both be absent, not {resource.x!r} and {resource.y!r}"
            yield f"$.graph.nodes[{position}]", message


@fault_rule(
    "instance/edge",
    "An edge joins two different resources of the graph, and no edge is listed twice "
    "(in an undirected graph, not in the other direction either).",
    DESIGN,
)
def edges_join_resources(instance: Instance) -> Iterator[tuple[str, str]]:
    graph = instance.graph
    first_at: dict[object, int] = {}
    for position, (source, target) in enumerate(graph.edges):
        path = f"$.graph.edges[{position}]"
        for name, end in (("source", source), ("target", target)):
            if end not in graph.index:
                yield f"{path}.{name}", f"{end!r} must be the id of a resource, and is not"
        if source == target:
            yield path, f"it must join two different resources, and joins {source!r} to itself"
        edge = (source, target) if graph.directed else frozenset((source, target))
        if edge in first_at:
            yield path, f"it must be listed once, and is entry {first_at[edge]} too"
        first_at.setdefault(edge, position)


@fault_rule("instance/robot-id", "Robot ids are strings or whole numbers, and no two are the same.", DESIGN)
def robot_ids_are_unique(instance: Instance) -> Iterator[tuple[str, str]]:
    yield from _id_faults("$.robots", [robot.id for robot in instance.robots])


@fault_rule("instance/endpoint", "A robot's start and goal are resources of the graph.", PAPER)
def endpoints_are_resources(instance: Instance) -> Iterator[tuple[str, str]]:
    for position, robot in enumerate(instance.robots):
        for name, end in (("start", robot.start), ("goal", robot.goal)):
            if end not in instance.graph.index:
                message = f"the {name} must be the id of a resource, and {end!r} is not"
                yield f"$.robots[{position}].{name}", message


@fault_rule("instance/release", "A robot's release is a tick: a whole number of at least 0.", DESIGN)
def releases_are_ticks(instance: Instance) -> Iterator[tuple[str, str]]:
    releases = (robot.release for robot in instance.robots)
    yield from _number_faults("$.robots", "release", releases, 0)


@fault_rule(
    "instance/pace",
    "A robot's pace is a whole number of at least 1.",
    "paper, section V (heterogeneous robots)",
)
def paces_are_positive(instance: Instance) -> Iterator[tuple[str, str]]:
    paces = (robot.pace for robot in instance.robots)
    yield from _number_faults("$.robots", "pace", paces, 1)


@fault_rule("instance/after-goal", 'After its goal a robot is to "vanish" or to "park".', DESIGN)
def after_goal_is_known(instance: Instance) -> Iterator[tuple[str, str]]:
    if instance.after_goal not in ("vanish", "park"):
        message = f'it must be "vanish" or "park", not {instance.after_goal!r}'
        yield "$.after_goal", message


@fault_rule("instance/following", 'Following is "allowed" or "forbidden"; where it is left out, it is allowed.', DESIGN)
def following_is_known(instance: Instance) -> Iterator[tuple[str, str]]:
    if instance.following not in ("allowed", "forbidden"):
        message = f'it must be "allowed" or "forbidden", not {instance.following!r}'
        yield "$.following", message


INSTANCE_RULES: tuple[Rule[[Instance], Iterator[Fault]], ...] = (
    resource_ids_are_unique,
    capacities_are_positive,
    durations_are_positive,
    positions_are_whole,
    edges_join_resources,
    robot_ids_are_unique,
    endpoints_are_resources,
    releases_are_ticks,
    paces_are_positive,
    after_goal_is_known,
    following_is_known,
)


def instance_faults(instance: Instance) -> tuple[Fault, ...]:
    """All faults of the instance, in the order of the rules."""
    return tuple(fault for each in INSTANCE_RULES for fault in each(instance))
