"""Random robots: where they start and end, when they are released and how fast they are."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from carp_spec import AfterGoal, Refusal, ResourceId, Robot, Stop
from carp_spec.permutations import shuffle, splitmix64
from carproof.generate.options import JUST_ONE, JUST_ZERO, Distinct, Orders, Range, ends_suffice

PLACES = 2
"""At this many places at least things are picked up: one may be the goal."""


@dataclass(frozen=True, slots=True)
class Fleet:
    """The number of robots, and the values that are drawn for them from the seed.

    `distinct` is whether no two start at the same resource, and whether no two end at the same. With equal seeds, the
    smaller fleet has the first robots of the larger one, if all are released at one tick. By `orders` a robot goes to
    its goal, or picks something up elsewhere first, which takes it `service` ticks.
    """

    robots: int = 100
    seed: int = 0
    after_goal: AfterGoal = "vanish"
    distinct: Distinct = "both"
    release: Range = JUST_ZERO
    pace: Range = JUST_ONE
    orders: Orders = "goals"
    service: Range = JUST_ZERO


def random_robots(
    fleet: Fleet, starts: Sequence[ResourceId], goals: Sequence[ResourceId], picks: Sequence[ResourceId] = ()
) -> tuple[Robot, ...]:
    """Draw the robots r1, r2, ... in the order of their releases; things are picked up at `picks`, or at any goal."""
    stream = splitmix64(fleet.seed)
    start_of = _ends(fleet, starts, stream, "starts")
    goal_of = _ends(fleet, goals, stream, "goals")
    paces = [fleet.pace.draw(stream) for _ in range(fleet.robots)]
    releases = sorted(fleet.release.draw(stream) for _ in range(fleet.robots))
    drawn = zip(start_of, goal_of, releases, paces, strict=True)
    robots = [Robot(f"r{number}", *each) for number, each in enumerate(drawn, start=1)]
    if fleet.orders == "goals":
        return tuple(robots)
    picks = picks or goals
    if len(picks) < PLACES:
        message = f"there must be {PLACES} places to pick things up, and the map has {len(picks)}"
        raise Refusal("option", "$.orders", ends_suffice.id, message)
    return tuple(replace(robot, stops=(_pick(fleet, robot, picks, stream), *robot.stops)) for robot in robots)


def _pick(fleet: Fleet, robot: Robot, picks: Sequence[ResourceId], stream: Iterator[int]) -> Stop:
    """Where a robot picks something up, which is not its goal."""
    elsewhere = [place for place in picks if place != robot.goal]
    return Stop(elsewhere[next(stream) % len(elsewhere)], fleet.service.draw(stream))


def _ends(fleet: Fleet, places: Sequence[ResourceId], stream: Iterator[int], kind: str) -> Sequence[ResourceId]:
    if fleet.distinct not in ("both", kind):
        return [places[next(stream) % len(places)] for _ in range(fleet.robots)]
    if not ends_suffice(len(places), fleet.robots):
        message = f"{fleet.robots} robots need as many distinct {kind}, and the map has {len(places)}"
        raise Refusal("option", "$.robots", ends_suffice.id, message)
    return shuffle(places, stream)[: fleet.robots]
