"""Changes of one place of a module: cosmic-ray's, and a statement or an operand left out.

cosmic-ray leaves no statement out, and so no check. Its operators that are left out here only change the types that
annotations join with `|`, replace arithmetic by anything but +, - and *, or ask for identity where small numbers or
names are compared, which Python answers alike. Decorators of classes stay as they are: mypy refuses to write to the
fields of a frozen dataclass.
"""

import ast
from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from difflib import unified_diff
from itertools import chain
from pathlib import Path

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names

LEFT_OUT = ("_BitAnd", "_BitOr", "_BitXor", "_Div", "_FloorDiv", "_LShift", "_Mod", "_Pow", "_RShift", "_Is", "_IsNot")
KEPT_STATEMENTS = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef, ast.Pass)


@dataclass(frozen=True, slots=True)
class Mutant:
    """A module with one change, which begins at a line."""

    line: int
    original: str
    source: str

    @property
    def change(self) -> str:
        """The lines that differ, on one line."""
        lines = list(unified_diff(self.original.splitlines(), self.source.splitlines(), n=0, lineterm=""))[2:]
        return "  ".join(" ".join(line.split()) for line in lines if line[0] in "+-")


def mutants(path: Path, omit: bool = True, planted: Sequence[tuple[str, str]] = ()) -> Iterator[Mutant]:
    """The mutants of a module, each different: texts replaced, cosmic-ray's, and with `omit` something left out."""
    original = path.read_text(encoding="utf-8")
    seen = {original}
    changes = chain(_by_texts(original, planted), _omissions(original) if omit else (), _by_cosmic_ray(original))
    for line, source in changes:
        if source not in seen and is_python(source):
            seen.add(source)
            yield Mutant(line, original, source)


def is_python(source: str) -> bool:
    try:
        ast.parse(source)
    except SyntaxError:
        return False
    return True


def _by_texts(original: str, planted: Sequence[tuple[str, str]]) -> Iterator[tuple[int, str]]:
    for text, other in planted:
        if original.count(text) != 1:
            raise ValueError(f"the module must have {text!r} once")
        yield original[: original.index(text)].count("\n") + 1, original.replace(text, other)


def _by_cosmic_ray(original: str) -> Iterator[tuple[int, str]]:
    """Its mutants of each function and each statement outside of functions, parsed alone, as that is faster."""
    lines = original.splitlines(keepends=True)
    operators = [
        each for name in operator_names() if not is_left_out(name) and not (each := get_operator(name)).arguments()
    ]
    for first, last, prefix in _pieces(ast.parse(original)):
        piece = prefix + "".join(lines[first:last])
        nodes = list(ast_nodes(get_ast(piece)))
        for operator in operators:
            positions = [start for node in nodes for start, _ in operator().mutation_positions(node)]
            for occurrence, (line, _) in enumerate(positions):
                with suppress(AttributeError):  # cosmic-ray cannot change a tuple of exceptions that is unpacked
                    changed: str = mutate_code(piece, operator(), occurrence)
                    source = "".join((*lines[:first], changed.removeprefix(prefix), *lines[last:]))
                    yield first + line - prefix.count("\n"), source


def is_left_out(operator: str) -> bool:
    return operator.endswith(LEFT_OUT) or "BitOr_" in operator


def _pieces(tree: ast.Module | ast.ClassDef) -> Iterator[tuple[int, int, str]]:
    """The first line, from 0, and the end of each piece of a module, and what must stand before it to be parsed."""
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            yield from _pieces(node)
        elif node.end_lineno is not None:
            decorators = node.decorator_list if isinstance(node, ast.FunctionDef) else []
            first = min([node.lineno, *(each.lineno for each in decorators)])
            yield first - 1, node.end_lineno, "class _:\n" if node.col_offset else ""


def _omissions(original: str) -> Iterator[tuple[int, str]]:
    """Every statement replaced by `pass`, and every operand of `and` and `or` by what does not matter there."""
    for node in ast.walk(ast.parse(original)):
        if isinstance(node, ast.BoolOp):
            neutral = "True" if isinstance(node.op, ast.And) else "False"
            yield from ((operand.lineno, _replaced(original, operand, neutral)) for operand in node.values)
        is_text = isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        is_field = isinstance(node, ast.AnnAssign) and node.value is None
        if isinstance(node, ast.stmt) and not isinstance(node, KEPT_STATEMENTS) and not is_text and not is_field:
            yield node.lineno, _replaced(original, node, "pass")


def _replaced(original: str, node: ast.stmt | ast.expr, text: str) -> str:
    lines = original.encode().splitlines(keepends=True)
    assert node.end_lineno is not None
    before = b"".join(lines[: node.lineno - 1]) + lines[node.lineno - 1][: node.col_offset]
    after = lines[node.end_lineno - 1][node.end_col_offset :] + b"".join(lines[node.end_lineno :])
    return (before + text.encode() + after).decode()
