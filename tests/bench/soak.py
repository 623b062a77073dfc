"""A soak of `carproof serve` with fleets: `make soak`, or `python -m tests.bench.soak REQUESTS SEED MINUTES`.

Four clients ask servers of their own over pipes: robots come, get further stops, are late, are polished and forgotten;
lines are hostile, and clients vanish in the middle of a line. A client keeps what it was told. It judges each answer:
all plans of its fleet break no rule together, histories are kept, a wrong request is refused by the right rule and
changes nothing, a server whose client has vanished ends, and its memory stays flat. The seed decides all that is asked;
after so many minutes the clients stop, and say how many requests they have asked.
"""

import subprocess
import sys
from collections import Counter
from dataclasses import replace
from pathlib import Path
from time import monotonic, sleep
from typing import TYPE_CHECKING, Any

import msgspec

import carproof
from carp_spec import Instance, Plan, ResourceId, Robot, RobotId, Solution, Stop, Visit
from carp_spec.documents.instances import instance_document, robot_document
from carp_spec.permutations import splitmix64
from carp_spec.plan_rules import has_ended
from carproof.engines import warm
from carproof.generate import Fleet, Grid, grid_instance
from carproof.testing.random_instances import Draw

if TYPE_CHECKING:
    from collections.abc import Callable

CLIENTS = 4
MOST = 12  # robots of a fleet
OFTEN = 500  # requests from one look at the memory to the next
HOSTILE: tuple[tuple[bytes, str], ...] = (
    (b"", "document/json"),
    (b'{"id": 1, "id": 2, "op": "stop"}', "document/json"),
    (b"[" * 2000, "document/json"),
    (b'{"op": "fleet/rest", "fleet": "f"}', "protocol/request"),
    (b'{"id": 1, "op": "fleet/rest", "fleet": "nobody"}', "fleet/name"),
    (b'{"id": 1, "op": "fleet/advance", "fleet": "f", "now": -1}', "request/now"),
    (b'{"id": 1, "op": "fleet/advance", "fleet": "f", "now": 9999999999}', "limit/ticks"),
    (b'{"id": 1, "op": "fleet/polish", "fleet": "f", "iterations": -1}', "polish/options"),
    (b'{"id": 1, "op": "fleet/assign", "fleet": "f", "robot": "nobody", "stops": [{"resource": "a"}]}', "fleet/robot"),
    (
        b'{"id": 1, "op": "fleet/add", "fleet": "f", "robot": {"id": "h", "start": "a", "goal": "b"}}',
        "instance/endpoint",
    ),
)


class Server:
    """A server, and the lines to and from it."""

    def __init__(self) -> None:
        command = [sys.executable, "-m", "carproof", "serve"]
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        self.ask(op="start", version=1)
        children = Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children").read_text().split()
        self.processes = [str(self.process.pid), *children]

    def line(self, line: bytes) -> dict[str, Any]:
        """The answer to a line."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(line + b"\n")
        self.process.stdin.flush()
        answer: dict[str, Any] = msgspec.json.decode(self.process.stdout.readline())
        return answer

    def ask(self, **fields: object) -> dict[str, Any]:
        """The answer to a request."""
        return self.line(msgspec.json.encode({"id": 1, **fields}))

    def memory(self) -> int:
        """Megabytes that the server holds."""
        pages = (Path(f"/proc/{each}/statm").read_text().split()[1] for each in self.processes)
        return sum(map(int, pages)) // 256

    def vanish(self, unfinished: bytes) -> None:
        """Leave in the middle of a line; the server must end, with all its processes."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        self.process.stdin.write(unfinished)
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait(timeout=60)
        deadline = monotonic() + 60
        while any(Path(f"/proc/{each}").exists() for each in self.processes) and monotonic() < deadline:
            sleep(0.01)
        assert not any(Path(f"/proc/{each}").exists() for each in self.processes), "a server outlives its client"


class Client:
    """A client and what it knows of its fleet."""

    def __init__(self, seed: int) -> None:
        self.draw = Draw(splitmix64(seed))
        self.server = Server()
        self.counts: Counter[str] = Counter()
        self.number = 0
        self.open()

    def open(self) -> None:
        """Open a fleet on a grid, without robots."""
        drawn = grid_instance(Grid(map=self.draw.one_of((0, 10))), Fleet(robots=1, seed=self.draw.between(0, 99)))
        self.instance = replace(drawn, robots=(), after_goal="park" if self.draw.happens(2) else "vanish")
        self.plans: dict[RobotId, Plan] = {}
        self.now = 0
        self.told: tuple[RobotId, int, int] = ("", 0, -1)
        self.accept(self.server.ask(op="fleet/open", fleet="f", instance=instance_document(self.instance), m=2))

    def request(self) -> None:
        """Ask something, and judge the answer."""
        kinds: tuple[Callable[[], object], ...] = (self.add, self.add, self.add, self.assign, self.assign)
        kinds = (*kinds, self.advance, self.trace, self.remove, self.polish, self.rest, self.forget)
        kinds = (*kinds, self.hostile, self.past, self.twice, self.wrong)
        if self.draw.happens(1500):
            self.server.vanish(self.draw.one_of((b"", b'{"id": 1, "op": "fleet/ad', b"x")))
            self.counts["vanish"] += 1
            self.server = Server()
            self.open()
        elif self.draw.happens(60):
            assert self.server.ask(op="fleet/close", fleet="f")["result"] == {"fleets": []}
            self.counts["close"] += 1
            self.open()
        else:
            kind = self.draw.one_of(kinds)
            self.counts[kind.__name__] += 1
            kind()

    def accept(self, answer: dict[str, Any], keeps_history: bool = True) -> dict[str, Any]:
        """Take over what an answer tells; all plans must be right together."""
        result: dict[str, Any] = answer["result"]
        self.now = result["now"]
        before = [self.plans[id] for id in self.plans]
        for each in result["plans"]:
            self.plans[each["robot"]] = Plan(each["robot"], tuple(Visit(*visit) for visit in each["visits"]))
        for id in result["left"]:
            assert has_ended(self.plans.pop(id), self.now)
        robots = tuple(robot for robot in self.instance.robots if robot.id in self.plans)
        self.instance = replace(self.instance, robots=robots)
        assert carproof.check(self.instance, Solution.of(self.instance, self.plans.values())).valid, answer
        robot, entered, tick = self.told
        if tick == self.now and robot in self.plans:
            here = next(visit for visit in self.plans[robot].visits if visit.enter == entered)
            assert here.leave is None or here.leave > tick, answer
        if keeps_history:
            assert not carproof.check_update(before, tuple(self.plans.values()), self.now), answer
        return result

    def refuse(self, answer: dict[str, Any], *rules: str) -> None:
        """The answer must be a refusal by one of the rules."""
        assert answer.get("error", {}).get("rule") in rules, answer

    def place(self, other: ResourceId | None = None) -> ResourceId:
        """Any resource but the other."""
        places = [each for each in self.instance.graph.index if each != other]
        return self.draw.one_of(places)

    def add(self) -> None:
        if len(self.plans) >= MOST:
            self.advance()
            return
        self.number += 1
        self.now += self.draw.between(0, 1)
        first = self.place()
        stops = (Stop(first, self.draw.between(0, 3)), Stop(self.place(first)))
        robot = Robot(
            f"r{self.number}", self.place(), release=self.now, stops=stops if self.draw.happens(3) else stops[1:]
        )
        self.instance = replace(self.instance, robots=(*self.instance.robots, robot))
        audit = self.draw.happens(6)
        answer = self.server.ask(op="fleet/add", fleet="f", robot=robot_document(robot), now=self.now, audit=audit)
        result = self.accept(answer)
        assert audit == ("audit" in result)
        assert (robot.id in result["unplanned"]) == (robot.id not in self.plans)

    def assign(self) -> None:
        going = [robot for robot in self.instance.robots if not has_ended(self.plans[robot.id], self.now + 1)]
        if not going:
            self.add()
            return
        robot = self.draw.one_of(going)
        stop = Stop(self.place(robot.goal), self.draw.between(0, 4))
        further = replace(robot, stops=(*robot.stops, stop))
        stops = [{"resource": stop.resource, "service": stop.service}]
        answer = self.server.ask(op="fleet/assign", fleet="f", robot=robot.id, stops=stops, now=self.now)
        if "result" in answer and robot.id not in answer["result"]["unplanned"]:
            robots = (further if each is robot else each for each in self.instance.robots)
            self.instance = replace(self.instance, robots=tuple(robots))
        self.accept(answer)

    def advance(self) -> None:
        result = self.accept(self.server.ask(op="fleet/advance", fleet="f", now=self.now + self.draw.between(0, 9)))
        assert result["plans"] == []

    def trace(self) -> None:
        for plan in self.plans.values():
            done = [visit for visit in plan.visits if visit.enter <= self.now]
            if len(done) > 1 and done[-1].enter == self.now and not has_ended(plan, self.now):
                visits = [[each.resource, each.enter, each.leave] for each in done[:-1]]
                visits[-1][2] = None
                plans = [{"robot": plan.robot, "visits": visits}]
                trace = {"format": "carproof-trace/1", "now": self.now, "plans": plans}
                answer = self.server.ask(op="fleet/trace", fleet="f", trace=trace)
                if "error" in answer:
                    self.refuse(answer, "plan/start")
                else:
                    self.told = (plan.robot, done[-2].enter, self.now)
                    self.accept(answer, keeps_history=False)
                return
        self.advance()

    def remove(self) -> None:
        if self.plans:
            robot = self.draw.one_of([*self.plans])
            answer = self.server.ask(op="fleet/remove", fleet="f", robot=robot, now=self.now)
            answer["result"]["left"].remove(robot)
            del self.plans[robot]
            assert self.accept(answer)["plans"] == []

    def polish(self) -> None:
        self.accept(self.server.ask(op="fleet/polish", fleet="f", iterations=3, seed=self.draw.between(0, 9)))

    def hostile(self) -> None:
        line, rule = self.draw.one_of(HOSTILE)
        self.refuse(self.server.line(line), rule)

    def past(self) -> None:
        if self.now > 0:
            self.refuse(self.server.ask(op="fleet/advance", fleet="f", now=self.now - 1), "fleet/now")

    def twice(self) -> None:
        document = instance_document(self.instance)
        self.refuse(self.server.ask(op="fleet/open", fleet="f", instance=document), "fleet/name")

    def wrong(self) -> None:
        """An order that breaks `instance/stops`, or is for a robot that is not there or has left."""
        robots = [*self.instance.robots]
        if not robots:
            return
        robot, service = self.draw.one_of(robots), self.draw.between(0, 3)
        wrong: tuple[list[ResourceId], ...] = ([robot.goal], ["nowhere"], [self.place(robot.goal)], [])
        places = self.draw.one_of(wrong)
        stops = [
            {"resource": place, "service": service if place in (robot.goal, "nowhere") else -1} for place in places
        ]
        answer = self.server.ask(op="fleet/assign", fleet="f", robot=robot.id, stops=stops, now=self.now)
        may_have_left = ("fleet/robot",) if has_ended(self.plans[robot.id], self.now + 1) else ()
        self.refuse(answer, "instance/stops", *may_have_left)

    def rest(self) -> tuple[Instance, Solution]:
        result = self.server.ask(op="fleet/rest", fleet="f")["result"]
        instance = carproof.read_instance(msgspec.json.encode(result["instance"]))
        solution = carproof.read_solution(msgspec.json.encode(result["solution"]))
        assert {plan.robot for plan in solution.plans} == self.plans.keys()
        assert {plan.robot: plan.visits[-1] for plan in solution.plans if len(plan.visits) > 1}.items() <= {
            plan.robot: plan.visits[-1] for plan in self.plans.values()
        }.items()
        assert carproof.check(instance, solution).valid
        return instance, solution

    def forget(self) -> None:
        before = self.rest()
        answer = self.server.ask(op="fleet/forget", fleet="f")
        robots = []
        for document in answer["result"]["plans"]:
            robot, plan = self.instance.robot[document["robot"]], self.plans[document["robot"]]
            done = plan.visits[: len(plan.visits) - len(document["visits"])]
            here = plan.visits[len(done)]
            stops = robot.stops[carproof.stops_served(robot.stops[:-1], done) :]
            robots.append(replace(robot, start=here.resource, release=here.enter, stops=stops))
            self.plans[robot.id] = replace(plan, visits=plan.visits[len(done) :])
        self.instance = replace(self.instance, robots=tuple(robots))
        plans = {**self.plans}
        assert self.accept(answer)["left"] == []
        assert self.plans == plans
        assert self.rest() == before


def soak(requests: int, seed: int, minutes: int) -> None:
    """Ask until there were so many requests, or so many minutes are over; print what was asked, and the memory."""
    client, memory, end = Client(seed), [0], monotonic() + 60 * minutes
    asked = 0
    while asked < requests and monotonic() < end:
        client.request()
        asked += 1
        if asked % OFTEN == 0:
            memory.append(client.server.memory())
            sys.stdout.write(f"client {seed}: {asked} requests, {memory[-1]} MB\n")
            sys.stdout.flush()
    half = len(memory) // 2
    assert max(memory[half:]) <= 1.1 * max(memory[:half], default=0) + 8 or half < 2, f"memory grows: {memory}"
    assert client.server.ask(op="stop")["result"] == {}
    kinds = ", ".join(f"{name} {count}" for name, count in sorted(client.counts.items()))
    sys.stdout.write(f"client {seed}: {asked} requests ({kinds}), {min(memory[1:] or [0])} to {max(memory)} MB\n")


def main(requests: int, seed: int = 0, minutes: int = 24 * 60) -> int:
    """Let the clients ask that much together, once all is compiled: a server that compiles holds more memory."""
    warm()
    command = [sys.executable, "-m", "tests.bench.soak", "client", str(requests // CLIENTS)]
    clients = [subprocess.Popen([*command, str(CLIENTS * seed + number), str(minutes)]) for number in range(CLIENTS)]
    return max(client.wait() for client in clients)


if __name__ == "__main__":
    if sys.argv[1] == "client":
        soak(*map(int, sys.argv[2:]))
    else:
        sys.exit(main(*map(int, sys.argv[1:])))
