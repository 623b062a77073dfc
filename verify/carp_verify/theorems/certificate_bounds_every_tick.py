"""Plans that the capacity certificate accepts exceed no capacity at any tick, and make no exchange.

The certificate shows for each resource that no whole number t is a tick with more than c(r) occupants. A robot
occupies the resource at t if one of its stays holds t, and the number of such robots is a sum. For any number of
robots, by induction: the number of labels set, each of which implies an occupation, is at most the number of
occupants, and labels can be chosen so that it equals it. For exchanges, labels imply moves at t, one each way.
"""

from collections.abc import Iterator, Sequence

from carp_verify.engine import Lemma, Theorem
from carp_verify.smt import Bool, all_of, counted, implies, integer, integers, negation, same, truth
from carp_verify.vocabulary import holds, interval, is_interval


def _premises() -> Sequence[Bool]:
    """Labels and occupants of the robots so far, and a label of one robot more that implies an occupation."""
    labels, occupants = integers("labels occupants")
    occupies = holds(interval("stay"), integer("tick"))
    return [is_interval(interval("stay")), labels >= 0, labels <= occupants, implies(truth("label"), occupies)]


def lemmas() -> Iterator[Lemma]:
    """The induction over robots, both ways, and what an answer of z3 means."""
    labels, occupants, capacity = integers("labels occupants capacity")
    occupies = holds(interval("stay"), integer("tick"))
    label = truth("label")
    sound = labels + counted(label) <= occupants + counted(occupies)
    yield Lemma("labels that can be set are occupants", _premises(), sound)
    chosen = [labels >= occupants, same(label, occupies), is_interval(interval("stay"))]
    complete = labels + counted(label) >= occupants + counted(occupies)
    yield Lemma("each occupant's label can be set", chosen, complete)
    refused = [capacity >= 1, negation(labels >= capacity + 1), labels >= occupants]
    yield Lemma("if no labels are more than the capacity, no occupants are", refused, occupants <= capacity)
    one, other, tick = integers("one other tick")
    apart = all_of(*(implies(truth(name), term <= tick) for name, term in (("there", one), ("back", other))))
    meets = [apart, implies(truth("there"), one >= tick), implies(truth("back"), other >= tick)]
    together = implies(all_of(truth("there"), truth("back")), all_of(one <= other, other <= one))
    yield Lemma("labels of two opposite moves mean that they are at one tick", meets, together)


def mutants() -> Iterator[Lemma]:
    """Labels without meaning, and a bound that is one too large."""
    labels, occupants, capacity = integers("labels occupants capacity")
    occupies = holds(interval("stay"), integer("tick"))
    label = truth("label")
    free_label = [is_interval(interval("stay")), labels >= 0, labels <= occupants]
    claim = labels + counted(label) <= occupants + counted(occupies)
    yield Lemma("a label need not mean an occupation", free_label, claim)
    too_many = [capacity >= 1, negation(labels >= capacity + 2), labels >= occupants]
    yield Lemma("one robot too many is asked for", too_many, occupants <= capacity)


THEOREM = Theorem(
    "An accepted certificate bounds every tick", __doc__, ("joint/capacity", "joint/exchange"), lemmas, mutants
)
