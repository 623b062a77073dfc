"""The answers known in a round, by the plans against which they were asked."""

from carp_optimized.jit.compiling import compiled
from carp_optimized.state.arrays import ANSWERS, LATE, NONE, PLANS, Answers, State
from carp_optimized.state.records import clash, delays_parking, same_plan


@compiled
def start_answers(answers: Answers, members: int) -> None:
    """Know nothing yet."""
    answers.used[0] = 0
    answers.used[1] = 0
    for member in range(members):
        answers.oldest[member] = NONE


@compiled
def number_plan(state: State, answers: Answers, member: int, record: int) -> int:
    """The number of the member's plan; `PLANS` if there are too many.

    Plans that are the same have several where the goal was free for ever from several ticks on.
    """
    used = int(answers.used[0])
    for plan in range(used):
        known = int(answers.record[plan])
        is_alike = answers.owner[plan] == member and state.records.opens[known] == state.records.opens[record]
        if is_alike and same_plan(state.records, known, record):
            return plan
    if used == PLANS:
        return PLANS
    answers.record[used] = record
    answers.owner[used] = member
    answers.clashes[used] = 1 << PLANS
    answers.compared[used] = 1 << PLANS
    answers.used[0] += 1
    return used


@compiled
def learn(answers: Answers, member: int, given: int, plan: int, record: int, least: int) -> None:
    """Remember an answer, whose plan costs at least so much, if its plans have numbers."""
    used = int(answers.used[1])
    if plan < PLANS and given < 1 << PLANS and used < ANSWERS:
        answers.given[used] = given
        answers.plan[used] = plan
        answers.found[used] = record
        answers.least[used] = least
        answers.newer[used] = NONE
        if answers.oldest[member] == NONE:
            answers.oldest[member] = used
        else:
            answers.newer[answers.newest[member]] = used
        answers.newest[member] = used
        answers.used[1] += 1


@compiled
def has_clash(state: State, answers: Answers, plan: int, given: int) -> bool:
    """Whether the plan clashes with one of the set, or its query would go another way beside it.

    Two plans are compared when first asked for.
    """
    new = given & ~int(answers.compared[plan])
    other = 0
    while new >> other != 0:
        if (new >> other) & 1 == 1:
            record = int(answers.record[plan])
            beside = int(answers.record[other])
            if clash(state, record, beside) or delays_parking(state, record, beside):
                answers.clashes[plan] |= 1 << other
        other += 1
    answers.compared[plan] |= new
    return int(answers.clashes[plan]) & given != 0


@compiled
def known_answer(state: State, answers: Answers, member: int, given: int) -> int:
    """A known answer that holds for the member against the set of plans, or `NONE`; the plan alone is tried first."""
    answer = int(answers.oldest[member])
    while answer != NONE:
        if int(answers.given[answer]) & ~given == 0 and answers.plan[answer] != LATE:
            plan = int(answers.plan[answer])
            if plan == NONE or not has_clash(state, answers, plan, given):
                return answer
        answer = int(answers.newer[answer])
    return NONE


@compiled
def least_of(answers: Answers, member: int, given: int) -> int:
    """The least cost of the member against the set of plans, by all answers known; `NO_LIMIT`: it has no plan."""
    least = 0
    answer = int(answers.oldest[member])
    while answer != NONE:
        if int(answers.given[answer]) & ~given == 0:
            least = max(least, int(answers.least[answer]))
        answer = int(answers.newer[answer])
    return least
