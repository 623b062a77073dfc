"""Cases of `verify-bound`: certificates of lower bounds, most of them false. None has a cut that holds."""

from collections.abc import Mapping, Sequence
from typing import Any

from tests.vectors.making import EDGE, KNOWN_BUG, Flags, case, instance
from tests.vectors.optima import BAY, EAST, WEST

from carp_spec.bounds import BOUND_FORMAT
from carp_spec.vectors import Fields, Vector

DIGEST = "2f69aa61798af0d3dfc5275df3d3f285120517adcc10de67d2c14b2ea77a25af"
HONEST: Fields = {
    "format": BOUND_FORMAT,
    "instance": DIGEST,
    "bound": 4,
    "scale": 1,
    "horizon": 4,
    "resources": [["b", 1, 0]],
    "exchanges": [["a", "b", 2, 0]],
    "cuts": [],
    "robots": [["r1", 2], ["r2", 2]],
}
NOBODY: Fields = {"robots": [], "least": 10**6, "multiplier": 1, "horizons": [], "order": [], "refutation": ""}
BOTH: Fields = {"robots": ["r1", "r2"], "least": 8, "multiplier": 1, "horizons": [2, 2], "order": [0, 1]}
UNSOUND = "9001 0\n9002 -9001 0\nd 9002 -9001 0\n-9002 0\n0\n"


def _holds(id: str, comment: str, flags: Flags = (), /, **changes: Any) -> Vector:  # noqa: ANN401 - any field's value
    certificate = {**HONEST, **changes}
    answer = {"bound": certificate["bound"]}
    question = instance(BAY, EAST, WEST)
    return case(
        id, "verify-bound", comment, instance=question, input={"certificate": certificate}, answer=answer, flags=flags
    )


def _fails(id: str, comment: str, rule: str, path: str, flags: Flags = (), /, **changes: Any) -> Vector:  # noqa: ANN401
    certificate = {**HONEST, **changes}
    return case(
        id,
        "verify-bound",
        comment,
        instance=instance(BAY, EAST, WEST),
        input={"certificate": certificate},
        violated=[rule],
        answer={"refused": f"$.certificate{path}"},
        flags=flags,
    )


BOUNDS: Sequence[Vector] = (
    _holds("no-prices", "the sum of the shortest paths; the least total cost is 7"),
    _holds("price", "r1 pays for b when it passes at tick 1, and so may one robot in all", resources=[["b", 1, 1]],
           bound=5, robots=[["r1", 3], ["r2", 3]]),
    _holds("modest", "a robot may claim less than its least", bound=3, robots=[["r1", 1], ["r2", 2]]),
    _holds("far-horizon", "prices end with the last, whatever the horizon", KNOWN_BUG, horizon=10**9),
    _fails("negative-horizon", "a horizon is at least 0", "document/shape", ".horizon", KNOWN_BUG, horizon=-1),
    _fails("other-instance", "the digest is of another instance", "bound/instance", ".instance",
           instance=f"0{DIGEST[1:]}"),
    _fails("scale", "no power of two", "bound/scale", ".scale", scale=3),
    _fails("negative-price", "a price below 0 would raise every bound", "bound/price", ".resources[0]",
           resources=[["b", 1, -1]]),
    _fails("price-at-horizon", "the first tick without prices", "bound/price", ".resources[0]", EDGE,
           resources=[["b", 4, 0]]),
    _fails("price-of-no-move", "no move joins a and c", "bound/price", ".exchanges[0]",
           exchanges=[["a", "c", 2, 0]]),
    _fails("price-twice", "two prices for one place and tick", "bound/once", ".resources[1]",
           resources=[["b", 1, 0], ["b", 1, 0]]),
    _fails("robots-swapped", "the instance has r1 first", "bound/robots", ".robots",
           robots=[["r2", 2], ["r1", 2]]),
    _fails("too-much-for-a-robot", "r1 alone needs 2", "bound/robots", ".robots[0]", EDGE,
           robots=[["r1", 3], ["r2", 2]], bound=5),
    _fails("null-for-a-way", "a way leads to the goal of r1", "bound/robots", ".robots[0]",
           robots=[["r1", None], ["r2", 2]], bound=2),
    _fails("above-the-sum", "the parts add up to 4", "bound/total", ".bound", EDGE, bound=5),
    _fails("below-the-sum", "the bound is the sum, not less", "bound/total", ".bound", EDGE, bound=3),
    _fails("cut-over-nobody", "nobody costs nothing, and with this cut the bound would be 1000004", "bound/cut",
           ".cuts[0].robots", KNOWN_BUG, cuts=[NOBODY], bound=10**6 + 4),
    _fails("cut-without-hints", "five lines of DRAT that a checker took for a refutation of anything", "bound/cut",
           ".cuts[0]", KNOWN_BUG, cuts=[{**BOTH, "refutation": UNSOUND}], bound=8, robots=[["r1", 0], ["r2", 0]]),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {"verify-bound": BOUNDS}
