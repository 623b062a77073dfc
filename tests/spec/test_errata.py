"""The figures in docs/explanation/errata.md."""

from fractions import Fraction
from math import factorial, perm, prod

from tests.spec.making import plan_of

from carp_spec import Instance, Resource, ResourceGraph, Robot
from carp_spec.neighbourhood_rules import distance


def test_the_count_of_replanned_robots_in_the_paper_has_one_round_too_many() -> None:
    for k, m in ((100, 4), (50, 6), (7, 2)):
        rounds = [k - 1 - i for i in range(1, m)]
        assert sum(rounds) == (m - 1) * (2 * k - m - 2) // 2
        assert sum([*rounds, k - m - 1]) == m * (2 * k - m - 3) // 2
    assert (sum([98, 97, 96, 95]), sum([98, 97, 96])) == (386, 291)


def test_the_counts_of_permutations_in_the_paper_are_those_of_the_last_round() -> None:
    def shared(size: int) -> int:
        return sum(perm(size, first) for first in range(1, size + 1))

    assert [size * factorial(size) for size in (4, 5, 6)] == [96, 600, 4320]
    assert [shared(size) for size in (4, 5, 6)] == [64, 325, 1956]
    every = [sum(size * factorial(size) for size in range(2, m + 1)) for m in (4, 5, 6)]
    assert every == [factorial(m + 1) - 2 for m in (4, 5, 6)] == [118, 718, 5038]
    reused = [sum(shared(size) for size in range(2, m + 1)) for m in (4, 5, 6)]
    assert reused == [83, 408, 2364]
    assert [round(100 * some / all_) for some, all_ in zip(reused, every, strict=True)] == [70, 57, 47]


def test_dividing_by_one_term_too_few_takes_the_farther_robot_for_the_nearer() -> None:
    graph = ResourceGraph((Resource("a", x=0, y=0), Resource("b", x=5, y=0), Resource("c", x=6, y=0)), ())
    robots = (Robot("new", "a", "a"), Robot("near", "b", "b"), Robot("far", "c", "c"))
    instance = Instance(graph, robots)
    new = plan_of("new", ("a", 0, 1))
    near, far = plan_of("near", ("b", 0, 1), ("b", 1, 2)), plan_of("far", ("c", 0, 10), ("c", 10, 11))
    ours = [distance(instance, new, plan) / 2**16 for plan in (near, far)]
    assert ours == [5, 6]
    papers = [mean * terms / (terms - 1) for mean, terms in zip(ours, (2, 11), strict=True)]
    assert papers == [10, Fraction(66, 10)]


def test_a_hundred_starts_drawn_with_replacement_are_hardly_ever_distinct() -> None:
    assert f"{float(prod(1 - Fraction(i, 400) for i in range(100))):.1e}" == "1.3e-06"
