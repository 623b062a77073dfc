"""XML, YAML and JSON as trees whose values know their line, read within bounds.

Numbers stay text until they are asked for, and become fractions, so that no float decides anything.
"""

import io
import json
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from types import NoneType
from typing import Any, TypeAlias, cast

from carp_spec import Refusal
from carp_spec.rule import DESIGN
from carproof.input_rules import Code

MOST_BYTES = 64 * 2**20
MOST_VALUES = 2_000_000
DEEPEST = 100
LARGEST = 10**9
"""Of a number in a layout, in its own unit and in mm."""
METRE = 1000
"""In mm."""
RIGHT_LAYOUT = Code(
    "layout/file",
    f"A layout is XML without a document type, YAML or JSON, of at most {MOST_BYTES // 2**20} MiB, {MOST_VALUES} "
    f"values (those behind YAML's aliases counted each time) and {DEEPEST} levels, in a version that is read; each "
    "name is given once and each reference is to a name that is given; positions are numbers; lengths and speeds are "
    "above 0.",
    DESIGN,
)
_NULL = ("", "~", "null", "Null", "NULL")
_WHOLE = re.compile(r"0|-?[1-9][0-9]*")
_NUMBER = re.compile(r"[+-]?(?:\d{1,40}(?:\.\d{0,40})?|\.\d{1,40})(?:[eE][+-]?\d{1,2})?")

_ESCAPE = re.compile(r"\\(?:(u[dD][89abAB][0-9a-fA-F]{2}\\u[dD][c-fC-F][0-9a-fA-F]{2})|.)", re.DOTALL)

Value: TypeAlias = "str | list[Tree] | dict[str, Tree] | None"


@dataclass(frozen=True, slots=True)
class Tree:
    """A value: text, a list, a mapping, or null. The children of an element of XML are lists named `<tag>`.

    A text that is `quoted`, in YAML or JSON, is neither a number nor true, false or null. A mapping knows the names of
    the fields that it was `asked` for.
    """

    file: str
    line: int
    value: Value
    quoted: bool = False
    asked: set[str] | None = field(default=None, compare=False, repr=False)

    def refuse(self, message: str) -> Refusal:
        """The refusal of this value."""
        return RIGHT_LAYOUT.refuse(f"{self.file}:{self.line}", message)

    @property
    def fields(self) -> Mapping[str, "Tree"]:
        """All fields of a mapping; none where there is nothing."""
        return {name: self._fields[name] for name in [*self._fields] if self._has(name)}

    @property
    def _fields(self) -> Mapping[str, "Tree"]:
        if isinstance(self.value, dict):
            return self.value
        if self.value in (None, "", []):
            return {}
        raise self.refuse("it must be a mapping")

    def _has(self, name: str) -> bool:
        """Whether there is a field, which counts as asked for."""
        if self.asked is not None:
            self.asked.add(name)
        return name in self._fields

    @property
    def attributes(self) -> dict[str, "Tree"]:
        """The attributes of an element of XML."""
        return {name: each for name, each in self._fields.items() if not name.startswith("<") and self._has(name)}

    def is_unread(self, name: str) -> bool:
        """Whether nobody asked for a field."""
        return self.asked is not None and name not in self.asked

    @property
    def entries(self) -> list["Tree"]:
        """The entries of a list; none where there is nothing."""
        if isinstance(self.value, list):
            return self.value
        if self.value in (None, "", {}):
            return []
        raise self.refuse("it must be a list")

    @property
    def text(self) -> str:
        """The text, or a number as it is written."""
        if isinstance(self.value, str):
            return self.value
        raise self.refuse(f"it must be a text or a number, not {self.shown}")

    @property
    def quoted_text(self) -> str:
        """The text, which a number is not."""
        return self._quoted_or(False, "a text in quotes")

    @property
    def name(self) -> str:
        """The text in quotes, or the whole number, by which JSON names a thing."""
        whole = isinstance(self.value, str) and _WHOLE.fullmatch(self.value) is not None
        return self._quoted_or(whole, "a text in quotes or a whole number")

    def _quoted_or(self, allowed: bool, what: str) -> str:
        if isinstance(self.value, str) and (self.quoted or allowed):
            return self.value
        shown = self.value[:40] if isinstance(self.value, str) else self.shown
        raise self.refuse(f"it must be {what}, not {shown}")

    @property
    def number(self) -> Fraction:
        """The number, exactly as it is written."""
        if self.quoted:
            raise self.refuse(f"it must be a number, not the text {self.shown}")
        if not isinstance(self.value, str) or _NUMBER.fullmatch(self.value) is None:
            raise self.refuse(f"it must be a number, not {self.shown}")
        number = Fraction(self.value)
        if abs(number) > LARGEST:
            raise self.refuse(f"it must be between -{LARGEST} and {LARGEST}, not {self.shown}")
        return number

    @property
    def positive(self) -> Fraction:
        """The number, which is above 0."""
        if (number := self.number) <= 0:
            raise self.refuse(f"it must be above 0, not {self.shown}")
        return number

    @property
    def whole(self) -> int:
        """The number, which is whole and not below 0."""
        number = self.number
        if number < 0 or number.denominator != 1:
            raise self.refuse(f"it must be a whole number of at least 0, not {self.shown}")
        return int(number)

    @property
    def is_true(self) -> bool:
        """Whether it says true."""
        if self.quoted or self.value not in ("true", "True", "false", "False", "1", "0"):
            raise self.refuse(f"it must be true or false, not {'the text ' if self.quoted else ''}{self.shown}")
        return self.value in ("true", "True", "1")

    @property
    def shown(self) -> str:
        """The value for a message."""
        kind = {list: "a list", dict: "a mapping", NoneType: "null"}.get(type(self.value))
        return kind or repr(str(self.value)[:40])

    def __getitem__(self, name: str) -> "Tree":
        """The field of the name, which there must be."""
        if not self._has(name):
            raise self.refuse(f"it must have {name}")
        return self._fields[name]

    def first(self, count: int, missing: str, *, most: int | None = None) -> list["Tree"]:
        """The first entries, of which there must be so many, and no more than `most`."""
        if not count <= len(self.entries) <= (most or len(self.entries)):
            raise self.refuse(missing)
        return self.entries[:count]

    def get(self, *names: str) -> "Tree | None":
        """The first of these fields that there is."""
        return next((self._fields[name] for name in names if self._has(name)), None)

    def says(self, name: str) -> Value:
        """The value of a field, `None` if it is absent."""
        return self._fields[name].value if self._has(name) else None

    def metres(self, *names: str) -> Fraction | None:
        """The first of these fields that there is in mm, a number of metres above 0; `None` without one."""
        found = self.get(*names)
        return None if found is None else METRE * found.positive

    def all(self, *names: str) -> list["Tree"]:
        """The entries of the first of these fields that there is, none if all are absent."""
        found = self.get(*names)
        return [] if found is None else found.entries


def read_tree(data: bytes, file: str) -> Tree:
    """Read a document; its first character says whether it is XML, JSON or YAML."""
    whole = Tree(file, 1, "")
    if len(data) > MOST_BYTES:
        raise whole.refuse(f"it must have at most {MOST_BYTES // 2**20} MiB")
    text = RIGHT_LAYOUT.text(data, file)
    start = text.lstrip("\ufeff \t\r\n")[:1]
    if start == "<":
        return _xml(data, file)
    if start == "{":
        text = text.removeprefix("\ufeff")
        _require_json(text, file)
        text = _ESCAPE.sub(_unescaped, text.replace("\t", " "))
    return _yaml(text, file)


def _unescaped(escape: re.Match[str]) -> str:
    """A character beyond 16 bits, which JSON escapes in two halves and YAML does not."""
    return escape[0] if escape[1] is None else str(json.loads(f'"{escape[0]}"'))


def _require_json(text: str, file: str) -> None:
    def constant(name: str) -> None:
        line = text.count("\n", 0, text.find(name)) + 1
        raise Tree(file, line, name).refuse(f"it must be a number, not '{name}'")

    try:
        json.loads(text, parse_constant=constant, parse_float=str, parse_int=str)
    except json.JSONDecodeError as error:
        raise Tree(file, error.lineno, "").refuse(f"it must be JSON: {error.msg}") from None
    except RecursionError:
        raise Tree(file, 1, "").refuse(f"it must have at most {DEEPEST} levels") from None


@dataclass(slots=True)
class _Open:
    """A list or mapping that is being read."""

    tree: Tree
    anchor: str | None
    key: str | None
    size: int


def _yaml(text: str, file: str) -> Tree:  # noqa: C901, PLR0915 - one branch for each kind of event
    """Build the tree event by event: an alias is the same tree again, and counts with all its values."""
    import yaml  # noqa: PLC0415 - loaded only where used

    anchors: dict[str, tuple[Tree, int]] = {}
    stack = [_Open(Tree(file, 1, []), None, None, 0)]

    def put(tree: Tree, size: int) -> None:
        above = stack[-1]
        above.size += size
        if above.size > MOST_VALUES:
            raise tree.refuse(f"the file must have at most {MOST_VALUES} values, those behind aliases counted")
        if isinstance(above.tree.value, list):
            above.tree.value.append(tree)
        elif above.key is None:
            above.key = tree.text
            if above.key == "<<":
                raise tree.refuse("merge keys (<<) are not read")
        else:
            fields = cast("dict[str, Tree]", above.tree.value)
            if above.key in fields:
                raise tree.refuse(f"the field {above.key} must be given once")
            fields[above.key] = tree
            above.key = None

    try:
        event: Any  # the library's types are incomplete
        for event in yaml.parse(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader)):
            kind = type(event).__name__.removesuffix("Event")
            line = event.start_mark.line + 1
            anchor = getattr(event, "anchor", None)
            if kind == "Scalar":
                quoted = event.style in ("'", '"')
                put(tree := Tree(file, line, None if event.value in _NULL and not quoted else event.value, quoted), 1)
                if anchor:
                    anchors[anchor] = (tree, 1)
            elif kind in ("SequenceStart", "MappingStart"):
                value: Value = [] if kind == "SequenceStart" else {}
                stack.append(_Open(Tree(file, line, value, asked=set()), anchor, None, 1))
                if len(stack) > DEEPEST:
                    raise stack[-1].tree.refuse(f"the file must have at most {DEEPEST} levels")
            elif kind in ("SequenceEnd", "MappingEnd"):
                done = stack.pop()
                if done.anchor:
                    anchors[done.anchor] = (done.tree, done.size)
                put(done.tree, done.size)
            elif kind == "Alias":
                if anchor not in anchors:
                    raise Tree(file, line, "").refuse(f"the alias {anchor} must name an anchor that is complete")
                put(*anchors[anchor])
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        what = getattr(error, "problem", None) or getattr(error, "reason", "it cannot be read")
        raise Tree(file, 1 if mark is None else mark.line + 1, "").refuse(f"it must be YAML: {what}") from None
    documents = stack[0].tree.entries
    if len(documents) != 1:
        raise Tree(file, 1, "").refuse(f"the file must hold one document, not {len(documents)}")
    return documents[0]


def _xml(data: bytes, file: str) -> Tree:
    """Build the tree; a document type, and with it every entity, is refused before it is read."""
    from xml.sax import SAXParseException  # noqa: PLC0415 - loaded only where used
    from xml.sax.handler import ContentHandler  # noqa: PLC0415 - loaded only where used

    from defusedxml import DefusedXmlException  # noqa: PLC0415 - of an extra
    from defusedxml.sax import make_parser  # noqa: PLC0415 - of an extra

    found = Tree(file, 1, {})
    stack = [found]
    values = 0

    class Handler(ContentHandler):
        def startElement(self, name: str, attrs: Any) -> None:  # noqa: N802, ANN401 - the library's names
            nonlocal values
            line = self._locator.getLineNumber() or 1  # type: ignore[attr-defined]
            fields = {key: Tree(file, line, value) for key, value in attrs.items()}
            element = Tree(file, line, {"<>": Tree(file, line, name), **fields}, asked=set())
            values += 1 + len(fields)
            if values > MOST_VALUES or len(stack) > DEEPEST:
                raise element.refuse(f"the file must have at most {MOST_VALUES} values and {DEEPEST} levels")
            above = cast("dict[str, Tree]", stack[-1].value)
            above.setdefault(f"<{name}>", Tree(file, line, [])).entries.append(element)
            stack.append(element)

        def endElement(self, name: str) -> None:  # noqa: N802 - the library's name
            del name
            stack.pop()

        def characters(self, content: str) -> None:
            fields = cast("dict[str, Tree]", stack[-1].value)
            before = fields["text"].text if "text" in fields else ""
            if content.strip():
                fields["text"] = Tree(file, fields["<>"].line, before + content.strip())

    parser = make_parser()
    parser.forbid_dtd = True
    parser.setContentHandler(Handler())
    try:
        parser.parse(io.BytesIO(data))
    except SAXParseException as error:
        line = error.getLineNumber() or 1
        raise Tree(file, line, "").refuse(f"it must be XML: {error.getMessage()}") from None
    except LookupError:
        raise Tree(file, 1, "").refuse("its encoding must be UTF-8") from None
    except DefusedXmlException:
        line = data.count(b"\n", 0, max(0, data.find(b"<!"))) + 1
        raise Tree(file, line, "").refuse("a document type and entities are not allowed") from None
    return next(each for name, each in found.fields.items() if name != "text").entries[0]


def elements(tree: Tree, tag: str) -> Iterator[Tree]:
    """The children of an element that have the tag."""
    yield from tree.all(f"<{tag}>")
