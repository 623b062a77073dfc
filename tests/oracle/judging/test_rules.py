"""`carproof rules`, and the rules of requests themselves."""

from tests.oracle.running import Run

from carproof import Rule
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
