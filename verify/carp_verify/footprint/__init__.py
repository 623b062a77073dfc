"""Vehicles of a size keep apart: recomputed from the positions and the plans alone, in whole numbers."""
