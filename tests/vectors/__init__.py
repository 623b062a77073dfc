"""The test vectors' source: `python -m tests.vectors` writes the files of `carp_spec.vectors` anew.

The cases are written by hand, what is expected of them too; `judging` is what carproof itself says of them.
"""

from collections.abc import Mapping, Sequence

from tests.vectors import (
    bounds,
    certificates,
    documents,
    instances,
    neighbourhoods,
    optima,
    plans,
    polishing,
    queries,
    together,
    windows,
)

from carp_spec.vectors import Vector

CASES: Mapping[str, Sequence[Vector]] = {
    **documents.CASES,
    **instances.CASES,
    **plans.CASES,
    **together.CASES,
    **windows.CASES,
    **queries.CASES,
    **neighbourhoods.CASES,
    **polishing.CASES,
    **optima.CASES,
    **bounds.CASES,
    **certificates.CASES,
}
