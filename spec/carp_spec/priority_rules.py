"""The rule of people first: `priority/first`. It is about all updates; its predicate takes those to compare with."""

from collections.abc import Iterable, Sequence

from carp_spec.check import check, check_update
from carp_spec.model import Instance, Plan, RobotId
from carp_spec.rule import DESIGN, rule


@rule(
    "priority/first",
    "Where the others give way to a robot at the tick now, the result is a lawful update of the plans: it has one "
    "plan for that robot and for each robot that had one, breaks no rule, and keeps fleet/history. In no lawful "
    "update does that robot arrive earlier.",
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
