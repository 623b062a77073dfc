"""Instances to try planners on: the paper's grids, and warehouses with aisles. Equal options, equal instance."""

from carp_oracle.generate.fleet import Fleet
from carp_oracle.generate.grid import Grid, grid_instance
from carp_oracle.generate.options import Range, Traits
from carp_oracle.generate.warehouse import Warehouse, warehouse_instance

__all__ = ["Fleet", "Grid", "Range", "Traits", "Warehouse", "grid_instance", "warehouse_instance"]
