"""The rules of the neighbourhood planner, the paper's Algorithm 1: each makes one decision, which planners ask."""

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import pairwise
from math import isqrt

from carp_spec.model import Instance, Plan
from carp_spec.permutations import Order, orders
from carp_spec.rule import DESIGN, rule

ALGORITHM = "paper, Algorithm 1"


@rule(
    "neighbourhood/baseline",
    "The first candidate keeps the committed plans and adds the result of a CARP query for the new robot. In paper "
    "mode it is left out, unless the neighbourhood can take in no robot.",
    DESIGN,
)
def baseline_is_tried(baseline: bool, rounds: int) -> bool:
    return baseline or rounds == 0


def _position(instance: Instance, plan: Plan, tick: int) -> tuple[int, int]:
    """The robot's position at a tick."""
    robot = instance.robot[plan.robot]
    entered = [visit.resource for visit in plan.visits if visit.enter <= tick]
    resource = instance.graph.resource[entered[-1] if entered else robot.start]
    return (resource.x or 0, resource.y or 0)


@rule(
    "neighbourhood/distance",
    "The distance of two robots is the mean, over the ticks from the earlier release to the later arrival, both "
    "included, of the distance of their positions; before its release a robot is at its start, after its arrival at "
    "its goal. Each term is floor(2^16 * sqrt(dx^2 + dy^2)), and means are compared as fractions. A resource without "
    "a position stands at (0, 0).",
    f"paper, section III; {DESIGN}",
)
def distance(instance: Instance, one: Plan, other: Plan) -> Fraction:
    first = min(instance.robot[one.robot].release, instance.robot[other.robot].release)
    last = max(one.visits[-1].enter, other.visits[-1].enter)
    changes = {visit.enter for visit in (*one.visits, *other.visits) if first < visit.enter <= last}
    total = 0
    for start, end in pairwise([first, *sorted(changes), last + 1]):
        one_x, one_y = _position(instance, one, start)
        other_x, other_y = _position(instance, other, start)
        squared = (one_x - other_x) ** 2 + (one_y - other_y) ** 2
        total += (end - start) * isqrt(squared << 32)
    return Fraction(total, last + 1 - first)


@rule(
    "neighbourhood/nearest",
    "The robot taken in is the one least distant from a member of the neighbourhood; a tie goes to the earlier in "
    "planning order.",
    f"{ALGORITHM}, line 7; {DESIGN}",
)
def nearest(distances_to_members: Sequence[Sequence[Fraction]]) -> int:
    distances = [min(each) for each in distances_to_members]
    return distances.index(min(distances))


@rule(
    "neighbourhood/replan",
    "The robots behind the one taken out are replanned by CARP in order; those before it keep their plans. If one "
    "finds no plan, it and those behind it have none, the round has no candidate, and the next round replans from "
    "there or behind its own robot, whichever is earlier.",
    f"{ALGORITHM}, line 10; {DESIGN}",
)
def replanned_from(taken: int, planned: int) -> int:
    """The first `planned` robots had a plan before."""
    return min(taken, planned)


@rule(
    "neighbourhood/orders",
    "Every permutation of the neighbourhood, in lexicographic order of the positions in it, is planned by CARP "
    "against the other robots. With a sample size: that many distinct permutations (at most all), drawn by "
    "Fisher-Yates from one SplitMix64 stream per added robot, seeded with the seed plus the robot's index in the "
    "instance, and planned in lexicographic order too.",
    f"{ALGORITHM}, line 11; {DESIGN}",
)
def neighbourhood_orders(size: int, sample: int | None, stream: Iterator[int]) -> Iterator[Order]:
    return orders(size, sample, stream)


@rule(
    "neighbourhood/best",
    "A candidate replaces the best only if its total cost is strictly smaller.",
    f"{ALGORITHM}, line 14",
)
def replaces_best(cost: int, best: int | None) -> bool:
    return best is None or cost < best


@rule(
    "neighbourhood/update",
    "The trajectories for the next distances are the new plans of the robots outside the neighbourhood (in a round "
    "without candidate, of those that got one), and its members' in the round's best permutation. A robot without a "
    "new plan keeps its trajectory.",
    f"paper, section III; {DESIGN}",
)
def next_trajectory(before: Plan, planned: Plan | None) -> Plan:
    return before if planned is None else planned
