"""The options of orders of VDA 5050."""

from dataclasses import dataclass

import click

from carproof.command_line.options import gathered
from carproof.formats.plans.vda5050 import VERSIONS, OrderSettings
from carproof.layouts.settings import millimetres, seconds


@dataclass(frozen=True, slots=True)
class OrderOptions:
    """The options that were given."""

    at: int | None
    since: int | None
    unit: str | None

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


order_options = gathered(
    "orders",
    OrderOptions,
    click.option("--at", type=click.IntRange(min=0), help="The tick at which orders are sent.  [default: 0]"),
    click.option("--since", type=click.IntRange(min=0), help="The tick of the orders that are updated."),
    click.option("--unit", help="The unit of positions in orders, like 1m.  [default: 1mm]"),
)
