"""The registry: every rule once, with examples that keep it and examples that break it."""

import re
from collections.abc import Iterator

import pytest
from tests.spec.rule_examples import EXAMPLES, NOTHING_CLAIMED, Example

from carp_spec import RULES

RULES_BY_ID = {rule.id: rule for rule in RULES}
VALID = [pytest.param(id, each, id=f"{id}-{i}") for id, of in EXAMPLES.items() for i, each in enumerate(of.valid)]
INVALID = [pytest.param(id, each, id=f"{id}-{i}") for id, of in EXAMPLES.items() for i, each in enumerate(of.invalid)]


def keeps(id: str, example: Example) -> bool:
    rule = RULES_BY_ID[id]
    if id == "query/ties":
        sooner, later = (rule(*each) for each in example.arguments)
        return bool((sooner < later) == example.claimed)
    answer = rule(*example.arguments)
    if example.claimed is NOTHING_CLAIMED:
        return not list(answer) if isinstance(answer, Iterator) else bool(answer)
    return bool((list(answer) if isinstance(answer, Iterator) else answer) == example.claimed)


def test_every_rule_has_examples_that_keep_it_and_examples_that_break_it() -> None:
    assert list(EXAMPLES) == [rule.id for rule in RULES]
    assert all(examples.valid and examples.invalid for examples in EXAMPLES.values())


@pytest.mark.parametrize(("id", "example"), VALID)
def test_valid_examples_keep_the_rule(id: str, example: Example) -> None:
    assert keeps(id, example)


@pytest.mark.parametrize(("id", "example"), INVALID)
def test_invalid_examples_break_the_rule(id: str, example: Example) -> None:
    assert not keeps(id, example)


def test_no_id_is_given_twice() -> None:
    assert len(RULES_BY_ID) == len(RULES)


@pytest.mark.parametrize("id", RULES_BY_ID)
def test_a_rule_tells_its_statement_and_source_in_a_few_sentences(id: str) -> None:
    rule = RULES_BY_ID[id]
    assert re.fullmatch(r"[a-z]+/[a-z-]+", id)
    assert rule.statement.endswith(".")
    assert len(rule.statement) < 420
    assert rule.source
