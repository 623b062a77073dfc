"""Tasks of the League are done in its motion: who is in the cell of its task gets the next one of the list."""

from collections import Counter

from carp_experiments.beyond.league_tasks import PLANNERS, do_tasks
from carp_spec import judge
from carproof.formats.movingai import GridMap
from carproof.generate.headings import parts_of

GRID = GridMap(4, 3, ("....", ".@..", "...."))
TASKS = (3, 3, 11, 0, 8, 2, 10, 4, 7, 1) * 9
"""Cells, row by row from 0."""


def test_tasks_are_done_one_after_the_other_in_the_order_of_the_list() -> None:
    for planner in PLANNERS.values():
        found = do_tasks(GRID, (0, 8), TASKS, 40, *planner)
        instance, solution = found.fleet.instance, found.fleet.solution
        assert judge(instance, solution).valid
        assert len(found.tasks) > 6
        given = TASKS[: len(found.tasks) + len(instance.robots)]
        assert not Counter(cell for _, _, cell in found.tasks) - Counter(given)
        for robot, tick, cell in found.tasks:
            plan = solution.plan_of(robot)
            assert plan is not None
            *_, here = (visit.resource for visit in plan.visits if visit.enter <= tick)
            assert here in parts_of(f"{cell % 4},{cell // 4}")


def test_a_robot_that_is_in_the_cell_of_its_task_has_done_it_a_tick_later() -> None:
    assert do_tasks(GRID, (0,), (0, 3), 1, *PLANNERS["CARP"]).tasks == ((0, 1, 0),)
