"""Bounds with robots that are seen at a tick: at most the optimum, and decided alike in Python and by the kernel."""

from collections.abc import Iterator
from functools import cache
from itertools import chain, combinations

import msgspec
import pytest
from tests.verify.bound.examples import completed
from tests.verify.kernel.program import check_bound, served
from tests.verify.optimum.models import has_model
from tests.verify.optimum.tiny import case

from carp_optimum.bound import lower_bound
from carp_optimum.deadline import Deadline
from carp_optimum.sat.proving import refutation
from carp_spec import Instance, Robot, RobotId
from carp_spec.documents.bounds import BoundDocument, DeadlinesDocument, Sight
from carp_spec.permutations import shuffle
from carp_verify.bound.cuts import formula_of_deadlines
from carp_verify.bound.rules import LARGEST_FORMULA
from carp_verify.bound.verify import verify_bound
from carp_verify.optimum.encoding import Encoding
from carp_verify.optimum.joint_search import least_total_cost
from carproof.testing.random_instances import Draw

_kernel = pytest.fixture(scope="module")(served)

CASES = 300
SCALE = 4


def sight_of(instance: Instance, robot: Robot, draw: Draw) -> tuple[int, Sight]:
    """A deadline of the robot, a tick at which it is seen, and a few places."""
    earliest = next(each.earliest for each in Encoding(instance).robots if each.robot == robot)
    places = shuffle([resource.id for resource in instance.graph.resources], draw.stream)[: draw.between(0, 2)]
    return earliest + draw.between(-1, 1), (robot.release + draw.between(0, 5), tuple(places))


def sights_of(instance: Instance, robot: Robot, draw: Draw) -> Iterator[tuple[RobotId, int, Sight]]:
    """One deadline of the robot, or two: it is seen later by the second."""
    drawn = [sight_of(instance, robot, draw) for _ in range(draw.between(1, 2))]
    for _, (tick, seen) in sorted({seen[0]: (tick, seen) for tick, seen in drawn}.items()):
        yield robot.id, max(0, tick), seen


def deadlines_of(instance: Instance, draw: Draw) -> Iterator[DeadlinesDocument]:
    """Deadlines of two robots that are seen, which they cannot all keep, with their refutations."""
    for pair in combinations(instance.robots, 2):
        for _ in range(16):
            names, ticks, seen = zip(*chain(*(sights_of(instance, robot, draw) for robot in pair)), strict=True)
            unproved = DeadlinesDocument(names, ticks, 0, "", seen)
            formula = formula_of_deadlines(instance, unproved, LARGEST_FORMULA)
            if not has_model(formula):
                yield msgspec.structs.replace(unproved, refutation=refutation(formula, Deadline(60)))


def best_with(instance: Instance, certificate: BoundDocument, deadlines: DeadlinesDocument) -> BoundDocument:
    """The certificate with the deadlines too, at the price at which it proves most."""
    priced = [msgspec.structs.replace(deadlines, price=price) for price in range(0, 3 * SCALE, 2)]
    bounds = [
        completed(instance, msgspec.structs.replace(certificate, deadlines=(*certificate.deadlines, each)))
        for each in priced
    ]
    return max(bounds, key=lambda each: sum(least or 0 for _, least in each.robots) - worth(each))


def worth(certificate: BoundDocument) -> int:
    """The most that robots pay for their deadlines."""
    return sum(each.price * (len(each.robots) - 1) for each in certificate.deadlines)


@cache
def found() -> list[tuple[Instance, BoundDocument]]:
    """Tiny instances with certificates of robots that are seen, whose deadlines are priced one after the other."""
    certificates = []
    for number in range(CASES):
        instance, draw = case(number)
        least = None if Encoding(instance).wayless else least_total_cost(instance)
        if least is not None and least > Encoding(instance).shortest:
            plain = msgspec.structs.replace(lower_bound(instance, steps=0), resources=(), exchanges=(), scale=SCALE)
            certificate = completed(instance, plain)
            for deadlines in deadlines_of(instance, draw):
                better = best_with(instance, certificate, deadlines)
                certificate = better if better.deadlines[-1].price > 0 else certificate
            if certificate.deadlines:
                certificates.append((instance, certificate))
    return certificates


def test_a_bound_with_robots_that_are_seen_is_verified_and_at_most_the_optimum() -> None:
    tight = 0
    for instance, certificate in found():
        least = least_total_cost(instance)
        bound = verify_bound(instance, certificate)
        assert least is not None
        assert bound <= least
        tight += bound == least and bound > lower_bound(instance, steps=0).bound
    assert tight > 4


def test_robots_are_seen_more_than_once() -> None:
    priced = [deadlines for _, certificate in found() for deadlines in certificate.deadlines]
    assert sum(len(each.robots) > len(set(each.robots)) for each in priced) > 20


@pytest.mark.usefixtures("_kernel")
def test_the_kernel_accepts_bounds_with_robots_that_are_seen() -> None:
    bounds = [certificate.bound for _, certificate in found()]
    assert [check_bound(*each).get("bound") for each in found()] == bounds
    assert len(bounds) > 20


@pytest.mark.usefixtures("_kernel")
def test_the_kernel_refuses_claims_that_are_a_part_of_a_tick_too_high() -> None:
    forged = []
    for instance, certificate in found():
        for position, (name, least) in enumerate(certificate.robots):
            robots = list(certificate.robots)
            robots[position] = (name, (least or 0) + 1)
            forged.append((instance, msgspec.structs.replace(certificate, robots=tuple(robots))))
    assert {check_bound(*each).get("rule") for each in forged} == {"bound/robots"}
