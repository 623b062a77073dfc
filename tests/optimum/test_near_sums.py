"""Sums over robots are right in any order of adding, and near robots are added first."""

from collections.abc import Sequence
from itertools import chain

from hypothesis import given, settings
from hypothesis import strategies as st
from pysat.solvers import Cadical195
from tests.profiles import draws

from carp_optimum.sat.totalizer_order import groups_of_near, sum_of_near
from carp_verify.optimum.clauses import Formula
from carp_verify.optimum.robot_clauses import Node

NODES: Sequence[Node] = [(resource, tick) for resource in "abc" for tick in range(2)]

weights = st.lists(st.dictionaries(st.sampled_from(NODES), st.integers(1, 9)), min_size=1, max_size=7)


@settings(max_examples=draws(300))
@given(weights, st.data())
def test_the_sum_is_at_least_that_of_all_robots(weights: Sequence[dict[Node, int]], data: st.DataObject) -> None:
    formula = Formula()
    lengths = data.draw(st.lists(st.integers(0, 3), min_size=len(weights), max_size=len(weights)))
    numbers = [[formula.variable() for _ in range(length)] for length in lengths]
    values = [data.draw(st.integers(0, length)) for length in lengths]
    most = data.draw(st.integers(1, 12))
    total = sum_of_near(formula, numbers, groups_of_near(weights), most)
    assert len(total) == min(most, sum(lengths))
    given = [
        literal if position < value else -literal
        for number, value in zip(numbers, values, strict=True)
        for position, literal in enumerate(number)
    ]
    with Cadical195(bootstrap_with=formula.clauses) as solver:
        reached = min(most, sum(values))
        assert set(total[:reached]) <= set(solver.propagate(given)[1])
        assert reached == len(total) or solver.solve([*given, -total[reached]])


@settings(max_examples=draws(100))
@given(weights)
def test_each_round_adds_every_number_once(weights: Sequence[dict[Node, int]]) -> None:
    left = len(weights)
    for groups in groups_of_near(weights):
        assert sorted(chain.from_iterable(groups)) == list(range(left))
        assert [len(group) for group in groups] == [2] * (left // 2) + [1] * (left % 2)
        left = len(groups)
    assert left == 1
