"""Which rules lemmas and theorems support, and why the others have neither."""

from collections.abc import Mapping

from carp_verify.lemmas import MODULES, lemma_named
from carp_verify.theorems import THEOREMS

_READING = "it says how a document is written; it claims nothing of whole numbers"
_DATA = "it is decided by looking at each entry once; there is no argument in it to check, and examples test it"
_CHANCE = "it is a choice by numbers of a stream: which one is made decides how soon plans get better, not whether"

UNSUPPORTED: Mapping[str, str] = {
    "document/json": _READING,
    "document/format": _READING,
    "document/shape": _READING,
    "instance/position": _DATA,
    "instance/after-goal": _DATA,
    "instance/following": _DATA,
    "trace/robots": _DATA,
    "trace/prefix": _DATA,
    "trace/ticks": _DATA,
    "priority/first": "it follows from query/optimal: no lawful plan beside histories alone is earlier",
    "cost/robot": "it is a definition: one difference of two numbers of the plan",
    "neighbourhood/baseline": "it is a choice: which candidate comes first, not what follows from it",
    "neighbourhood/nearest": "it is a choice: the least of given fractions, the first of equals",
    "neighbourhood/distance": "it is a definition; its integer square root is the standard library's",
    "neighbourhood/update": "it is a choice: which trajectories the next distances see",
    "polish/draws": _CHANCE,
    "polish/kind": _CHANCE,
    "polish/pivot": _CHANCE,
    "polish/members": _CHANCE,
    "polish/way": "it is a choice: which robots are taken out; any choice of them is right",
    "polish/contested": "it is a choice: which robots are taken out; any choice of them is right",
    "polish/near": "it is a choice: which robots are taken out; any choice of them is right",
    "polish/order": _CHANCE,
    "polish/kept": "it is a comparison of pairs of numbers; that plans never get worse is tested round by round",
    "polish/options": _DATA,
    "planner/options": _DATA,
}


def support_of_rules() -> Mapping[str, tuple[str, ...]]:
    """The lemmas, by their modules, and the theorems that support each rule, for the rules that have any."""
    support: dict[str, tuple[str, ...]] = {}
    supporters = [
        *((module, lemma_named(module).rules) for module in MODULES),
        *((each.name, each.rules) for each in THEOREMS),
    ]
    for name, rules in supporters:
        for rule in rules:
            support[rule] = (*support.get(rule, ()), name)
    return support
