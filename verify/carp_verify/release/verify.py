"""The checker of witnesses: that everybody can finish, or that some robots never can.

Granted resources are held, so each robot can drive up to the last of them whatever the others do, and from there it
holds less. So grants let everybody finish if there is room for them, and everybody can finish from where they end.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

from carp_spec import Instance, Plan, RobotId
from carp_verify.release.holding import State, Ways

Places: TypeAlias = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Finish:
    """The robots that move on, one after the other, until all have ended."""

    moves: tuple[RobotId, ...]


@dataclass(frozen=True, slots=True)
class Overfull:
    """More robots would hold a constraint, by its index, than its capacity."""

    constraint: int
    robots: tuple[RobotId, ...]


@dataclass(frozen=True, slots=True)
class Stuck:
    """Robots that never all finish, even without the others, and all places that they can get to together."""

    robots: tuple[RobotId, ...]
    states: frozenset[Places]


Witness: TypeAlias = Finish | Overfull | Stuck


def is_witness(instance: Instance, plans: Sequence[Plan], now: State, granted: State, witness: Witness) -> bool:
    """Whether a witness shows what it claims of robots that are at `now`, and are granted the visits up to `granted`.

    The plans are lawful, and `granted` is no less than `now`.
    """
    ways = Ways.of(instance, plans)
    if isinstance(witness, Overfull):
        return (witness.constraint, witness.robots) in ways.overfull(now, granted)
    if isinstance(witness, Finish):
        return not any(ways.overfull(now, granted)) and _all_end(ways, granted, witness.moves)
    robots = witness.robots
    there = {robot for robot in robots if robot in ways.constraints}
    return len(there) == len(robots) and _never_all_end(ways.only(there), granted, robots, witness.states)


def _all_end(ways: Ways, granted: State, moves: Sequence[RobotId]) -> bool:
    state = dict(granted)
    used = ways.used(state)
    for robot in moves:
        if robot not in state or not ways.is_open(robot, state[robot], used):
            return False
        used.subtract(ways.held(robot, state[robot], state[robot]))
        state[robot] += 1
        used.update(ways.held(robot, state[robot], state[robot]))
    return all(ways.has_ended(robot, place) for robot, place in state.items())


def _never_all_end(ways: Ways, granted: State, robots: Sequence[RobotId], states: Collection[Places]) -> bool:
    """Whether the places hold those granted and all that a move leads to from them, and nowhere all have ended."""
    if tuple(granted[robot] for robot in robots) not in states:
        return False
    for places in states:
        state: Mapping[RobotId, int] = dict(zip(robots, places, strict=True))
        if all(ways.has_ended(robot, place) for robot, place in state.items()):
            return False
        used = ways.used(state)
        for number, robot in enumerate(robots):
            after = (*places[:number], places[number] + 1, *places[number + 1 :])
            if ways.is_open(robot, places[number], used) and after not in states:
                return False
    return True
