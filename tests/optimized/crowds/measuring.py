"""Crowds on grids, with the distances of all their robots."""

from dataclasses import replace

import numpy as np

from carp_optimized.crowds.crowd import Crowd, crowd_of
from carp_optimized.crowds.distances import measure
from carp_optimized.jit.references import Native
from carp_spec import AfterGoal, Instance
from carproof.generate import Fleet, Grid, grid_instance


def on_grid(side: int, robots: int, after_goal: AfterGoal = "park", seed: int = 0, map: int = 20) -> Instance:
    """Robots on a square grid, a full one or another of the paper's maps."""
    made = grid_instance(Grid(width=side, height=side, map=map), Fleet(robots=robots, seed=seed))
    return replace(made, after_goal=after_goal)


def measured(instance: Instance) -> Crowd:
    """The crowd of the instance, in which the distances of all robots are known."""
    crowd = crowd_of(instance)
    measure(Native(crowd), np.arange(crowd.start.size, dtype=np.int32), 0, crowd.start.size)
    return crowd
