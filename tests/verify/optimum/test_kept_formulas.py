"""The formulas that written proofs and cuts refute: a change of the encoding would refuse all of them."""

from hashlib import sha256

import pytest
from tests.verify.optimum.test_proof import crossing
from tests.verify.test_forgery import lane

from carp_spec import Instance, Robot
from carp_verify.optimum.clauses import dimacs
from carp_verify.optimum.encoding import Evidence, beat_formula, reach_formula
from carp_verify.optimum.proof import variables

WIDE = lane("park", Robot("r", "a", "c", pace=2), Robot("s", "d", "a"), Robot("t", "b", "b", release=2), capacity=2)


@pytest.mark.parametrize(
    ("instance", "horizons", "order", "digest"),
    [
        (crossing(), (3, 2, 3, 1), (2, 0, 3, 1), "66848c92584531bb"),
        (crossing("park"), (1, 2, 3, 4), (3, 2, 1, 0), "41f5587132a25997"),
        (WIDE, (4, 3, 2), (1, 0, 2), "6ae3ba4c97c83a1e"),
        (lane("vanish", Robot("r", "c", "c"), Robot("s", "a", "c")), (2, 2), (0, 1), "fad6ad2af3299136"),
    ],
    ids=["crossing", "parked", "wide", "still"],
)
def test_the_formulas_of_format_2_stay(
    instance: Instance, horizons: tuple[int, ...], order: tuple[int, ...], digest: str
) -> None:
    evidence = Evidence(horizons, order)
    shortest = beat_formula(instance, None, evidence)
    reach = reach_formula(instance, shortest.shortest + 3, evidence)
    beat = beat_formula(instance, shortest.shortest + 3, evidence)
    content = dimacs(shortest.formula) + dimacs(reach.formula) + dimacs(beat.formula) + variables(reach).decode()
    assert sha256(content.encode()).hexdigest()[:16] == digest
