"""A field added to a class of the model is in its document, reader, writer and schema without another line."""

from dataclasses import dataclass, field
from typing import Annotated

import msgspec
import pytest

from carp_spec.documents.fields import all_converted, converted, describes
from carp_spec.shapes import Number


@dataclass(frozen=True, slots=True)
class Wheel:
    id: int
    teeth: Annotated[int, Number(1, "teeth")] = 1


@dataclass(frozen=True, slots=True)
class Cart:
    id: str | int
    label: str | None = None
    marks: tuple[str | int, ...] = ()
    wheels: tuple[Wheel, ...] = ()
    is_broken: bool = False
    handle: int = 0
    load: int = field(default=0, init=False)


def cart_document() -> type[msgspec.Struct]:
    """A class made now, by the functions as they are."""

    @describes(Cart, "handle")
    class CartDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
        """A cart."""

    return CartDocument


@pytest.mark.parametrize(
    ("cart", "text"),
    [
        (Cart("a"), '{"id":"a","is_broken":false}'),
        (Cart(1, "left", ("x", 2)), '{"id":1,"label":"left","marks":["x",2],"is_broken":false}'),
        (
            Cart(1, None, (), (Wheel(1), Wheel(2, 8)), True),
            '{"id":1,"wheels":[{"id":1,"teeth":1},{"id":2,"teeth":8}],"is_broken":true}',
        ),
    ],
)
def test_values_and_documents_are_made_from_each_other(cart: Cart, text: str) -> None:
    kind = cart_document()
    document = converted(cart, kind)
    assert msgspec.json.encode(document).decode() == text
    assert converted(msgspec.json.decode(text, type=kind), Cart) == cart
    assert all_converted([document, document], Cart) == (cart, cart)
    assert not all_converted([], Cart)


def test_the_schema_has_the_fields_and_the_least_of_numbers() -> None:
    schema = msgspec.json.schema(cart_document())["$defs"]
    assert {*schema["CartDocument"]["properties"]} == {"id", "label", "marks", "wheels", "is_broken"}
    assert schema["CartDocument"]["required"] == ["id"]
    assert schema["WheelDocument"]["properties"]["teeth"] == {"type": "integer", "minimum": 1, "default": 1}


def test_documents_stay_strict() -> None:
    for text, wrong in (
        ('{"id":1,"bell":1}', "unknown field `bell`"),
        ('{"id":1,"handle":1}', "unknown field `handle`"),
        ('{"id":1,"load":1}', "unknown field `load`"),
        ('{"id":1,"wheels":[{"id":1,"bell":1}]}', "unknown field `bell`"),
        ('{"id":1,"label":null}', "null"),
        ('{"wheels":[]}', "missing required field `id`"),
    ):
        with pytest.raises(msgspec.ValidationError, match=wrong):
            msgspec.json.decode(text, type=cart_document())
    document = converted(Cart("a", None, (), (Wheel(1),)), cart_document())
    for frozen in (document, *document.wheels):  # type: ignore[attr-defined]
        with pytest.raises(AttributeError):
            frozen.id = 2
