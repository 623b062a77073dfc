"""The two planners against each other on random instances, until the first difference, which is made small."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import carp_optimized
import carp_reference
from carp_spec import Carp, Greedy, Instance, LongestFirst, Neighbourhood, Planner, RobotId, Shuffled, Solution

if TYPE_CHECKING:
    from hypothesis.strategies import SearchStrategy

LARGEST_SEED = 2**64 - 1


@dataclass(frozen=True, slots=True)
class Difference:
    """What was asked, and the two answers: `plan` where there is no robot, else `add` to `before` at `now`."""

    instance: Instance
    planner: Planner
    robot: RobotId | None
    before: Solution | None
    now: int
    reference: Solution
    optimized: Solution


def neighbourhoods() -> "SearchStrategy[Neighbourhood]":
    """Options of the neighbourhood planner, all mixed."""
    from hypothesis import strategies as st  # noqa: PLC0415 - slow to load

    return st.builds(
        Neighbourhood,
        m=st.integers(1, 5),
        sample=st.none() | st.integers(1, 8),
        seed=st.integers(0, LARGEST_SEED),
        baseline=st.booleans(),
        fallback=st.none() | st.integers(1, 3),
    )


def planners() -> "SearchStrategy[Planner]":
    """Planners that both engines have."""
    from hypothesis import strategies as st  # noqa: PLC0415 - slow to load

    orders = st.builds(Shuffled, attempts=st.integers(1, 4), seed=st.integers(0, LARGEST_SEED))
    return st.one_of(neighbourhoods(), st.sampled_from([Carp(), LongestFirst(), Greedy()]), orders)


def first_difference(examples: int, seed: int, advance: Callable[[], None] = lambda: None) -> Difference | None:
    """Plan that many random instances, and add a robot to as many fleets under way; the smallest difference found."""
    import hypothesis  # noqa: PLC0415 - slow to load
    from hypothesis import strategies as st  # noqa: PLC0415

    from carproof.strategies import Sizes, fleets_under_way, instances  # noqa: PLC0415

    sizes = Sizes(resources=6, robots=6)
    found: list[Difference] = []
    options = hypothesis.settings(
        max_examples=examples,
        deadline=None,
        database=None,
        derandomize=False,
        suppress_health_check=list(hypothesis.HealthCheck),
        report_multiple_bugs=False,
    )

    def compare(difference: Difference) -> None:
        advance()
        if difference.reference != difference.optimized:
            found.append(difference)
            raise AssertionError

    @hypothesis.seed(seed)
    @options
    @hypothesis.given(
        st.one_of(st.tuples(instances(sizes), planners()), st.tuples(fleets_under_way(sizes), neighbourhoods()))
    )
    def agree(case: tuple[object, Planner]) -> None:
        subject, planner = case
        compare(ask(subject, planner))

    try:
        agree()
    except AssertionError:
        return found[-1]
    return None


def ask(subject: object, planner: Planner) -> Difference:
    """Ask both engines."""
    from carproof.strategies import FleetUnderWay  # noqa: PLC0415 - slow to load

    if isinstance(subject, Instance):
        answers = carp_reference.plan(subject, planner), carp_optimized.plan(subject, planner)
        return Difference(subject, planner, None, None, 0, *answers)
    assert isinstance(subject, FleetUnderWay)  # noqa: S101 - a promise of ours
    assert isinstance(planner, Neighbourhood)  # noqa: S101
    question = (subject.instance, subject.solution, subject.robot, subject.now, planner)
    answers = carp_reference.add(*question), carp_optimized.add(*question)
    return Difference(subject.instance, planner, subject.robot, subject.solution, subject.now, *answers)
