"""Tiny instances, one for each number: for searches and encoders, beside the joint search that tries everything."""

from dataclasses import replace

from carp_spec import Instance
from carp_spec.permutations import splitmix64
from carp_verify.optimum.joint_search import joint_states
from carproof.testing.random_instances import Draw, Mix, draw_instance
from carproof.testing.strategies import Sizes

MOST_STATES = 15_000
MIX = Mix(
    sizes=(3, 4, 5),
    robots=(2, 3, 4),
    capacities=(1, 1, 1, 2),
    durations=(1, 1, 2, 3),
    more=1,
    both_ways=True,
    goals_apart=True,
)
GROUPED = replace(MIX, groups=(1, 2, 2))
STOPPING = replace(MIX, robots=(1, 2, 3), stops=3, services=(0, 1, 2, 4), groups=(0, 0, 1))
TINY = Sizes(resources=4, robots=3, capacity=2, duration=2, release=2, pace=2)
"""The values that hypothesis draws where a test needs it to shrink."""


def case(number: int, mix: Mix = MIX) -> tuple[Instance, Draw]:
    """The first instance of a number's stream with few enough joint states, and further numbers of the stream."""
    draw = Draw(splitmix64(number))
    instance = draw_instance(draw, mix)
    while joint_states(instance) > MOST_STATES:
        instance = draw_instance(draw, mix)
    return instance, draw
