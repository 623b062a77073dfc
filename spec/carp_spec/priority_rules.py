"""The rule of people first: `priority/first`. It speaks of all updates; its predicate takes those to look at."""

from collections.abc import Iterable, Sequence

from carp_spec.check import check, check_update
from carp_spec.model import Instance, Plan, RobotId
from carp_spec.rule import DESIGN, rule


@rule(
    "priority/first",
    "Where robots give way at the tick now, the plans afterwards are a lawful update: they are of the same robots and "
    "the one with priority, break no rule, and keep fleet/history. No lawful update has an earlier arrival of that "
    "robot.",
    DESIGN,
)
def robot_is_first(
    instance: Instance,
    before: Sequence[Plan],
    after: Sequence[Plan],
    robot: RobotId,
    now: int,
    rivals: Iterable[Sequence[Plan]],
) -> bool:
    def is_lawful(update: Sequence[Plan]) -> bool:
        robots = {plan.robot for plan in update}
        is_whole = robots == {robot, *(plan.robot for plan in before)} and len(robots) == len(update)
        return is_whole and not check(instance, update) and not check_update(before, update, now)

    def arrival(update: Sequence[Plan]) -> int:
        return next(plan.visits[-1].enter for plan in update if plan.robot == robot)

    return is_lawful(after) and not any(is_lawful(rival) and arrival(rival) < arrival(after) for rival in rivals)
