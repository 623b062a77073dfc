"""`carproof rules`, and the rules of requests themselves."""

import pytest
from tests.oracle.running import BROKEN, ONE_PLANNED, TWO, TWO_PLANNED, Run, line

from carp_spec import Violation, read_instance, read_solution
from carproof.requests import now_is_a_tick, path_to, plans_are_sound, robot_is_known
from carproof.rules import ALL_RULES


def test_every_rule_is_listed_once_and_told_in_full(carproof: Run) -> None:
    listed = [row.split()[0] for row in carproof("rules").stdout.splitlines()[2:]]
    assert listed == [rule.id for rule in ALL_RULES]
    assert len(set(listed)) == len(listed)
    for rule in ALL_RULES:
        reported = carproof("rules", rule.id).stdout
        assert reported.startswith(f"{rule.id}\n\n")
        assert " ".join(rule.statement.split()) in " ".join(reported.split())
        assert (
            f"Source:    {rule.source}\nPredicate: {rule.predicate.__module__}.{rule.predicate.__name__}\n" in reported
        )


def test_requests_obey_their_rules() -> None:
    instance = read_instance(line(**TWO))
    assert robot_is_known(instance, "r1")
    assert not robot_is_known(instance, "r9")
    assert [now for now in (0, 7, -1, True, 1.0, None) if now_is_a_tick(now)] == [0, 7]
    right = [plans_are_sound(instance, read_solution(line(**each))) for each in (TWO_PLANNED, ONE_PLANNED, BROKEN)]
    assert right == [True, True, False]


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
