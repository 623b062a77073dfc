"""The published descriptions of the ops: a JSON Schema, a table in the documentation, lists in help.

`python -m carproof.protocol.ops.published` writes the schema.
"""

from collections.abc import Iterable
from dataclasses import MISSING
from textwrap import fill
from typing import Any, Literal, get_args

import msgspec

from carp_spec.documents.schema import schema_file, schema_text
from carproof.markdown import markdown_table
from carproof.protocol.lines import ErrorDocument
from carproof.protocol.ops import OPS
from carproof.protocol.ops.op import Field, Op, document_of

NAME = "protocol"
ABOUT = "A request of the protocol. The response to an XRequest is an XResponse, a Refused or, by a program, a Skipped."


def schema() -> str:
    """The JSON Schema of the protocol."""
    requests = [
        _line(f"{op.title}Request", op.statement, ("op", Literal[op.name]), *map(_typed, op.fields))
        for op in OPS.values()
    ]
    responses = [_line(f"{op.title}Response", "", ("result", document_of(op.result))) for op in OPS.values()]
    refused = _line("Refused", "The reason why a request was refused.", ("error", ErrorDocument))
    skipped = _line("Skipped", "The reason why a program does not answer a request.", ("skipped", str))
    lines = [*requests, *responses, refused, skipped]
    asked, components = msgspec.json.schema_components(lines, ref_template="#/$defs/{name}")
    return schema_text(NAME, {"description": ABOUT, "anyOf": asked[: len(requests)], "$defs": components})


def _line(name: str, about: str, *fields: tuple[Any, ...]) -> type[msgspec.Struct]:
    """A line of the protocol: an object with an id and these fields."""
    return msgspec.defstruct(
        name, [("id", Any), *fields], namespace={"__doc__": about}, kw_only=True, forbid_unknown_fields=True
    )


def _typed(field: Field) -> tuple[Any, ...]:
    if field.default is MISSING:
        return (field.name, field.type)
    if field.default is None:
        return (field.name, field.type | msgspec.UnsetType, msgspec.UNSET)
    return (field.name, field.type, field.default)


def table() -> str:
    """The ops as a table for people."""
    rows = ([f"`{op.name}`", op.statement, ", ".join(map(_shown, op.fields)), _result(op)] for op in OPS.values())
    return markdown_table(("op", "what it does", "fields", "result"), rows)


def _shown(field: Field) -> str:
    format = _format(field.type)
    about = [] if format is None or field.name in format else [f"a `{format}`"]
    if field.default is not MISSING and field.default is not None:
        about.append(f"default {str(field.default).lower()}")
    elif field.default is None:
        about.append("optional")
    return f"`{field.name}`" + (f" ({', '.join(about)})" if about else "")


def _result(op: Op) -> str:
    document = document_of(op.result)
    format = _format(document)
    if format is not None:
        return f"a `{format}`"
    names = ", ".join(f"`{name}`" for name in document.__struct_fields__)
    return ". ".join(filter(None, (names, " ".join(document.__doc__.split()))))


def _format(kind: Any) -> str | None:  # noqa: ANN401 - a type
    """The format that a document names."""
    hint = getattr(kind, "__annotations__", {}).get("format")
    return None if hint is None else str(get_args(hint)[0])


def op_list(names: Iterable[str] = OPS) -> str:
    """The ops with their descriptions, for the end of a command's help."""
    width = max(map(len, OPS)) + 4
    later = " " * width
    about = {name: OPS[name].statement.partition(". ")[0].removesuffix(".") for name in names}
    ops = (fill(f"  {name:{width - 2}}{about[name]}", 76, subsequent_indent=later) for name in about)
    return "\n".join(["\b", "Ops:", *ops, "", ""])


if __name__ == "__main__":
    schema_file(NAME).write_text(schema())
