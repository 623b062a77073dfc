"""The one exception for bad input."""

import pytest
from tests.spec.making import instance, line

from carp_spec import Refusal
from carp_spec.inputs.values import require_instance


def test_a_refusal_prints_path_sentence_and_rule() -> None:
    refusal = Refusal("document", "$.robots[3].goal", "instance/endpoint", "the goal must be the id of a resource")
    assert str(refusal) == "$.robots[3].goal: the goal must be the id of a resource [instance/endpoint]"
    assert (refusal.kind, refusal.path, refusal.rule) == ("document", "$.robots[3].goal", "instance/endpoint")
    assert refusal.message == "the goal must be the id of a resource"
    assert refusal.args == ("document", "$.robots[3].goal", "instance/endpoint", refusal.message)


def test_a_refusal_leaves_out_the_middle_of_a_long_value() -> None:
    with pytest.raises(Refusal) as raised:
        require_instance(instance(line("a"), ("a", "b" * 100_000)))
    assert raised.value.path == "$.robots[0].goal"
    assert len(raised.value.message) <= 1000
    assert "bbb ... bbb" in raised.value.message
    assert raised.value.message.endswith("is not")
