"""The document of a lower bound, and the digest that ties it to its instance."""

import json
from hashlib import sha256

import pytest
from tests.spec.making import instance_on, line

from carp_spec import Refusal, Robot
from carp_spec.documents.bounds import BOUND_FORMAT, read_bound
from carp_spec.documents.instances import digest, write_instance


def test_the_digest_is_that_of_the_document() -> None:
    instance = instance_on(line("ab"), Robot("r", "a", "b"))
    assert digest(instance) == sha256(write_instance(instance)).hexdigest()


def test_a_document_with_a_field_too_few_is_refused() -> None:
    with pytest.raises(Refusal, match="instance"):
        read_bound(json.dumps({"format": BOUND_FORMAT}).encode())


@pytest.mark.parametrize("horizon", [-1, 0])
def test_a_horizon_is_at_least_0(horizon: int) -> None:
    fields = {"instance": "", "bound": 0, "scale": 1, "horizon": horizon, "resources": [], "exchanges": []}
    data = json.dumps({"format": BOUND_FORMAT, **fields, "cuts": [], "robots": []}).encode()
    if horizon < 0:
        with pytest.raises(Refusal, match=r"\$.horizon: expected int >= 0"):
            read_bound(data)
    else:
        assert read_bound(data).horizon == 0
