"""The dependency graph as a picture: a bar for each visit, an arrow for each wait, the cycle in red."""

from tests.oracle.viewing import SVG, picture_of

from carp_reference import plan
from carp_reference.execution import order_of
from carp_spec import Carp, Instance, Plan, Resource, ResourceGraph, Robot, Solution, Visit
from carproof.generate import Fleet, Grid, grid_instance
from carproof.viewer.dependency_picture import dependency_still

RING = ("a", "b", "c", "d")
GRAPH = ResourceGraph(tuple(map(Resource, RING)), tuple((RING[at - 1], RING[at]) for at in range(4)))


def drawn(instance: Instance, solution: Solution) -> str:
    return dependency_still(order_of(instance, solution), "town").decode()


def moving(starts: str) -> tuple[Instance, Solution]:
    """Robots that all go one place on at tick 1."""
    ways = [(start, RING[(RING.index(start) + 1) % 4]) for start in starts]
    robots = tuple(Robot(f"r{at}", *way) for at, way in enumerate(ways))
    plans = tuple(Plan(f"r{at}", (Visit(start, 0, 1), Visit(goal, 1, 2))) for at, (start, goal) in enumerate(ways))
    return Instance(GRAPH, robots), Solution(plans, tuple(robot.id for robot in robots))


def arrows(still: str, kind: str) -> int:
    """How many arrows the picture has in the group, each with its head."""
    paths = picture_of(still).findall(f".//{SVG}g[@class='{kind}']/{SVG}path")
    lines, heads = (
        "".join(each.get("d", "") for each in paths if each.get("class") == name) for name in ("arrow", "head")
    )
    assert lines.count("M") == heads.count("z")
    return lines.count("M")


def test_a_rotation_of_four_is_a_circle_of_red_arrows() -> None:
    still = drawn(*moving("abcd"))
    assert (arrows(still, "waits"), arrows(still, "cycle")) == (0, 4)


def test_each_visit_is_a_bar_that_says_its_ticks_and_slack() -> None:
    picture = picture_of(drawn(*moving("ab")))
    titles = [each.text for each in picture.findall(f".//{SVG}g[@class='visit']/{SVG}title")]
    assert titles == ["a [0, 1), slack 0", "b [1, 2), slack any", "b [0, 1), slack 0", "c [1, 2), slack any"]
    assert [each.text for each in picture.findall(f".//{SVG}text[@class='row-name']")] == ["r0", "r1"]


def test_every_wait_of_thirty_robots_is_an_arrow() -> None:
    instance = grid_instance(Grid(width=10, height=10, map=12), Fleet(robots=30, seed=3))
    order = order_of(instance, plan(instance, Carp()))
    still = dependency_still(order, "town").decode()
    waits = [edge for edge in order.edges if edge.kind == "order"]
    assert arrows(still, "waits") + arrows(still, "cycle") == len(waits) > 100
    assert still == dependency_still(order, "town").decode()
