"""A query that would read the same answers returns the same plan, so it may be skipped and its plan reused.

A query is a fixed procedure: what it does next depends on its state and on the answer to what it read last (the free
windows of a resource, or whether a move is an exchange). If every answer it reads is the same as before, its states
are, for any number of reads, by induction; so is its plan. Answers are the same where no stay and no move read has
changed; and they do not depend on the order in which plans were committed, as the occupancy is a sum.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, Int, equal, implies, int_function, integers, same
from carp_verify.theorems.reserving_counts_at_any_capacity import is_free

question = int_function("question")
answer = int_function("answer")
answer_again = int_function("answer_again")
following = int_function("next", 2)


def as_free(rest: Int, old: Int, new: Int, capacity: Int) -> Bool:
    """Whether a tick is as free with the new stays of a plan there as with its old ones."""
    return same(is_free(rest + old, capacity), is_free(rest + new, capacity))


def _states() -> tuple[Bool, Bool]:
    """The same state before a read, and after it."""
    state, again = integers("state again")
    after = equal(
        following(state, answer(question(state))),
        following(again, answer_again(question(again))),
    )
    return equal(state, again), after


def _same_answer() -> Bool:
    """What the first query read is answered as it was."""
    (state,) = integers("state")
    return equal(answer(question(state)), answer_again(question(state)))


def _unchanged() -> Sequence[Bool]:
    """Occupancies at a tick without a plan that changes, and with its old and new stays there."""
    rest, old, new = integers("rest old new")
    return [rest >= 0, old >= 0, new >= 0, equal(old, new)]


def lemmas() -> Iterator[Lemma]:
    """The induction over reads, and when answers are the same."""
    before, after = _states()
    yield Lemma("the same answer keeps the states the same", [before, _same_answer()], after)
    rest, old, new, capacity = integers("rest old new capacity")
    free = as_free(rest, old, new, capacity)
    yield Lemma("a tick at which no stay changed is as free as it was", _unchanged(), free)
    one, two, three = integers("one two three")
    yield Lemma("the order of committing changes no occupancy", [one >= 0], equal(one + two + three, three + one + two))


def mutants() -> Iterator[Lemma]:
    """Answers that differ where it matters."""
    before, after = _states()
    state, other = integers("state other")
    elsewhere = implies(equal(other, question(state) + 1), equal(answer(other), answer_again(other)))
    yield Lemma("answers are compared for another question", [before, elsewhere], after)
    rest, old, new, capacity = integers("rest old new capacity")
    shrank = [rest >= 0, old >= 0, new >= 0, new <= old]
    yield Lemma("a stay that shrank is taken for unchanged", shrank, as_free(rest, old, new, capacity))


THEOREM = Theorem(
    "A skipped query returns what a repeated one would",
    __doc__,
    ("neighbourhood/replan", "neighbourhood/orders"),
    lemmas,
    mutants,
)
