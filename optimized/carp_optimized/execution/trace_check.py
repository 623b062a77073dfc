"""Whether a trace follows a solution, on arrays: a quick yes in place of `carp_spec.execution.execution_rules`.

It shares nothing with the retiming that relies on it. Where it finds a breach, the law decides and names it.
"""

from collections.abc import Sequence

import numpy as np

from carp_optimized.jit.kinds import Flags, Longs
from carp_spec import Instance, Plan, Solution
from carp_spec.execution.traces import Trace
from carp_spec.limits import goals_stand_alone
from carp_spec.plan_rules import least_stays

NEVER = 2**40
"""Beyond all ticks that are looked at here."""
WIDE = 2 * NEVER


def follows(instance: Instance, solution: Solution, trace: Trace) -> bool:
    """Whether a trace keeps `trace/...` and `execution/...`; false too where ticks are too large, and with groups."""
    if instance.graph.groups:
        return False
    planned = {plan.robot: number for number, plan in enumerate(solution.plans)}
    if len(trace.plans) != len(planned) or {plan.robot for plan in trace.plans} != planned.keys():
        return False
    done = sorted(trace.plans, key=lambda plan: planned[plan.robot])
    if not all(map(is_prefix, done, solution.plans)):
        return False
    try:
        return _keeps_ticks(instance, solution.plans, done, trace.now)
    except OverflowError:
        return False


def is_prefix(done: Plan, plan: Plan) -> bool:
    """Whether a robot has visited the first resources of its plan."""
    return [visit.resource for visit in done.visits] == [visit.resource for visit in plan.visits[: len(done.visits)]]


def _keeps_ticks(instance: Instance, plans: Sequence[Plan], done: Sequence[Plan], now: int) -> bool:
    """The rules about ticks, where each robot has visited the first resources of its plan."""
    visits = [visit for plan in plans for visit in plan.visits]
    made = [visit for plan in done for visit in plan.visits]
    enter = np.array([visit.enter for visit in visits], np.int64)
    leave = np.array([NEVER if visit.leave is None else visit.leave for visit in visits], np.int64)
    lengths = np.array([len(plan.visits) for plan in plans], np.int64)
    counts = np.array([len(plan.visits) for plan in done], np.int64)
    place = np.arange(enter.size) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    is_made = place < np.repeat(counts, lengths)
    entered, left = np.full(enter.size, NEVER), np.full(enter.size, NEVER)
    entered[is_made] = np.array([visit.enter for visit in made], np.int64)
    left[is_made] = np.array([NEVER if visit.leave is None else visit.leave for visit in made], np.int64)
    if max(map(_largest, (enter, leave, entered, left))) > NEVER or now >= NEVER:
        return False
    release = np.array([instance.robot[plan.robot].release for plan in plans], np.int64)
    pace = np.array([instance.robot[plan.robot].pace for plan in plans], np.int64)
    index = instance.graph.index
    resource = np.array([index[visit.resource] for visit in visits], np.int64)
    duration = np.array([each.duration for each in instance.graph.resources], np.int64)[resource]
    least = np.repeat(pace, lengths) * duration
    if not goals_stand_alone(instance):
        least = np.array([ticks for plan in plans for ticks in least_stays(instance, plan)], np.int64)
    is_left, is_first = is_made & (left < NEVER), is_made & (place == 0)
    follows_on = np.flatnonzero(is_made & (place > 0))
    is_last = is_made & (place == np.repeat(counts, lengths) - 1)
    stays = np.repeat((counts < lengths) | (instance.after_goal == "park"), lengths)
    wrong = (
        is_first & (entered < np.repeat(release, lengths)),
        entered[follows_on] != left[follows_on - 1],
        is_made & (entered > now),
        is_left & ((left < entered) | (left > now)),
        is_last & stays & is_left,
        is_left & (left - entered < least),
    )
    if any(each.any() for each in wrong):
        return False
    source, target = np.append(-1, resource[:-1]), np.append(resource[1:], -1)
    source[place == 0] = -1
    target[place == np.repeat(lengths, lengths) - 1] = -1
    leaves, turns, comes = leave < NEVER, (leave < NEVER) & (target >= 0), is_made & (source >= 0)
    sides = duration.size + len(index) + 1
    return _in_order(
        (resource[leaves], leave[leaves], left[leaves]),
        (resource[is_made], enter[is_made], entered[is_made]),
        instance.gap,
    ) and _in_order(
        (resource[turns] * sides + target[turns], leave[turns], left[turns]),
        (resource[comes] * sides + source[comes], enter[comes], entered[comes]),
        1,
    )


def _largest(ticks: Longs) -> int:
    return int(np.abs(ticks).max(initial=0))


def _in_order(leaving: tuple[Longs, Longs, Longs], entering: tuple[Longs, Longs, Longs], gap: int) -> bool:
    """Whether nobody entered less than `gap` ticks after one of its group left who was planned to be that far ahead.

    Both have a group, the planned tick, and the tick at which it happened.
    """
    _, groups = np.unique(np.concatenate([leaving[0], entering[0]]), return_inverse=True)
    groups = groups.astype(np.int64) * WIDE
    before, after = groups[: leaving[0].size], groups[leaving[0].size :]
    if not before.size:
        return True
    ranked = np.lexsort((leaving[1], before))
    latest = np.maximum.accumulate(before[ranked] + leaving[2][ranked])
    place = np.searchsorted(before[ranked] + leaving[1][ranked] + gap, after + entering[1], side="right") - 1
    is_behind: Flags = (place >= 0) & (before[ranked][place] == after)
    return not (is_behind & (latest[place] - after + gap > entering[2])).any()
