"""Instances for trying planners: the paper's grids, and warehouses with aisles. Equal options give equal instances."""

from carproof.generate.fleet import Fleet
from carproof.generate.grid import Grid, grid_instance
from carproof.generate.headings import with_headings
from carproof.generate.options import Range, Traits
from carproof.generate.warehouse import Warehouse, warehouse_instance

__all__ = ["Fleet", "Grid", "Range", "Traits", "Warehouse", "grid_instance", "warehouse_instance", "with_headings"]
