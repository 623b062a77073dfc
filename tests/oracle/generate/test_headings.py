"""Cells split by heading: the moves F, R, C and W of the League of Robot Runners 2023 and 2024, in unit time."""

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carp_spec import Instance, Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Visit, judge
from carproof.engines import engine_named
from carproof.generate import Fleet, Grid, grid_instance, with_headings

SIDE = 3
STEPS = {"E": (1, 0), "S": (0, 1), "W": (-1, 0), "N": (0, -1)}
State = tuple[int, int, str]
"""The cell and the heading."""


def after(state: State, action: str) -> State | None:
    """Where an action leads; `None` outside of the map."""
    x, y, heading = state
    if action in "RC":
        return x, y, "ESWN"["ESWN".index(heading) + (1 if action == "R" else -1) & 3]
    dx, dy = STEPS[heading] if action == "F" else (0, 0)
    return (x + dx, y + dy, heading) if 0 <= x + dx < SIDE and 0 <= y + dy < SIDE else None


states = st.tuples(st.integers(0, SIDE - 1), st.integers(0, SIDE - 1), st.sampled_from("ESWN"))


def walk(start: State, actions: str) -> list[State]:
    """The states at all ticks; a robot waits where an action leads outside."""
    found = [start]
    for action in actions:
        found.append(after(found[-1], action) or found[-1])
    return found


def plan_of(robot: str, states: list[State]) -> Plan:
    """A visit for each state that differs from the one before."""
    begun = [tick for tick, state in enumerate(states) if tick == 0 or state != states[tick - 1]]
    names = [f"{x},{y} {heading}" for x, y, heading in (states[tick] for tick in begun)]
    ends = [*begun[1:], None]
    return Plan(robot, tuple(Visit(*each) for each in zip(names, begun, ends, strict=True)))


ACTIONS = st.text("FRCW", min_size=6, max_size=6)


@given(states, states, ACTIONS, ACTIONS)
def test_robots_that_turn_and_drive_break_no_rule_unless_they_meet_in_a_cell_or_swap(
    one: State, two: State, first: str, second: str
) -> None:
    walks = [walk(one, first), walk(two, second)]
    plans = [plan_of(f"r{number}", each) for number, each in enumerate(walks)]
    graph = with_headings(grid_instance(Grid(SIDE, SIDE))).graph
    robots = [Robot(each.robot, each.visits[0].resource, each.visits[-1].resource) for each in plans]
    instance = Instance(graph, tuple(robots), "park")
    cells = [[state[:2] for state in each] for each in walks]
    meet = any(a == b for a, b in zip(*cells, strict=True))
    swap = any(a == d and b == c and a != b for (a, b), (c, d) in zip(*map(pairwise, cells), strict=True))
    rules = {each.rule for each in judge(instance, Solution.of(instance, plans)).violations}
    assert ("joint/group" in rules) == meet
    assert meet or rules == ({"joint/exchange"} if swap else set())


@given(st.integers(0, 2**20))
def test_a_robot_arrives_as_early_as_actions_bring_it_and_a_tick_more(seed: int) -> None:
    plain = grid_instance(Grid(SIDE, SIDE), Fleet(1, seed))
    (robot,) = with_headings(plain).robots
    found = engine_named("reference").find(with_headings(plain), [], robot.id)
    assert found is not None
    x, y = map(int, str(plain.robots[0].start).split(","))
    reached, ticks = {(x, y, "E")}, 0
    while not any(f"{x},{y}" == robot.goal for x, y, _ in reached):
        reached |= {state for each in reached for action in "FRC" if (state := after(each, action))}
        ticks += 1
    assert found.visits[-1].enter == ticks + 1


@pytest.mark.parametrize("where", [(None, None), (2, 0), (1, 1), (0, 0)])
def test_cells_that_are_not_side_by_side_are_refused(where: tuple[int | None, int | None]) -> None:
    resources = (Resource("a", 1, 1, 0, 0), Resource("b", 1, 1, *where))
    with pytest.raises(Refusal, match="generate/headings"):
        with_headings(Instance(ResourceGraph(resources, (("a", "b"),)), ()))


def test_moves_come_in_the_order_of_the_graph_in_every_process() -> None:
    graph = grid_instance(Grid(width=5, height=5), Fleet(robots=0)).graph
    made = with_headings(Instance(graph, ())).graph.edges[: len(graph.moves)]
    cells = [tuple(graph.index[end.partition(" ")[0]] for end in map(str, move)) for move in made]
    assert cells == sorted(cells)
