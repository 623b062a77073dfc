"""The table of rules in `spec/README.md`, made from the registry; `python -m carp_spec.readme` writes it anew."""

from pathlib import Path

from carp_spec.registry import RULES

README = Path(__file__).parents[1] / "README.md"
START = "<!-- rules: made by `make generated` -->\n"
END = "<!-- end of rules -->\n"


def rule_table() -> str:
    """Every rule as a row of a Markdown table."""
    rows = [f"| `{rule.id}` | {rule.statement} | {rule.source} |\n" for rule in RULES]
    return "".join(["| id | statement | source |\n", "|---|---|---|\n", *rows])


def with_rules(readme: str) -> str:
    """The text with the table of rules between its two markers."""
    before, _, rest = readme.partition(START)
    _, _, after = rest.partition(END)
    return f"{before}{START}{rule_table()}{END}{after}"


def write_rules() -> None:
    """Write the table into the README."""
    README.write_text(with_rules(README.read_text()))


if __name__ == "__main__":
    write_rules()
