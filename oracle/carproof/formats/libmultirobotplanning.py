"""libMultiRobotPlanning's schedules in YAML: `schedule:`, and below it for each agent a list of x, y and t.

x is the column and y the row. An agent is the robot of that id or, for `agent0`, `agent1` and so on, the instance's
robot of that number, counted from 0; an agent that is not listed, or whose list is empty, is unplanned. Ticks rise;
between two ticks the robot waits in the cell of the first. Other fields than `schedule` are not read.
Semantics: `walks`.
"""

import re
from collections.abc import Iterator
from typing import Any

from carp_spec import Instance, Refusal, RobotId, Solution, total_cost
from carproof.formats.adapter import Adapter
from carproof.formats.walks import Walk, last_arrival, solution_of_walks, tick_by_tick, walks_of_solution
from carproof.input_rules import Code

_LOOKS = re.compile(r"^schedule[ \t]*:", re.MULTILINE)
_AGENT = re.compile(r"agent(\d{1,9})")
_NUMBER = re.compile(r"-?\d{1,9}")
_FIELDS = ("x", "y", "t")


RIGHT_SCHEDULE = Code(
    "adapter/libmultirobotplanning",
    "The file is a YAML mapping whose field schedule maps each agent to a list; each entry has x, y and t, whole "
    "numbers, and the t rise. An agent is a robot of the instance, and has one list; an empty one is no plan.",
    "output of libMultiRobotPlanning",
)


class _Schedule:
    """Reads the file event by event, so memory and depth are bounded by the length of the file."""

    def __init__(self, text: str, instance: Instance, file: str) -> None:
        self.instance = instance
        self.file = file
        self.line = 1
        self.events = self._events(text)

    def _events(self, text: str) -> Iterator[Any]:
        import yaml  # noqa: PLC0415 - loaded only where used

        try:
            for event in yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
                self.line = event.start_mark.line + 1 if event.start_mark else self.line
                yield event
        except yaml.YAMLError as error:
            mark = getattr(error, "problem_mark", None)
            self.line = self.line if mark is None else mark.line + 1
            problem = getattr(error, "problem", None) or getattr(error, "reason", "it cannot be read")
            raise self.refuse(f"it must be YAML: {problem}") from error

    def refuse(self, message: str) -> Refusal:
        return Refusal("document", f"{self.file}:{self.line}", RIGHT_SCHEDULE.id, message)

    def next(self, *kinds: str, right: str) -> Any:  # noqa: ANN401 - the YAML library has no types
        """The next event, which must be of one of the kinds."""
        event = next(self.events, None)
        kind = type(event).__name__.removesuffix("Event")
        if kind not in kinds:
            raise self.refuse(f"there must be {right}")
        return event, kind

    def fields(self) -> Iterator[str]:
        """The names of the fields of a mapping that has begun; the caller takes each value before it asks for more."""
        while True:
            event, kind = self.next("Scalar", "MappingEnd", right="a name")
            if kind == "MappingEnd":
                return
            yield event.value

    def skip(self) -> None:
        """Pass over a value, however deep."""
        depth = 0
        while True:
            kind = type(next(self.events, None)).__name__
            depth += kind.endswith("StartEvent") - kind.endswith("EndEvent")
            if depth == 0:
                return

    def walks(self) -> dict[RobotId, Walk]:
        """The walk of each robot that has one."""
        self.next("StreamStart", right="a stream")
        self.next("DocumentStart", right="a field schedule")
        self.next("MappingStart", right="a mapping with a field schedule")
        walks: dict[RobotId, Walk] | None = None
        for name in self.fields():
            if name != "schedule":
                self.skip()
            elif walks is not None:
                raise self.refuse("there must be one field schedule, and there is a second")
            else:
                walks = self.agents()
        if walks is None:
            raise self.refuse("there must be a field schedule")
        return {robot: walk for robot, walk in walks.items() if walk}

    def agents(self) -> dict[RobotId, Walk]:
        self.next("MappingStart", right="a mapping of agents to lists")
        walks: dict[RobotId, Walk] = {}
        for name in self.fields():
            robot = self.robot(name)
            if robot in walks:
                raise self.refuse(f"agent {name} must have one list, and has a second")
            walks[robot] = self.entries()
        return walks

    def robot(self, name: str) -> RobotId:
        """The robot that the agent is."""
        called = [id for id in self.instance.robot if str(id) == name]
        numbered = _AGENT.fullmatch(name)
        if not called and numbered and int(numbered[1]) < len(self.instance.robots):
            called = [self.instance.robots[int(numbered[1])].id]
        if len(called) != 1:
            raise self.refuse(f"the agent must be a robot of the instance, and {name!r} is not one")
        return called[0]

    def entries(self) -> Walk:
        walk: list[tuple[tuple[int, int], int]] = []
        self.next("SequenceStart", right="a list of entries with x, y and t")
        while self.next("MappingStart", "SequenceEnd", right="an entry with x, y and t")[1] == "MappingStart":
            values = self.entry()
            if walk and values["t"] <= walk[-1][1]:
                raise self.refuse(f"the t must be larger than {walk[-1][1]}, the one before, and is {values['t']}")
            walk.append(((values["x"], values["y"]), values["t"]))
        return walk

    def entry(self) -> dict[str, int]:
        values: dict[str, int] = {}
        for name in self.fields():
            number, _ = self.next("Scalar", right="a whole number")
            if name not in _FIELDS or name in values or _NUMBER.fullmatch(number.value) is None:
                raise self.refuse("an entry must have x, y and t once each, whole numbers of at most nine digits")
            values[name] = int(number.value)
        if len(values) != len(_FIELDS):
            raise self.refuse("an entry must have x, y and t")
        return values


def read(text: str, instance: Instance, file: str) -> Solution:
    """Read a solution."""
    return solution_of_walks(instance, _Schedule(text, instance, file).walks())


def write(instance: Instance, solution: Solution) -> str:
    """Write a solution; agents are numbered as the instance's robots are."""
    cells = tick_by_tick(walks_of_solution(instance, solution, partial=True))
    makespan = last_arrival(cells)
    cost = total_cost(instance, solution.plans)
    lines = ["statistics:", f"  cost: {cost}", f"  makespan: {makespan}", "schedule:" if cells else "schedule: {}"]
    for number, robot in enumerate(instance.robot):
        if robot in cells:
            lines.append(f"  agent{number}:")
            for tick, (x, y) in enumerate(cells[robot]):
                lines += [f"    - x: {x}", f"      y: {y}", f"      t: {tick}"]
    return "\n".join(lines) + "\n"


ADAPTER = Adapter(
    "libmultirobotplanning",
    "YAML with a schedule of x, y and t for each agent",
    lambda text: "schedule" in text and _LOOKS.search(text) is not None,
    read,
    write,
    "agent",
)
