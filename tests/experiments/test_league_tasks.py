"""Tasks of the League are done in its motion: who is in the cell of its task gets the next one of the list."""

from carp_experiments.beyond.league_tasks import PLANNERS, do_tasks
from carp_spec import judge
from carproof.formats.movingai import GridMap

GRID = GridMap(4, 3, ("....", ".@..", "...."))
TASKS = (3, 11, 3, 0, 8, 2, 10, 4, 7, 1) * 9
"""Cells, row by row from 0; the third task is where the first robot is when it gets it."""


def test_tasks_are_done_one_after_the_other_in_the_order_of_the_list() -> None:
    for planner in PLANNERS.values():
        found = do_tasks(GRID, (0, 8), TASKS, 40, planner)
        plans = {plan.robot: plan for plan in found.fleet.solution.plans}
        assert judge(found.instance, found.fleet.solution).valid
        assert len(found.tasks) > 6
        assert found.tasks[0] == (0, 3)
        cells = {f"{cell % 4},{cell // 4}" for cell in TASKS}
        for robot, tick in found.tasks:
            places = [visit.resource for visit in plans[robot].visits if visit.enter <= tick]
            assert str(places[-1]).rpartition(" ")[0] in cells
