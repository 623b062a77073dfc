"""The picture in text of a finding of `carproof conform`."""

from carp_spec import Instance, Plan, Resource, ResourceGraph, Robot, Visit
from carproof.conform.reporting.drawing import drawing


def drawn(robots: int, leave: int) -> str:
    """Robots that are all in one resource until they leave it together."""
    fleet = tuple(Robot(f"r{at}", "a", "a") for at in range(robots))
    plans = tuple(Plan(robot.id, (Visit("a", at, leave),)) for at, robot in enumerate(fleet))
    return drawing(Instance(ResourceGraph((Resource("a"), Resource("b")), ()), fleet), plans)


def test_each_robot_has_its_own_symbol_that_the_legend_explains() -> None:
    *legend, _, _, row, other = drawn(12, 12).splitlines()
    symbols = [line[0] for line in legend if ": robot" in line]
    assert len(set(symbols)) == 12
    assert (row, other) == ("a 0***********.", "b .............")
    assert "tick" in legend[0]
    assert "* is several robots" in legend[1]
