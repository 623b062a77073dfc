"""Tasks of the League of Robot Runners 2023, planned one by one as robots become free.

Robots drive on in their heading (F), turn (R, C) or wait (W), an action a tick. Each has one task at a time, a cell to
be in; who is there gets the next of the list at that tick. A robot is planned when it gets a task, as `carproof.assign`
does, to the cell in the heading in which it is there first if it is alone. Some planners then polish all plans, once
all tasks of a tick are given.

    python -m carp_experiments.beyond.league_tasks MAP AGENTS TASKS TICKS [PLANNER...]

The files are those of a round in MAPF-Competition/Benchmark-Archive. Printed are a planner's name, the tasks done by
the tick, how often no plan was found, and processor seconds.
"""

import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial
from heapq import heappop, heappush
from pathlib import Path
from time import process_time

from carp_spec import Instance, Neighbourhood, Plan, ResourceGraph, ResourceId, Robot, Stop, judge
from carproof import Fleet
from carproof.formats.movingai import GridMap, movingai_instance, read_map
from carproof.generate.grid import cell_id
from carproof.generate.headings import parts_of, with_headings

ROUNDS = 10
LONGEST_PAUSE = 16
"""Ticks after which a robot without a plan asks again at most; at first it does after one, and then twice as many."""
PLANNERS = {
    "CARP": (Neighbourhood(m=1), 0),
    "CARP, polished": (Neighbourhood(m=1), ROUNDS),
    "Proposed_4": (Neighbourhood(m=4), 0),
}
"""The planner of a new task, and how many rounds of polish it adds at the end of the tick."""


@dataclass(frozen=True, slots=True)
class Done:
    """The tasks done, each with its robot, tick and cell; how often no plan was found; and the fleet at the end."""

    tasks: tuple[tuple[int, int, int], ...]
    missed: int
    fleet: Fleet


def do_tasks(
    grid: GridMap, starts: Sequence[int], tasks: Sequence[int], ticks: int, planner: Neighbourhood, rounds: int = 0
) -> Done:
    """Give tasks to robots until the tick; cells are numbered row by row."""
    names = [cell_id(cell % grid.width, cell // grid.width) for cell in range(grid.width * grid.height)]
    graph = with_headings(movingai_instance(grid, (), "park")).graph
    soonest = cache(partial(first_reached, graph))
    here = {number: parts_of(names[cell])[0] for number, cell in enumerate(starts)}
    robots = tuple(Robot(number, start, start) for number, start in here.items())
    fleet = Fleet(Instance(graph, robots, "park"), planner=planner)
    waiting: Iterator[int] = iter(tasks)
    task: dict[int, int] = {}
    free_at = dict.fromkeys(here, 0)
    pause = dict.fromkeys(here, 1)
    queue = [(0, robot) for robot in here]
    done, missed, planned, tick = [], 0, 0, 0

    def follow(plans: Sequence[Plan]) -> None:
        for plan in plans:
            mover, last = int(plan.robot), plan.visits[-1]
            here[mover], free_at[mover] = str(last.resource), last.enter
            heappush(queue, (last.enter, mover))

    while queue:
        if rounds * planned and queue[0][0] > tick:
            follow(fleet.polish(iterations=rounds * planned).plans)
            planned = 0
        tick, robot = heappop(queue)
        if tick > ticks or free_at[robot] != tick:
            continue  # the robot has another plan by now
        if robot in task and here[robot] in parts_of(names[task[robot]]):
            done.append((robot, tick, task.pop(robot)))
        if robot not in task:
            task[robot] = next(waiting)
        goal = soonest(here[robot], parts_of(names[task[robot]]))
        change = fleet.advance(tick) if goal == here[robot] else fleet.assign(robot, [Stop(goal)], tick)
        if change.unplanned or goal == here[robot]:
            missed += bool(change.unplanned)
            free_at[robot] = tick + pause[robot]
            heappush(queue, (free_at[robot], robot))
        pause[robot] = min(2 * pause[robot], LONGEST_PAUSE) if change.unplanned else 1
        planned += bool(change.plans)
        follow(change.plans)
    return Done(tuple(done), missed, fleet)


def first_reached(graph: ResourceGraph, source: ResourceId, goals: Sequence[str]) -> str:
    """The one of the goals, all in one cell, that a robot alone reaches first from the source, by A*."""
    goal = graph.resource[goals[0]]

    def cells_from(resource: ResourceId) -> int:
        here = graph.resource[resource]
        return abs(int(here.x or 0) - int(goal.x or 0)) + abs(int(here.y or 0) - int(goal.y or 0))

    seen: set[ResourceId] = set()
    queue = [(cells_from(source), 0, str(source))]
    while queue:
        _, before, resource = heappop(queue)
        if resource in goals:
            return resource
        if resource not in seen:
            seen.add(resource)
            ticks = 1 - before  # the most first among equals
            for each in graph.successors[resource]:
                if each not in seen:
                    heappush(queue, (ticks + cells_from(each), -ticks, str(each)))
    raise ValueError(f"no way leads from {source} to {goals}")


def _numbers(file: str) -> list[int]:
    """The numbers of a file but for the first, which says how many there are."""
    return [*map(int, Path(file).read_text().split())][1:]


if __name__ == "__main__":
    map_file, agents, tasks_file, until, *names = sys.argv[1:]
    given = read_map(Path(map_file).read_bytes(), map_file), _numbers(agents), _numbers(tasks_file), int(until)
    for name in names or PLANNERS:
        began = process_time()
        found = do_tasks(*given, *PLANNERS[name])
        seconds = process_time() - began
        verdict = judge(found.fleet.instance, found.fleet.solution)
        if not verdict.valid:
            raise AssertionError(verdict.violations[0])
        print(name, len(found.tasks), found.missed, f"{seconds:.1f}", flush=True)  # noqa: T201 - the table
