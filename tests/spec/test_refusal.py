"""The one exception for bad input."""

from carp_spec import Refusal


def test_a_refusal_prints_path_sentence_and_rule() -> None:
    refusal = Refusal("document", "$.robots[3].goal", "instance/endpoint", "the goal must be the id of a resource")
    assert str(refusal) == "$.robots[3].goal: the goal must be the id of a resource [instance/endpoint]"
    assert (refusal.kind, refusal.path, refusal.rule) == ("document", "$.robots[3].goal", "instance/endpoint")
    assert refusal.message == "the goal must be the id of a resource"
    assert refusal.args == ("document", "$.robots[3].goal", "instance/endpoint", refusal.message)
