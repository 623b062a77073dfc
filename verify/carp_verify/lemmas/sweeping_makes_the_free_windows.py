"""The sweep of `free_windows` makes exactly the maximal intervals of free ticks, disjoint and in order.

The sweep goes from one tick of change to the next, with a window open or not. Its invariant, at such a tick: a window
is open if and only if the tick is free; it has been free since the window opened; the tick before that is not free, or
none exists; and the ticks so far are free if and only if a finished or the open window holds them. z3 checks that
the invariant holds at tick 0, that a step keeps it, and what it gives after the last change.

By hand: the induction over changes. That ticks between two changes are like the first is a premise here and another
lemma, "Occupancy changes only where stays begin or end". `sweep_step` is a copy of the loop's body in `free_windows`,
and a test holds the two equal on small stays.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from carp_verify.engine import Formula, Lemma
from carp_verify.smt import (
    Bool,
    Int,
    all_of,
    any_of,
    between,
    choose,
    equal,
    implies,
    integers,
    negation,
    predicate,
    same,
    truth,
)


@dataclass(frozen=True, slots=True)
class Step:
    """The result of one step of the sweep: is a window open after it, since when, and is one finished."""

    is_open: Bool
    opened: Int
    finishes: Bool


def sweep_step(is_open: Bool, opened: Int, tick: Int, free: Bool) -> Step:
    """One step of the sweep: at a tick of change, which is free or not."""
    opens = all_of(negation(is_open), free)
    finishes = all_of(is_open, negation(free))
    return Step(any_of(opens, all_of(is_open, free)), choose(opens, tick, opened), finishes)


@dataclass(frozen=True, slots=True)
class Sweep:
    """The terms of one step: from the change at `before` to that at `tick`; `other` is any tick up to there."""

    before: Int
    tick: Int
    other: Int
    opened: Int
    last_end: Int
    is_open: Bool

    def covered(self, is_open: Bool, opened: Int, finished: Bool) -> Bool:
        """Whether a finished or the open window holds the other tick."""
        return any_of(finished, all_of(is_open, opened <= self.other))


free = predicate("free")
finished = predicate("finished")


def _sweep() -> Sweep:
    before, tick, other, opened, last_end = integers("before tick other opened last_end")
    return Sweep(before, tick, other, opened, last_end, truth("is open"))


def _invariant(sweep: Sweep) -> Sequence[Bool]:
    """The invariant at the tick before, and the constancy between the two changes, as far as they are used."""
    seen = implies(
        between(0, sweep.other, sweep.before + 1),
        same(free(sweep.other), sweep.covered(sweep.is_open, sweep.opened, finished(sweep.other))),
    )
    return [
        all_of(sweep.before >= 0, sweep.before < sweep.tick),
        same(sweep.is_open, free(sweep.before)),
        seen,
        implies(finished(sweep.other), sweep.other < sweep.last_end),
        between(0, sweep.last_end, sweep.before + 1),
        implies(sweep.is_open, between(sweep.last_end, sweep.opened, sweep.before + 1)),
        implies(sweep.is_open, any_of(equal(sweep.opened, 0), negation(free(sweep.opened - 1)))),
        *(_constant(sweep, each) for each in (sweep.other, sweep.tick - 1)),
    ]


def _constant(sweep: Sweep, tick: Int) -> Bool:
    return implies(between(sweep.before, tick, sweep.tick), same(free(tick), free(sweep.before)))


def _after(sweep: Sweep, step: Step) -> dict[str, Bool]:
    """The invariant at the tick of the step, by its parts."""
    last_end = choose(step.finishes, sweep.tick, sweep.last_end)
    newly_finished = all_of(step.finishes, between(sweep.opened, sweep.other, sweep.tick))
    holds_other = any_of(finished(sweep.other), newly_finished)
    return {
        "a window is open if and only if the tick is free": same(step.is_open, free(sweep.tick)),
        "the ticks so far are free if and only if a window holds them": implies(
            between(0, sweep.other, sweep.tick + 1),
            same(free(sweep.other), sweep.covered(step.is_open, step.opened, holds_other)),
        ),
        "the tick before an open window is not free, or none exists": implies(
            step.is_open, any_of(equal(step.opened, 0), negation(free(step.opened - 1)))
        ),
        "a finished window has a tick, and the tick after it is not free": implies(
            step.finishes, all_of(sweep.opened < sweep.tick, negation(free(sweep.tick)))
        ),
        "the finished windows end by the tick": all_of(
            implies(holds_other, sweep.other < last_end), between(0, last_end, sweep.tick + 1)
        ),
        "an open window begins by the tick, and not before the end of the last one": implies(
            step.is_open, between(last_end, step.opened, sweep.tick + 1)
        ),
        "a window opens after the end of the last one": implies(
            all_of(step.is_open, negation(sweep.is_open)), step.opened > sweep.last_end
        ),
    }


def formulas() -> Iterator[Formula]:
    """The beginning at tick 0, the step, and the end."""
    sweep = _sweep()
    first = sweep_step(truth("never"), sweep.opened, sweep.tick, free(sweep.tick))
    begins = [negation(truth("never")), equal(sweep.tick, 0)]
    opens_at_0 = all_of(same(first.is_open, free(sweep.tick)), implies(first.is_open, equal(first.opened, 0)))
    yield Formula("at tick 0 a window opens if and only if the tick is free", begins, opens_at_0)
    step = sweep_step(sweep.is_open, sweep.opened, sweep.tick, free(sweep.tick))
    for name, claim in _after(sweep, step).items():
        yield Formula(name, _invariant(sweep), claim)
    later = [*_invariant(sweep), sweep.other >= sweep.before, same(free(sweep.other), free(sweep.before))]
    holds_other = sweep.covered(sweep.is_open, sweep.opened, finished(sweep.other))
    yield Formula(
        "after the last change the open window holds the free ticks", later, same(free(sweep.other), holds_other)
    )


def mutants() -> Iterator[Formula]:
    """Steps with an error."""
    sweep = _sweep()
    right = sweep_step(sweep.is_open, sweep.opened, sweep.tick, free(sweep.tick))
    covers = "the ticks so far are free if and only if a window holds them"
    late = Step(right.is_open, choose(sweep.is_open, sweep.opened, sweep.tick + 1), right.finishes)
    yield Formula("a window opens a tick late", _invariant(sweep), _after(sweep, late)[covers])
    forgets = Step(any_of(sweep.is_open, right.is_open), right.opened, right.finishes)
    yield Formula("a finished window stays open", _invariant(sweep), _after(sweep, forgets)[covers])
    reopens = Step(right.is_open, choose(right.is_open, sweep.tick, sweep.opened), right.finishes)
    maximal = "the tick before an open window is not free, or none exists"
    yield Formula("every free tick of change opens a window again", _invariant(sweep), _after(sweep, reopens)[maximal])


LEMMA = Lemma(
    "The sweep makes the free windows, disjoint, ordered and maximal", __doc__, ("window/free",), formulas, mutants
)
