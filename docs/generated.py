"""Content that the documentation site takes from the code: MkDocs calls these hooks while it builds.

A page names what belongs in a place by a comment, `<!-- generated: NAME -->`; `PARTS` has what is put there.
"""

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import partial
from importlib.resources import files as files_of
from itertools import groupby
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import click
from docs.trusted_base import table as trusted_base
from docs.trusted_base import theorems
from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

from carp_experiments.page import RESULTS, results
from carp_experiments.printed import write_printed
from carp_spec import Rule
from carp_spec.documents.vectors import Vector
from carproof.entry.cli import carproof
from carproof.input_rules import Code
from carproof.protocol.ops.published import table as ops
from carproof.registry import RULES
from carproof.rules import ALL_RULES
from carproof.testing.vectors import FOLDER, subjects, vectors

ROOT = Path(__file__).parents[1]
PLACE = re.compile(r"<!-- generated: (.+?) -->\n")
COPIED = {
    "reference/schemas": Path(str(files_of("carp_spec"))) / "schemas",
    "reference/vectors": FOLDER,
    "results/figures": RESULTS,
    "assets": ROOT / "oracle" / "pictures",
}
"""Folders whose JSON documents and pictures the site shows, by their place in the site."""


def on_files(files: Files, *, config: MkDocsConfig) -> Files:
    """Add schemas, test vectors, figures, and the report of the experiments to print."""
    for place, folder in COPIED.items():
        for path in sorted(folder.iterdir()):
            if path.suffix in {".json", ".svg"}:
                files.append(File.generated(config, f"{place}/{path.name}", abs_src_path=str(path)))
    with TemporaryDirectory() as place:
        for path in write_printed(Path(place), RESULTS):
            files.append(File.generated(config, f"results/{path.name}", content=path.read_bytes()))
    return files


def on_page_markdown(markdown: str, *, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Fill the places that the page names."""
    del page, config, files
    return PLACE.sub(lambda place: PARTS[place[1]](), markdown)


def commands() -> str:
    """The help of every command, as `carproof COMMAND --help` prints it."""
    context = click.Context(carproof, info_name="carproof")
    parts = [f"## carproof\n\n{_help(carproof, context)}"]
    for name in carproof.list_commands(context):
        command = carproof.get_command(context, name)
        assert command is not None  # noqa: S101 - a listed command exists
        parts.append(f"## {name}\n\n{_help(command, click.Context(command, context, name))}")
        if isinstance(command, click.Group):
            inside = click.Context(command, context, name)
            for each, below in sorted(command.commands.items()):
                parts.append(f"### {name} {each}\n\n{_help(below, click.Context(below, inside, each))}")
    return "\n".join(parts)


def _help(command: click.Command, context: click.Context) -> str:
    return f"```text\n{command.get_help(context)}\n```\n"


def law() -> str:
    """The rules of the specification, with the test vectors of each."""
    return _rules(RULES)


def other_rules() -> str:
    """All rules but those of the specification."""
    law = {rule.id for rule in RULES}
    return _rules([rule for rule in ALL_RULES if rule.id not in law])


def _rules(rules: Sequence[Rule[..., Any] | Code]) -> str:
    by_family = groupby(rules, lambda rule: rule.id.partition("/")[0])
    return "\n".join(f"## {family}\n\n{''.join(map(_rule, of_family))}" for family, of_family in by_family)


def _rule(rule: Rule[..., Any] | Code) -> str:
    predicate = ""
    if isinstance(rule, Rule):
        predicate = f" *Predicate:* `{rule.predicate.__module__}.{rule.predicate.__qualname__}`."
    cases = "".join(_cases(rule.id)) if rule.id in subjects() else ""
    return f"### {rule.id}\n\n{rule.statement}\n\n*Source:* {rule.source}.{predicate}\n\n{cases}"


def _cases(subject: str) -> Iterator[str]:
    """The vectors of a subject, folded away until a reader opens them."""
    cases = list(vectors(subject))
    name = f"{subject.replace('/', '-')}.json"
    yield f'??? example "{len(cases)} test vectors"\n\n'
    yield f"    File: [{name}](vectors/{name})\n\n"
    yield "    | case | is | about |\n    |---|---|---|\n"
    for case in cases:
        yield f"    | `{case.id.partition('.')[2]}` | {_judged(case)} | {case.comment} |\n"
    yield "\n"


def _judged(case: Vector) -> str:
    return case.expected if not case.violated else "breaks " + ", ".join(f"`{rule}`" for rule in case.violated)


def _fields(name: str) -> str:
    """The fields of a document and of what is in it, from its JSON Schema."""
    schema = json.loads((COPIED["reference/schemas"] / f"{name}.schema.json").read_text())
    definitions = {**schema["$defs"]}
    whole = definitions.pop(schema["$ref"].rpartition("/")[2])
    return "".join(_fields_of(each) for each in (whole, *definitions.values()) if "properties" in each)


def _fields_of(definition: dict[str, Any]) -> str:
    required = definition["required"]
    rows = [
        f"| `{field}` | {_type(type)} | {'' if field in required else _default(type)} |\n"
        for field, type in definition["properties"].items()
    ]
    head = f"**{_word(definition['title'])}**: {definition['description']}\n\n"
    return f"{head}| field | type | if left out |\n|---|---|---|\n{''.join(rows)}\n"


def _default(type: dict[str, Any]) -> str:
    return f"`{json.dumps(type['default'])}`" if "default" in type else "absent"


def _type(type: dict[str, Any]) -> str:
    """A type of JSON Schema in words."""
    if "enum" in type or "const" in type:
        return " or ".join(f"`{json.dumps(value)}`" for value in type.get("enum", [type.get("const")]))
    if "anyOf" in type:
        return " or ".join(map(_type, type["anyOf"]))
    if "$ref" in type:
        return _word(type["$ref"].rpartition("/")[2])
    if "prefixItems" in type:
        return f"[{', '.join(map(_type, type['prefixItems']))}]"
    if type["type"] == "array":
        return f"list of {_type(type['items'])}"
    least = f" of at least {type['minimum']}" if "minimum" in type else ""
    return f"{TYPES.get(type['type'], type['type'])}{least}"


def _word(name: str) -> str:
    """The name of a document's class as people say it: `RobotDocument` is a robot."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name.removesuffix("Document")).lower()


def figures() -> str:
    """Each figure of the site as wide as the page, under its name."""
    parts = []
    for folder in ("assets", "results/figures"):
        for path in sorted(COPIED[folder].glob("*.svg"), key=lambda path: path.stem):
            name = path.stem.replace("-", ", ").capitalize()
            parts.append(f"## {name}\n\n![{name}](../{folder}/{path.name}){{ .figure }}\n")
    return "\n".join(parts)


DOCUMENTS = ("instance", "solution", "verdict", "trace", "grants", "bound", "query")
TYPES = {"integer": "whole number", "boolean": "true or false"}
PARTS: Mapping[str, Callable[[], str]] = {
    "commands": commands,
    "law": law,
    "other rules": other_rules,
    "figures": figures,
    "paper": results,
    "ops": ops,
    "trusted base": trusted_base,
    "theorems": theorems,
    **{f"fields of {name}": partial(_fields, name) for name in DOCUMENTS},
}
