"""`carproof rules`: the rules with their statements."""

from difflib import get_close_matches
from typing import Any

import click

from carp_spec import Rule
from carproof.command_line.answer import Answer
from carproof.command_line.options import listed
from carproof.command_line.tables import print_table
from carproof.input_rules import Code
from carproof.rules import ALL_RULES


@listed("List all rules, or explain one.", "carproof rules", "carproof rules joint/capacity")
@click.argument("id", required=False)
def command(id: str | None) -> Answer:
    """List all rules, or print the rule ID in full."""
    if id is None:
        print_table(["rule", "statement"], [(rule.id, rule.statement) for rule in ALL_RULES])
    else:
        rule = rule_named(id)
        click.echo(f"{rule.id}\n")
        click.echo(click.wrap_text(rule.statement, initial_indent="  ", subsequent_indent="  "))
        click.echo(f"\nSource:    {rule.source}")
        if isinstance(rule, Rule):  # the others have no predicate
            click.echo(f"Predicate: {rule.predicate.__module__}.{rule.predicate.__name__}")
    return Answer.YES


def rule_named(id: str) -> Rule[..., Any] | Code:
    """The rule of that id; the nearest ids are suggested where none exists."""
    rules = {rule.id: rule for rule in ALL_RULES}
    if id not in rules:
        near = get_close_matches(id, rules, cutoff=0.5)
        hint = f"the nearest are {', '.join(near)}" if near else "carproof rules lists them all"
        raise click.BadParameter(f"there is no rule {id!r}; {hint}.", param_hint="ID")
    return rules[id]
