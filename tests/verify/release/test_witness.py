"""Witnesses of grants, right ones and others nearly so, against robots that move one by one in all ways."""

from collections.abc import Iterator, Sequence
from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st
from tests.oracle.execution.test_release import QUESTIONS, Held, Naive, planned

from carp_spec import Instance, Plan
from carp_spec.permutations import splitmix64
from carp_verify.release.verify import Finish, Overfull, Places, Stuck, Witness, is_witness
from carproof.testing.random_instances import Draw


def shows(instance: Instance, plans: Sequence[Plan], held: Held, witness: Witness) -> bool:
    now, granted = ({plan.robot: each[end] for plan, each in zip(plans, held, strict=True)} for end in (0, 1))
    return is_witness(instance, plans, now, granted, witness)


def standing(places: Places) -> Held:
    """Robots that hold nothing but where they are."""
    return tuple((place, place) for place in places)


def moves(naive: Naive, places: Places) -> Iterator[tuple[int, Places]]:
    """The moves of one robot that there is room for: who moves, and where all are then."""
    for number, place in enumerate(places):
        after = (*places[:number], place + 1, *places[number + 1 :])
        held = standing(places)
        both = (*held[:number], (place, min(place + 1, len(naive.ways[number]) - 1)), *held[number + 1 :])
        if place < len(naive.ways[number]) - naive.parks and naive.has_room(both):
            yield number, after


def reached(naive: Naive, first: Places) -> set[Places]:
    """All places that robots get to together."""
    found, waiting = {first}, [first]
    while waiting:
        new = {after for _, after in moves(naive, waiting.pop())} - found
        found |= new
        waiting += new
    return found


def drive(naive: Naive, first: Places, draw: Draw) -> list[int]:
    """Who moves, chosen at random among those who can, until nobody can."""
    order = list[int]()
    while ways := list(moves(naive, first)):
        number, first = draw.one_of(ways)
        order.append(number)
    return order


def is_way(naive: Naive, first: Places, order: Sequence[int]) -> bool:
    for number in order:
        after = dict(moves(naive, first)).get(number)
        if after is None:
            return False
        first = after
    return all(place == len(way) - naive.parks for place, way in zip(first, naive.ways, strict=True))


def nearly(order: Sequence[int], draw: Draw, robots: int) -> list[int]:
    """The moves, or these with one left out, put first, made twice, or made by another."""
    changed = [*order]
    if order:
        place = draw.between(0, len(order) - 1)
        changes: Sequence[list[int]] = ([], [order[place]] * 2, [draw.between(0, robots - 1)])
        changed[place : place + 1] = draw.one_of(changes)
        changed = draw.one_of([[order[place], *order[:place], *order[place + 1 :]], changed])
    return draw.one_of([[*order], changed])


@given(st.integers(0, 2**32))
def test_moves_show_that_all_finish_if_there_is_room_for_each_and_for_the_grants(seed: int) -> None:
    for number in range(seed, seed + QUESTIONS):
        instance, solution = planned(number)
        draw = Draw(splitmix64(number))
        naive, robots = Naive(instance, solution.plans), [plan.robot for plan in solution.plans]
        held = naive.some_held(draw)
        granted = tuple(last for _, last in held)
        order = nearly(drive(naive, granted, draw), draw, len(robots))
        right = naive.has_room(held) and is_way(naive, granted, order)
        named = [robots[each] for each in order]
        assert shows(instance, solution.plans, held, Finish(tuple(named))) == right
        assert not shows(instance, solution.plans, held, Finish(("nobody", *named)))


@given(st.integers(0, 2**32))
def test_a_place_is_too_full_for_all_that_would_hold_it(seed: int) -> None:
    for number in range(seed, seed + QUESTIONS):
        instance, solution = planned(number)
        naive = Naive(instance, solution.plans)
        held = naive.some_held(Draw(splitmix64(number)))
        for constraint, limit in enumerate(instance.graph.constraints):
            members = {limit.id} if constraint < len(instance.graph.resources) else {*limit.resources}
            holders = tuple(
                plan.robot
                for plan, way, (at, last) in zip(solution.plans, naive.ways, held, strict=True)
                if members & {*way[max(at, 0) : last + 1]}
            )
            for size in range(len(holders) + 1):
                for some in combinations(holders, size):
                    right = some == holders and size > limit.capacity
                    assert shows(instance, solution.plans, held, Overfull(constraint, some)) == right
        assert not shows(instance, solution.plans, held, Overfull(len(instance.graph.constraints), ()))


@given(st.integers(0, 2**32))
def test_all_places_show_that_some_robots_never_finish_and_fewer_places_do_not(seed: int) -> None:
    for number in range(seed, seed + QUESTIONS):
        instance, solution = planned(number)
        draw = Draw(splitmix64(number))
        everyone = Naive(instance, solution.plans)
        held = everyone.some_held(draw)
        if not everyone.has_room(held):
            continue
        pairs = tuple(zip(solution.plans, held, strict=True))
        some = draw.one_of([each for size in range(1, len(pairs) + 1) for each in combinations(pairs, size)])
        plans, first = [plan for plan, _ in some], tuple(last for _, (_, last) in some)
        naive, robots = Naive(instance, plans), tuple(plan.robot for plan in plans)
        places = reached(naive, first)
        ended = {each for each in places if is_way(naive, each, ())}
        for states in (places, places - ended, places - {draw.one_of(sorted(places))}, places - {first}, set[Places]()):
            right = states == places and not ended
            assert shows(instance, solution.plans, held, Stuck(robots, frozenset(states))) == right
        twice = frozenset((*each, each[0]) for each in places)
        assert not shows(instance, solution.plans, held, Stuck((*robots, *robots[:1]), twice))
        assert not shows(
            instance, solution.plans, held, Stuck((*robots, "nobody"), frozenset((*each, 0) for each in places))
        )
