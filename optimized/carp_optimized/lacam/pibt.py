"""One step of all robots by PIBT, priority inheritance with backtracking (Okumura et al. 2022).

Robots choose their next places in an order of priority, and a robot that stands in a chosen place has to choose next.
Where two have to change places in a corridor, one leads the other to a junction (the swap of Okumura 2023).
"""

from typing import NamedTuple

import numpy as np

from carp_optimized.crowds.crowd import GONE, Crowd
from carp_optimized.draws import next_number, swap
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, IntTable, Longs, Numbers
from carp_optimized.lacam.guides import Guides, next_on_guide
from carp_optimized.state.arrays import NONE

NOWHERE = -2
SEVERAL_WAYS = -3


class Step(NamedTuple):
    """The places chosen so far, and the robots that choose: each has to wait for the next one.

    `next[robot]` is `NOWHERE` until the robot has chosen. `stands[r]` and `taker[r]` are the robots that are in r now
    and next. Row k of `wishes` has the `wished[k]` places that the robot `robot[k]` tries, from `foremost[k]` on, of
    which it has tried `tried[k]`.
    """

    next: Ints
    stands: Ints
    taker: Ints
    robot: Ints
    partner: Ints
    foremost: Ints
    tried: Ints
    wished: Ints
    wishes: IntTable
    way: Ints
    way_first: Longs
    way_size: Ints
    stream: Numbers


def no_step(crowd: Crowd, seed: int, guides: Guides | None) -> Step:
    """The arrays of a step."""
    robots, resources = crowd.start.size, crowd.queue.size
    choices = int(np.diff(crowd.first).max(initial=0)) + 1
    return Step(
        next=np.full(robots, NOWHERE, np.int32),
        stands=np.full(resources, NONE, np.int32),
        taker=np.full(resources, NONE, np.int32),
        robot=np.empty(robots + 1, np.int32),
        partner=np.empty(robots + 1, np.int32),
        foremost=np.empty(robots + 1, np.int32),
        tried=np.empty(robots + 1, np.int32),
        wished=np.empty(robots + 1, np.int32),
        wishes=np.empty((robots + 1, choices), np.int32),
        way=np.zeros(1, np.int32) if guides is None else guides.way,
        way_first=np.zeros(robots, np.int64) if guides is None else guides.first,
        way_size=np.zeros(robots, np.int32) if guides is None else guides.size,
        stream=np.array([seed], np.uint64),
    )


@compiled
def begin(step: Step, places: Ints, order: Ints, present: int) -> None:
    """Note where the robots stand; those that are not in the order are gone at the next tick."""
    for robot in range(step.next.size):
        step.next[robot] = GONE
    for k in range(present):
        robot = int(order[k])
        step.next[robot] = NOWHERE
        step.stands[int(places[robot])] = robot


@compiled
def end(step: Step, places: Ints, order: Ints, present: int) -> None:
    """Forget where the robots stand and which places are taken."""
    for k in range(present):
        robot = int(order[k])
        step.stands[int(places[robot])] = NONE
        if step.next[robot] >= 0:
            step.taker[int(step.next[robot])] = NONE


@compiled
def is_open(step: Step, places: Ints, robot: int, place: int) -> bool:
    """Whether the robot can be there next: nobody else has chosen the place, or comes from there to its own."""
    if step.taker[place] != NONE:
        return False
    other = int(step.stands[place])
    return other == NONE or bool(step.next[other] != places[robot])


@compiled
def take(step: Step, robot: int, place: int) -> None:
    """Choose the place for the robot."""
    step.next[robot] = place
    step.taker[place] = robot


@compiled
def choose(crowd: Crowd, step: Step, places: Ints, first: int) -> bool:
    """Choose places for the robot and for those in its way; `False` if it has to stay because they cannot leave."""
    ask(crowd, step, places, 0, first)
    top = 0
    while top >= 0:
        robot = int(step.robot[top])
        place = NONE
        while place == NONE and step.tried[top] < step.wished[top]:
            wish = int(step.wishes[top][int(step.tried[top])])
            step.tried[top] += 1
            if is_open(step, places, robot, wish):
                place = wish
        if place == NONE:
            take(step, robot, int(places[robot]))
            top -= 1
            continue
        take(step, robot, place)
        other = int(step.stands[place])
        if other == NONE or step.next[other] != NOWHERE:
            pull(step, places, top)
            return True
        top += 1
        ask(crowd, step, places, top, other)
    return False


@compiled
def ask(crowd: Crowd, step: Step, places: Ints, top: int, robot: int) -> None:
    """List the robot's wishes: from the nearest to its goal, or from the farthest if it has to let a partner pass."""
    wishes = step.wishes[top]
    count = rank_choices(crowd, step, robot, int(places[robot]), wishes)
    partner = partner_of(crowd, step, places, robot, int(wishes[0]))
    if partner != NONE:
        for k in range(count // 2):
            swap(wishes, k, count - 1 - k)
    step.robot[top] = robot
    step.partner[top] = partner
    step.foremost[top] = wishes[0]
    step.tried[top] = 0
    step.wished[top] = count


@compiled
def rank_choices(crowd: Crowd, step: Step, robot: int, place: int, wishes: Ints) -> int:
    """List where the robot can be next, the nearest to its goal first, equal ones in random order; how many."""
    first = int(crowd.first[place])
    count = int(crowd.first[place + 1]) - first + 1
    for k in range(count - 1):
        wishes[k] = crowd.target[first + k]
    wishes[count - 1] = place
    draws = next_number(step.stream) >> np.uint64(1)
    distance = crowd.distance[robot]
    size = int(step.way_size[robot])
    best = next_on_guide(step.way, int(step.way_first[robot]), size, int(distance[place]), place) if size > 0 else NONE
    for k in range(count):
        left = np.uint64(count - k)
        other = k + int(draws % left)
        draws //= left
        wish = int(wishes[other])
        wishes[other] = wishes[k]
        far = int(distance[wish]) if wish != best else NONE
        at = k
        while at > 0 and wishes[at - 1] != best and distance[int(wishes[at - 1])] > far:
            wishes[at] = wishes[at - 1]
            at -= 1
        wishes[at] = wish
    return count


@compiled
def pull(step: Step, places: Ints, top: int) -> None:
    """Let partners follow into the places that are left for them."""
    for k in range(top, -1, -1):
        robot = int(step.robot[k])
        partner = int(step.partner[k])
        left = int(places[robot])
        if partner == NONE or step.next[partner] != NOWHERE or step.next[robot] != step.foremost[k]:
            continue
        if is_open(step, places, partner, left):
            take(step, partner, left)


@compiled
def partner_of(crowd: Crowd, step: Step, places: Ints, robot: int, wish: int) -> int:
    """The robot with which this one has to change places, and can, by leaving for a junction with it behind."""
    here = int(places[robot])
    if wish == here:
        return NONE
    other = int(step.stands[wish])
    if other != NONE and step.next[other] == NOWHERE and must_swap(crowd, step, robot, other, here, wish):
        return other if can_swap(crowd, step, wish, here) else NONE
    for edge in range(int(crowd.first[here]), int(crowd.first[here + 1])):
        place = int(crowd.target[edge])
        other = int(step.stands[place])
        if other == NONE or place == wish:
            continue
        if must_swap(crowd, step, other, robot, here, wish) and can_swap(crowd, step, wish, here):
            return other
    return NONE


@compiled
def must_swap(crowd: Crowd, step: Step, pusher: int, puller: int, behind: int, ahead: int) -> bool:
    """Whether the pusher, driving the puller ahead of it, gets nowhere before they have changed places."""
    pushed = crowd.distance[pusher]
    pulled = crowd.distance[puller]
    while pushed[ahead] < pushed[behind]:
        way = way_on(crowd, step, behind, ahead)
        if way == SEVERAL_WAYS:
            return False
        if way == NONE:
            break
        behind = ahead
        ahead = way
    is_done_or_on = pushed[behind] == 0 or pushed[ahead] < pushed[behind]
    return bool(pulled[behind] < pulled[ahead] and is_done_or_on)


@compiled
def can_swap(crowd: Crowd, step: Step, behind: int, ahead: int) -> bool:
    """Whether the way on from `ahead` leads to a junction, where two robots can change places."""
    origin = behind
    for _ in range(crowd.queue.size):
        way = way_on(crowd, step, behind, ahead)
        if way < 0 or ahead == origin:
            return way == SEVERAL_WAYS and ahead != origin
        behind = ahead
        ahead = way
    return False


@compiled
def way_on(crowd: Crowd, step: Step, behind: int, ahead: int) -> int:
    """The place next to `ahead`, but for the one behind and dead ends in which a robot is at its goal.

    `NONE` if there is none, and `SEVERAL_WAYS`.
    """
    found = NONE
    for edge in range(int(crowd.first[ahead]), int(crowd.first[ahead + 1])):
        place = int(crowd.target[edge])
        if place == behind:
            continue
        robot = int(step.stands[place])
        is_dead_end = crowd.first[place + 1] - crowd.first[place] == 1
        if robot != NONE and is_dead_end and crowd.goal[robot] == place:
            continue
        if found != NONE:
            return SEVERAL_WAYS
        found = place
    return found
