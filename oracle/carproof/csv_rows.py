"""Tables of comma-separated values, as logs, plans and requests have them."""

import csv
from collections.abc import Iterator, Mapping, Sequence
from io import StringIO
from typing import TypeVar

from carproof.input_rules import Code

T = TypeVar("T")


def rows_of(
    text: str, file: str, rule: Code, columns: Sequence[str], others: Sequence[str] | None = None
) -> Iterator[tuple[int, Mapping[str, str]]]:
    """The rows of a table, each with the line at which it ends; of the others, a value that is missing is empty.

    The first line names the columns, in any order, each once; with `others`, these and no more. Raises `Refusal` of
    the rule with file and line.
    """
    rows = csv.DictReader(StringIO(text.removeprefix("\ufeff"), newline=""), strict=True)
    try:
        names = rows.fieldnames or ()
        if not {*columns} <= {*names} or len({*names}) < len(names):
            raise rule.refuse(f"{file}:1", f"the line must name the columns {', '.join(columns)}, each once")
        unknown = [each for each in names if each not in (*columns, *(others or names))]
        if unknown:
            known = ", ".join((*columns, *(others or ())))
            raise rule.refuse(f"{file}:1", f"the columns must be of {known}, and one is {unknown[0]!r}")
        for row in rows:
            if None in row or any(row[name] is None for name in columns):
                message = "the line must have a value for each column and no more; one with a comma is in quotes"
                raise rule.refuse(f"{file}:{rows.line_num}", message)
            yield rows.line_num, {name: value or "" for name, value in row.items()}
    except csv.Error as error:
        raise rule.refuse(f"{file}:{rows.reader.line_num}", f"the line must be one of CSV: {error}") from None


def named(text: str, ids: Mapping[str, T]) -> T | str:
    """The id that prints like the text, or else like the text without blanks around it."""
    return ids.get(text, ids.get(text.strip(), text.strip()))
