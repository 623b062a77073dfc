"""The registry: every rule once, with its statement. The test vectors are the rules' examples."""

import re

import pytest

from carproof.registry import RULES

RULES_BY_ID = {rule.id: rule for rule in RULES}


def test_no_id_is_given_twice() -> None:
    assert len(RULES_BY_ID) == len(RULES)


@pytest.mark.parametrize("id", RULES_BY_ID)
def test_a_rule_tells_its_statement_and_source_in_a_few_sentences(id: str) -> None:
    rule = RULES_BY_ID[id]
    assert re.fullmatch(r"[a-z]+/[a-z-]+", id)
    assert rule.statement.endswith(".")
    assert len(rule.statement) < 420
    assert rule.source
