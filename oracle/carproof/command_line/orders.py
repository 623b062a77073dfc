"""The options of orders of VDA 5050."""

from collections.abc import Callable
from dataclasses import dataclass, fields
from functools import wraps
from typing import Any, TypeVar, cast

import click

from carproof.formats.plans.vda5050 import VERSIONS, OrderSettings
from carproof.layouts.settings import millimetres, seconds

F = TypeVar("F", bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class OrderOptions:
    """The options that were given."""

    at: int | None
    since: int | None
    unit: str | None

    @property
    def given(self) -> str | None:
        """The first of them, if any."""
        return next((f"--{each.name}" for each in fields(self) if getattr(self, each.name) is not None), None)

    def settings(self, format: str, tick: str | None) -> OrderSettings:
        """The settings of orders in a format, with the time of a tick."""
        default = OrderSettings()
        return OrderSettings(
            self.at or 0,
            self.since,
            VERSIONS[format],
            default.tick if tick is None else seconds(tick),
            default.unit if self.unit is None else millimetres(self.unit, "unit"),
        )


def order_options(function: F) -> F:
    """The options; the command gets them as `orders`."""

    @wraps(function)
    def command(**options: Any) -> object:  # noqa: ANN401 - the command's own
        taken = {each.name: options.pop(each.name) for each in fields(OrderOptions)}
        return function(orders=OrderOptions(**taken), **options)

    wrapped: Any = command
    for option in (
        click.option("--unit", help="The unit of positions in orders, like 1m.  [default: 1mm]"),
        click.option("--since", type=click.IntRange(min=0), help="The tick of the orders that are updated."),
        click.option("--at", type=click.IntRange(min=0), help="The tick at which orders are sent.  [default: 0]"),
    ):
        wrapped = option(wrapped)
    return cast("F", wrapped)
