"""Cases of `instance/...`: documents of the right shape whose instance is wrong."""

from collections.abc import Mapping, Sequence
from typing import Any

from tests.vectors.making import EDGE, KNOWN_BUG, Flags, case, instance, parking, robot, row, solution

from carp_spec.vectors import Fields, Vector


def _unplanned(id: str, comment: str, instance: Fields, refused: str = "", rule: str = "", flags: Flags = ()) -> Vector:
    """An instance, judged with a solution that plans none of its robots."""
    robots = [robot["id"] for robot in instance["robots"]]
    answer: Fields = {"refused": f"$.instance.{refused}"} if refused else {"cost": 0, "unplanned": len(robots)}
    violated = [rule] if refused else []
    input = {"solution": solution(robots)}
    return case(id, "check", comment, instance=instance, input=input, violated=violated, answer=answer, flags=flags)


def _nodes(rule: str, *cases: tuple[str, str, list[Fields], str]) -> Sequence[Vector]:
    return [
        _unplanned(id, comment, instance({"nodes": nodes, "edges": []}), refused, rule)
        for id, comment, nodes, refused in cases
    ]


def _edges(id: str, comment: str, edges: str, refused: str = "", directed: bool = False) -> Vector:
    document = {
        "directed": directed,
        "nodes": [{"id": id} for id in "abcd"],
        "edges": [{"source": edge[0], "target": edge[1]} for edge in edges.split()],
    }
    return _unplanned(id, comment, instance(document), refused, "instance/edge")


def _robots(rule: str, id: str, comment: str, *robots: Fields, refused: str = "", flags: Flags = ()) -> Vector:
    return _unplanned(id, comment, instance(row("abc"), *robots), refused, rule, flags)


def _numbers(rule: str, name: str, least: int) -> Sequence[Vector]:
    """Cases of a number of a resource: the least, the default, a large one, and too small ones."""
    return _nodes(
        rule,
        ("least", f"the least {name}", [{"id": "a", name: least}], ""),
        ("default", f"a {name} left out is 1", [{"id": "a"}, {"id": "b", name: 1}], ""),
        ("large", "more than 32 bits hold; nothing may wrap around", [{"id": "a", name: 2**40}], ""),
        ("zero", f"a {name} of 0 makes a resource that nobody can use", [{"id": "a", name: 0}],
        f"graph.nodes[0].{name}"),
        ("negative", "a sign lost or gained", [{"id": "a", name: -1}], f"graph.nodes[0].{name}"),
        ("last-one-wrong", "every resource is looked at", [{"id": "a"}, {"id": "b"}, {"id": "c", name: 0}],
         f"graph.nodes[2].{name}"),
    )  # fmt: skip


def _after_goal(id: str, comment: str, policy: Any, *, right: bool) -> Vector:  # noqa: ANN401 - nonsense too
    rule = "instance/after-goal"
    return case(id, rule, comment, input={"after_goal": policy}, violated=[] if right else [rule])


WALKER = robot("r1", "a", "c")
RESOURCE_IDS = _nodes(
    "instance/resource-id",
    ("number-and-text", '1 and "1" are two ids; a table keyed by text confuses them', [{"id": 1}, {"id": "1"}], ""),
    ("empty-text", "the empty text is an id", [{"id": ""}, {"id": " "}], ""),
    ("negative", "ids are not indices", [{"id": -1}, {"id": 0}, {"id": 7}], ""),
    ("twice", "moves to it would be ambiguous", [{"id": "a"}, {"id": "a"}], "graph.nodes[1].id"),
    ("number-twice", "also among numbers", [{"id": 1}, {"id": "1"}, {"id": 1}], "graph.nodes[2].id"),
    ("twice-far-apart", "not only neighbours in the list", [{"id": "a"}, {"id": "b"}, {"id": "a"}],
    "graph.nodes[2].id"),
)  # fmt: skip
POSITIONS = _nodes(
    "instance/position",
    ("both", "on the plane", [{"id": "a", "x": 0, "y": 0}], ""),
    ("none", "positions are optional", [{"id": "a"}, {"id": "b"}], ""),
    ("mixed", "for each resource on its own", [{"id": "a", "x": -2, "y": 5}, {"id": "b"}], ""),
    ("x-alone", "a place has two coordinates", [{"id": "a", "x": 1}], "graph.nodes[0]"),
    ("y-alone", "a place has two coordinates", [{"id": "a", "y": 1}], "graph.nodes[0]"),
    ("zero-alone", "0 is a coordinate, not its absence", [{"id": "a", "x": 0}], "graph.nodes[0]"),
)
EDGES: Sequence[Vector] = (
    _edges("none", "a graph need not be connected", ""),
    _edges("two-parts", "not even nearly", "ab cd"),
    _edges("both-directions", "in a directed graph two edges make a lane of two ways", "ab ba", directed=True),
    _edges("unknown-target", "a move must lead somewhere", "ab bx", "graph.edges[1].target"),
    _edges("unknown-source", "and come from somewhere", "xa", "graph.edges[0].source"),
    _edges("loop", "waiting is staying, not moving", "ab aa", "graph.edges[1]"),
    _edges("twice", "a second edge would allow nothing more", "ab cd ab", "graph.edges[2]"),
    _edges("reversed", "an undirected edge is both moves already", "ab ba", "graph.edges[1]"),
    _edges("twice-directed", "directed edges are listed once too", "ab ba ba", "graph.edges[2]", directed=True),
)
ROBOT_IDS: Sequence[Vector] = tuple(
    _robots("instance/robot-id", id, comment, *robots, refused=refused)
    for id, comment, robots, refused in (
        ("number-and-text", '1 and "1" are two robots', [robot(1, "a", "c"), robot("1", "c", "a")], ""),
        ("resource-s-id", "robots and resources are named apart", [robot("a", "a", "c")], ""),
        ("no-robots", "an instance without robots", [], ""),
        ("twice", "plans of it would be ambiguous", [WALKER, WALKER], "robots[1].id"),
        ("number-twice", "also among numbers", [robot(1, "a", "c"), robot("1", "a", "c"), robot(1, "b", "c")],
         "robots[2].id"),
        ("twice-far-apart", "not only neighbours", [WALKER, robot("r2", "a", "c"), WALKER], "robots[2].id"),
    )
)  # fmt: skip
ENDPOINTS: Sequence[Vector] = (
    _robots("instance/endpoint", "start-is-goal", "a robot may already be there", robot("r1", "b", "b"),
            flags=KNOWN_BUG),
    _robots("instance/endpoint", "shared", "robots may share starts and goals; they cannot all be planned",
            WALKER, robot("r2", "a", "c")),
    _robots("instance/endpoint", "different", "the common case", WALKER),
    _robots("instance/endpoint", "unknown-start", "a robot is somewhere", robot("r1", "x", "c"),
            refused="robots[0].start"),
    _robots("instance/endpoint", "unknown-goal", "and wants to somewhere", WALKER, robot("r2", "a", "x"),
            refused="robots[1].goal"),
    _robots("instance/endpoint", "empty-goal", "no goal is no request", robot("r1", "a", ""), refused="robots[0].goal"),
)  # fmt: skip
RELEASES: Sequence[Vector] = (
    _robots("instance/release", "zero", "the first tick", robot("r1", "a", "c", release=0), flags=EDGE),
    _robots("instance/release", "default", "a release left out is 0", WALKER),
    _robots("instance/release", "large", "more than 32 bits hold", robot("r1", "a", "c", release=2**40)),
    _robots("instance/release", "minus-one", "time begins at 0", robot("r1", "a", "c", release=-1),
            refused="robots[0].release", flags=EDGE),
    _robots("instance/release", "far-below", "no matter how far", robot("r1", "a", "c", release=-(2**40)),
            refused="robots[0].release"),
    _robots("instance/release", "last-one-wrong", "every robot is looked at", WALKER,
            robot("r2", "a", "c", release=-1), refused="robots[1].release"),
)  # fmt: skip
PACES: Sequence[Vector] = (
    _robots("instance/pace", "one", "the fastest robot", robot("r1", "a", "c", pace=1), flags=EDGE),
    _robots("instance/pace", "default", "a pace left out is 1", WALKER),
    _robots("instance/pace", "slow", "a robot that needs seven times as long", robot("r1", "a", "c", pace=7)),
    _robots("instance/pace", "zero", "it would be everywhere at once", robot("r1", "a", "c", pace=0),
            refused="robots[0].pace", flags=EDGE),
    _robots("instance/pace", "negative", "it would travel in time", robot("r1", "a", "c", pace=-1),
            refused="robots[0].pace"),
    _robots("instance/pace", "last-one-wrong", "every robot is looked at", WALKER,
            robot("r2", "a", "c", pace=0), refused="robots[1].pace"),
)  # fmt: skip
POLICIES: Sequence[Vector] = (
    _after_goal("vanish", "robots leave the system", "vanish", right=True),
    _after_goal("park", "robots stay at their goals", "park", right=True),
    _unplanned("park-in-a-document", "as a document says it", parking(row("abc"), WALKER)),
    _after_goal("stay", "other formats' word for park", "stay", right=False),
    _after_goal("capital", "letters are not folded", "Vanish", right=False),
    _after_goal("null", "there is no default: formats differ too much", None, right=False),
)

CASES: Mapping[str, Sequence[Vector]] = {
    "instance/resource-id": RESOURCE_IDS,
    "instance/capacity": _numbers("instance/capacity", "capacity", 1),
    "instance/duration": _numbers("instance/duration", "duration", 1),
    "instance/position": POSITIONS,
    "instance/edge": EDGES,
    "instance/robot-id": ROBOT_IDS,
    "instance/endpoint": ENDPOINTS,
    "instance/release": RELEASES,
    "instance/pace": PACES,
    "instance/after-goal": POLICIES,
}
