"""A polish with many starts: rounds are shared, the better copies go on, and the result is the best of them."""

from dataclasses import replace
from typing import Any

from carp_optimized.improve.many_starts import polish_many
from carp_reference import plan, polish
from carp_spec import Carp, Instance, Plan, Resource, ResourceGraph, Robot, Solution, Visit, total_cost, violations_of

ROUNDS = 10


def lane(robots: int = 1) -> Instance:
    graph = ResourceGraph((Resource("a", capacity=robots), Resource("b", capacity=robots)), (("a", "b"),))
    return Instance(graph, tuple(Robot(f"r{number}", "a", "b") for number in range(robots)))


def waiting(instance: Instance, ticks: int) -> Solution:
    """The first robot arrives at the tick."""
    (robot,) = instance.robots
    return Solution.of(instance, (Plan(robot.id, (Visit("a", 0, ticks), Visit("b", ticks, ticks + 1))),))


class Recorder:
    """A polish whose total is given for each seed, and which records what it is asked for."""

    def __init__(self, totals: dict[int, int]) -> None:
        self.totals = totals
        self.asked: list[tuple[int, int | None, float | None, int]] = []

    def __call__(self, instance: Instance, solution: Solution, **options: Any) -> Solution:  # noqa: ANN401 - of any type
        seed, total = options["seed"], self.totals[options["seed"]]
        self.asked.append((total_cost(instance, solution.plans), options["iterations"], options["seconds"], seed))
        options["advance"](options["iterations"] or ROUNDS, 0, total)
        return waiting(instance, total)


def test_the_better_half_goes_on_from_where_it_is_and_the_last_gets_the_rest() -> None:
    recorder = Recorder({0: 9, 1: 7, 2: 8, 3: 6, 4: 5, 5: 4, 8: 3})
    seen: list[tuple[int, int, int]] = []
    instance = lane()
    after = polish_many(
        recorder, 4, instance, waiting(instance, 10), iterations=121, advance=lambda *at: seen.append(at)
    )
    assert total_cost(instance, after.plans) == 3
    assert recorder.asked == [
        (10, 10, None, 0),
        (10, 10, None, 1),
        (10, 10, None, 2),
        (10, 10, None, 3),
        (6, 20, None, 4),
        (7, 20, None, 5),
        (4, 41, None, 8),
    ]
    assert seen == [(10, 0, 9), (20, 0, 7), (30, 0, 7), (40, 0, 6), (60, 0, 5), (80, 0, 4), (121, 0, 3)]


def test_a_solution_that_leaves_robots_out_is_worse_than_any_that_does_not() -> None:
    instance = lane()
    nothing = Solution((), (), ("r0",))

    def improve(instance: Instance, solution: Solution, **options: Any) -> Solution:  # noqa: ANN401 - of any type
        return waiting(instance, 9) if options["seed"] == 1 else solution

    assert polish_many(improve, 2, instance, nothing, iterations=10).unplanned == ()


def test_many_starts_of_an_engine_give_the_same_lawful_plans_again() -> None:
    cells = tuple(Resource(name) for name in ("north", "east", "south", "west", "middle"))
    graph = ResourceGraph(cells, tuple((name, "middle") for name in ("north", "east", "south", "west")))
    ends = (("north", "south"), ("east", "west"), ("south", "north"))
    instance = Instance(graph, tuple(Robot(f"r{number}", *each) for number, each in enumerate(ends)))
    before = plan(instance, Carp())
    after = polish_many(polish, 4, instance, before, iterations=100)
    assert not list(violations_of(instance, after.plans))
    assert total_cost(instance, after.plans) <= total_cost(instance, before.plans)
    assert after == polish_many(polish, 4, instance, replace(before), iterations=100)
