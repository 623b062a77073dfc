"""Paths agent by agent: lines `Agent 0: (a,b)->(a,b)->`, one position a tick, agents numbered from 0.

CBSH2, EECBS, PBS, MAPF-LNS and related planners write (row,column); others write (x,y). There is an adapter for each,
and the robots' starts distinguish them. Agent k is the instance's k-th robot, and an agent without a line is unplanned.
Semantics: `walks`.
"""

import re

from carp_spec import Instance, RobotId, Solution
from carproof.formats.adapter import Adapter
from carproof.formats.walks import Cell, Walk, solution_of_walks, tick_by_tick, walks_of_solution
from carproof.input_rules import Code

_LOOKS = re.compile(r"\s*Agent[ \t]*\d+[ \t]*:")
_LINE = re.compile(r"Agent(\d{1,9}):((?:\(-?\d{1,9},-?\d{1,9}\)(?:->)?)+)")
_CELL = re.compile(r"\((-?\d+),(-?\d+)\)")


RIGHT_PATHS = Code(
    "adapter/agent-paths",
    "Each line is Agent, the number of a robot of the instance counted from 0, a colon, and the robot's positions "
    "tick by tick, joined by arrows; each agent has one line at most.",
    "output of EECBS and its kin",
)


def _pairs(text: str, robots: int, file: str) -> dict[int, list[Cell]]:
    agents: dict[int, list[Cell]] = {}
    for number, line in enumerate(text.split("\n"), start=1):
        packed, where = re.sub(r"[ \t\r]", "", line), f"{file}:{number}"
        if not packed:
            continue
        parts = _LINE.fullmatch(packed)
        if parts is None:
            message = "the line must be like Agent 0: (1,2)->(1,3)-> with numbers of at most nine digits"
            raise RIGHT_PATHS.refuse(where, message)
        agent = int(parts[1])
        if agent >= robots:
            raise RIGHT_PATHS.refuse(where, f"the agent must be one of {robots}, counted from 0, and is {agent}")
        if agent in agents:
            raise RIGHT_PATHS.refuse(where, f"agent {agent} must have one line, and has a second")
        agents[agent] = [(int(one), int(two)) for one, two in _CELL.findall(parts[2])]
    return agents


def _adapter(name: str, description: str, *, row_first: bool) -> Adapter:
    def read(text: str, instance: Instance, file: str) -> Solution:
        walks: dict[RobotId, Walk] = {}
        for agent, pairs in _pairs(text, len(instance.robots), file).items():
            cells = [(two, one) if row_first else (one, two) for one, two in pairs]
            walks[instance.robots[agent].id] = [(cell, tick) for tick, cell in enumerate(cells)]
        return solution_of_walks(instance, walks)

    def write(instance: Instance, solution: Solution) -> str:
        cells = tick_by_tick(walks_of_solution(instance, solution, partial=True))
        lines = []
        for agent, robot in enumerate(instance.robot):
            if robot in cells:
                pairs = [(y, x) if row_first else (x, y) for x, y in cells[robot]]
                lines.append(f"Agent {agent}: " + "".join(f"({one},{two})->" for one, two in pairs) + "\n")
        return "".join(lines)

    return Adapter(name, description, lambda text: _LOOKS.match(text) is not None, read, write, "Agent ")


ROW_COLUMN = _adapter(
    "paths-row-column",
    "a line Agent 0: (row,column)->(row,column)-> for each agent, as EECBS, PBS and MAPF-LNS write it",
    row_first=True,
)
X_Y = _adapter("paths-x-y", "the same with (x,y)", row_first=False)
