"""A field added to a class of the model is in its document, reader, writer and schema without another line."""

from dataclasses import dataclass
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


@describes(Cart)
class CartDocument(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """A cart."""


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
    document = converted(cart, CartDocument)
    assert msgspec.json.encode(document) == msgspec.json.encode(msgspec.json.decode(text, type=CartDocument))
    assert msgspec.json.decode(msgspec.json.encode(document)) == msgspec.json.decode(text)
    assert converted(msgspec.json.decode(text, type=CartDocument), Cart) == cart
    assert all_converted([document, document], Cart) == (cart, cart)
    assert not all_converted([], Cart)


def test_the_schema_has_the_fields_and_the_least_of_numbers() -> None:
    schema = msgspec.json.schema(CartDocument)["$defs"]
    assert {*schema["CartDocument"]["properties"]} == {"id", "label", "marks", "wheels", "is_broken"}
    assert schema["CartDocument"]["required"] == ["id"]
    assert schema["WheelDocument"]["properties"]["teeth"] == {"type": "integer", "minimum": 1, "default": 1}


def test_documents_stay_strict() -> None:
    with pytest.raises(msgspec.ValidationError, match="unknown"):
        msgspec.json.decode('{"id":1,"is_broken":false,"bell":1}', type=CartDocument)
    with pytest.raises(msgspec.ValidationError, match="null"):
        msgspec.json.decode('{"id":1,"label":null}', type=CartDocument)
