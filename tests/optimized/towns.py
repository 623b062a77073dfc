"""Small fleets in which a robot is taken out, and one behind it has to be asked again, or may not be.

Resources are letters, edges pairs of them. No resource has a position, so all robots are equally near, and the first in
planning order is taken out. The robot added last has nothing to do with the others, unless a town names it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from carp_spec import AfterGoal, Instance, Resource, ResourceGraph, Robot


@dataclass(frozen=True, slots=True)
class Town:
    """Robots, each with start, goal, release and pace; durations that are not 1."""

    edges: str
    robots: Sequence[tuple[str, str, int, int]]
    durations: Mapping[str, int] = field(default_factory=dict)
    after_goal: AfterGoal = "vanish"
    now: int = 0
    m: int = 2
    is_directed: bool = False
    added: tuple[str, str, int, int] | None = None
    baseline: bool = False

    @property
    def instance(self) -> Instance:
        """The robots have numbers in the order of their planning; the last one stands on `z`, unless it is named."""
        edges = tuple((pair[0], pair[1]) for pair in self.edges.split())
        names = sorted({name for edge in edges for name in edge} | {"z"})
        cells = tuple(Resource(name, duration=self.durations.get(name, 1)) for name in names)
        robots = [
            Robot(number, *each) for number, each in enumerate((*self.robots, self.added or ("z", "z", self.now, 1)))
        ]
        return Instance(ResourceGraph(cells, edges, self.is_directed), tuple(robots), self.after_goal)


TOWNS = {
    # 1 goes around the stay of 0 in t, that begins only when it is nearly through with it: pace times duration counts
    "a slow robot": Town(
        "bt at tg au uv vg",
        [("b", "t", 13, 1), ("a", "g", 0, 3)],
        durations={"t": 4, "u": 4},
    ),
    # 0 is gone, but the plan of 1 has ended, which is no reason not to ask 2
    "one behind a plan that has ended": Town(
        "bt at tg au uv vg xy",
        [("b", "t", 13, 1), ("y", "y", 0, 1), ("a", "g", 0, 3)],
        durations={"t": 4, "u": 4},
        now=1,
    ),
    # when 0 is gone, 1 goes straight through t, where 2 is to begin, so that 2 has no plan until 1 is gone too; 3 keeps
    # its plan, which has ended
    "one behind without a plan": Town(
        "bt at tg au uv vg te xy",
        [("b", "t", 13, 1), ("a", "g", 0, 3), ("t", "e", 10, 1), ("y", "y", 0, 1)],
        durations={"t": 4, "u": 4},
        now=1,
        m=3,
    ),
    # when 0 is gone, 1 goes straight to t, from where 2 comes at the same tick
    "one behind that would be passed through": Town(
        "at tb tg tw au uv vg",
        [("b", "t", 2, 1), ("a", "g", 2, 1), ("t", "a", 0, 1)],
        durations={"t": 3, "u": 3},
    ),
    # 3 may go by i or by j, where 1 and 2 keep it from going on, and turns to c at tick 3; from i it would meet 0, and
    # without 0 it comes from i, whose index is smaller, with the key that it had from j, the largest until its goal
    "a way that is as good": Town(
        "si sj ic jc iq jw qg wg cu ug",
        [("c", "i", 2, 1), ("q", "q", 0, 20), ("w", "w", 0, 20), ("s", "g", 1, 1)],
    ),
    # 2 has its goal under it, makes room for 0, and comes back as late as it can go where 1 was
    "one that need not make room": Town(
        "gn ng nm bg ge bf fh he",
        [("b", "e", 9, 1), ("n", "m", 0, 10), ("g", "g", 0, 1)],
        after_goal="park",
        is_directed=True,
    ),
    # when 0 is gone, 1 goes straight through t, where 2 was
    "one behind in the way": Town(
        "bt at tg au uv vg ct te",
        [("b", "t", 13, 1), ("a", "g", 0, 3), ("c", "e", 0, 1)],
        durations={"t": 4, "u": 4},
    ),
    # when 0 is gone, 1 leaves b for c at once, and still comes to b as 2 could go the other way
    "one behind that would be met": Town(
        "ab bc bd ec xy",
        [("e", "c", 2, 1), ("a", "c", 0, 1), ("b", "a", 0, 1), ("x", "y", 0, 1)],
        durations={"c": 4},
    ),
    # when 0 is gone, 1 parks in g a tick earlier, at which 2 was passing
    "one behind who passes where another parks": Town(
        "ab eb bf bg cg gh ci ij jh",
        [("e", "f", 0, 1), ("a", "g", 0, 1), ("c", "h", 1, 1)],
        after_goal="park",
    ),
    # the robot added costs more than the others together, and 0 gains in the last round by letting 1 pass
    "a long way beside short ones": Town(
        "at tb ct td no",
        [("a", "b", 0, 5), ("c", "d", 5, 1)],
        durations={"n": 20},
        added=("n", "o", 0, 1),
        baseline=True,
    ),
    # 1 is in the way of 0 in t, and of 2 in u; when 1 is gone too, 2 passes s at once, where 3 is to begin, so that 3
    # has no plan until 2 is gone; then 0 can go straight through t, though 2 has never been there
    "two that leave, and one without a plan between": Town(
        "at tb ct tu ud eu us sf sg",
        [("a", "b", 4, 1), ("c", "d", 0, 4), ("e", "f", 7, 1)],
        m=4,
        is_directed=True,
        added=("s", "g", 9, 1),
    ),
}
