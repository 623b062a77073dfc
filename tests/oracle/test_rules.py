"""`carproof rules`, and the rules of requests themselves."""

import pytest
from tests.oracle.running import BROKEN, Run, line

from carp_spec.requests import path_to, require_tick
from carproof import Refusal, Rule, Violation, read_solution
from carproof.rules import ALL_RULES


def test_every_rule_is_listed_once_and_told_in_full(carproof: Run) -> None:
    listed = [row.split()[0] for row in carproof("rules").stdout.splitlines()[2:]]
    assert listed == [rule.id for rule in ALL_RULES]
    assert len(set(listed)) == len(listed)
    for rule in ALL_RULES:
        reported = carproof("rules", rule.id).stdout
        assert reported.startswith(f"{rule.id}\n\n")
        assert " ".join(rule.statement.split()) in " ".join(reported.split())
        assert f"Source:    {rule.source}\n" in reported
        predicate = f"{rule.predicate.__module__}.{rule.predicate.__name__}" if isinstance(rule, Rule) else None
        assert reported.partition("\nPredicate: ")[2].strip() == (predicate or "")


@pytest.mark.parametrize("now", [-1, True, 1.0, None])
def test_a_tick_is_a_whole_number_of_at_least_0(now: object) -> None:
    require_tick(0, "$.now")
    with pytest.raises(Refusal, match="whole number of at least 0"):
        require_tick(now, "$.now")


@pytest.mark.parametrize(
    ("violation", "path"),
    [
        (Violation("joint/capacity", ("r2", "r1"), "b", 0, 1, ""), "$.plans[1].visits[0]"),
        (Violation("joint/exchange", ("r2", "r1"), "c", 2, 3, ""), "$.plans[1].visits[1]"),
        (Violation("solution/order", ("r1",), None, None, None, ""), "$.plans[0]"),
        (Violation("solution/covers", ("r9",), None, None, None, ""), "$"),
    ],
)
def test_a_violation_is_placed_in_the_document(violation: Violation, path: str) -> None:
    assert path_to(violation, read_solution(line(**BROKEN))) == path
