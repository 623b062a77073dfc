"""The picture in text of a finding of `carproof conform`."""

from carp_spec import Group, Instance, Plan, Resource, ResourceGraph, Robot, Stop, Visit
from carproof.conform.reporting.drawing import drawing, map_drawing


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


def test_the_map_names_stops_and_groups() -> None:
    graph = ResourceGraph((Resource("a"), Resource("b")), (("a", "b"),), groups=(Group("g", ("a", "b"), 2),))
    text = map_drawing(Instance(graph, (Robot("r", "a", stops=(Stop("b"), Stop("a"))),)))
    assert "robot r goes from a to b to a" in text
    assert "group g, capacity 2: a, b" in text
