"""Executors that know nothing of carproof: `python executors.py HOW` speaks the protocol.

`order` keeps the planned order at each resource. `room` lets each robot go on as soon as its next resource has room, so
robots can come to stand face to face. `clock` takes robots to leave at their planned ticks.
"""

import json
import sys
from collections.abc import Callable
from typing import Any

Document = dict[str, Any]
Id = str | int
MayGo = Callable[["Situation", Id], bool]


class Situation:
    """The visits that robots have made by a tick, and the robots that go on at it."""

    def __init__(self, request: Document) -> None:
        self.instance = request["instance"]
        self.plans = {plan["robot"]: plan["visits"] for plan in request["solution"]["plans"]}
        self.done = {plan["robot"]: plan["visits"] for plan in request["trace"]["plans"]}
        self.now = request["trace"]["now"]
        self.going: list[Id] = []

    def leave(self, robot: Id, place: int) -> int | None:
        """The tick at which a robot left a visit of its plan; `None`: it has not."""
        done = self.done[robot]
        if place >= len(done):
            return None
        leaves_now = robot in self.going and place == len(done) - 1
        left: int | None = self.now if leaves_now else done[place][2]
        return left

    def move(self, robot: Id) -> tuple[Id | None, Id]:
        """The resource in which a robot is (`None`: in none), and its next one."""
        place = len(self.done[robot])
        return self.done[robot][-1][0] if place else None, self.plans[robot][place][0]


def in_turn(situation: Situation, robot: Id) -> bool:
    """Whether all have left its next resource that are planned to leave before it comes."""
    source, target = situation.move(robot)
    _, enter, _ = situation.plans[robot][len(situation.done[robot])]
    for other, visits in situation.plans.items():
        for place, (resource, _, planned) in enumerate(visits):
            if resource == target and planned is not None and planned <= enter:
                left = situation.leave(other, place)
                is_opposite = source is not None and [source] == [visit[0] for visit in visits[place + 1 : place + 2]]
                if left is None or left + is_opposite > situation.now:
                    return False
    return True


def has_room(situation: Situation, robot: Id) -> bool:
    """Whether its next resource has room now, and nobody comes from there."""
    source, target = situation.move(robot)
    moves = {other: situation.move(other) for other in situation.going}
    stays = [
        other
        for other, done in situation.done.items()
        if other not in moves and done and done[-1][2] is None and done[-1][0] == target
    ]
    comes = [other for other, (_, to) in moves.items() if to == target]
    nodes = {node["id"]: node for node in situation.instance["graph"]["nodes"]}
    return (target, source) not in moves.values() and len(stays) + len(comes) < nodes[target].get("capacity", 1)


def on_time(situation: Situation, robot: Id) -> bool:
    """Whether the clock shows its planned tick."""
    _, enter, _ = situation.plans[robot][len(situation.done[robot])]
    return bool(enter <= situation.now)


WAYS: dict[str, MayGo] = {"order": in_turn, "room": has_room, "clock": on_time}


def decide(request: Document, may_go: MayGo) -> list[Id]:
    """The robots that go on; a robot may follow another at the same tick."""
    situation = Situation(request)
    waiting = list(request["ready"])
    while (robot := next((each for each in waiting if may_go(situation, each)), None)) is not None:
        waiting.remove(robot)
        situation.going.append(robot)
    return situation.going


def main(may_go: MayGo) -> None:
    """Answer requests until the input ends."""
    for line in sys.stdin:
        request = json.loads(line)
        results: Document = {"start": {"name": "executor", "version": "1", "ops": ["drive"]}, "stop": {}}
        result = results.get(request["op"])
        answer = {"enter": decide(request, may_go)} if result is None else result
        sys.stdout.write(json.dumps({"id": request["id"], "result": answer}) + "\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main(WAYS[sys.argv[1]])
