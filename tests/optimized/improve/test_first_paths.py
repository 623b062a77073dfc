"""The first paths of a crowd: those that were missed get way, guides meet little, and turns find other paths."""

import itertools
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from carp_optimized.improve.checking import require_lawful
from carp_optimized.improve.crowds import FAR, Crowd, crowd_of, measure, ways_of
from carp_optimized.improve.guides import SLACK, guides_of
from carp_optimized.improve.improving import Improving, arrivals, paths_of
from carp_optimized.improve.lacam import RUNNING, Search
from carp_optimized.improve.stays import no_paths
from carp_optimized.jit.references import Native
from carp_spec import AfterGoal
from carproof.generate import Fleet, Grid, grid_instance


def crowd(side: int, robots: int, after_goal: AfterGoal = "park", seed: int = 0) -> Crowd:
    """Robots on a full square grid, measured."""
    made = crowd_of(
        replace(
            grid_instance(Grid(width=side, height=side, map=20), Fleet(robots=robots, seed=seed)), after_goal=after_goal
        )
    )
    measure(Native(made), np.arange(robots, dtype=np.int32), 0, robots, FAR)
    return made


def planned_in_order(made: Crowd, seed: int = 0) -> Improving:
    """A pass of prioritized planning."""
    robots = made.start.size
    improving = Improving(made, no_paths(robots, 200), seed)
    improving.plan_first(np.argsort(ways_of(made), kind="stable").astype(np.int32), lambda: True)
    return improving


def shortest_way(made: Crowd, robot: int) -> list[int]:
    """A shortest way, always by the first edge that leads on."""
    way = [int(made.start[robot])]
    distance = made.distance[robot]
    while way[-1] != made.goal[robot]:
        targets = made.target[made.first[way[-1]] : made.first[way[-1] + 1]].tolist()
        way.append(next(each for each in targets if distance[each] < distance[way[-1]]))
    return way


def meetings(ways: list[list[int]]) -> int:
    """How often one is in a place where another is at that tick."""
    uses = Counter(use for way in ways for use in enumerate(way))
    return uses.total() - len(uses)


@pytest.mark.parametrize("after_goal", ["park", "vanish"])
@pytest.mark.parametrize("seed", range(5))
def test_robots_that_a_pass_missed_get_way_from_others(after_goal: AfterGoal, seed: int) -> None:
    made = crowd(16, 120, after_goal, seed)
    improving = planned_in_order(made, seed)
    assert after_goal == "vanish" or (improving.rounds.paths.size == 0).any()
    paths = improving.make_way(lambda _: True)
    assert paths.size.all()
    require_lawful(made, paths)


def test_the_fewest_wait_where_it_is_given_up() -> None:
    made = crowd(8, 50)
    improving = planned_in_order(made)
    missing = int((improving.rounds.paths.size == 0).sum())
    asked = iter(range(20))
    paths = improving.make_way(lambda _: next(asked, 20) < 20)
    assert (paths.size == 0).sum() <= missing
    kept = paths.size > 0
    rest = made._replace(start=made.start[kept], goal=made.goal[kept], distance=made.distance[kept])
    require_lawful(rest, type(paths)(*(each[kept] for each in paths)))


@pytest.mark.parametrize("after_goal", ["park", "vanish"])
def test_guides_are_ways_and_plans_along_them_arrive_earlier(after_goal: AfterGoal) -> None:
    made = crowd(24, 250, after_goal)
    guides = guides_of(made, lambda: True)
    ways = [guides.way[first:][:size].tolist() for first, size in zip(guides.first, guides.size, strict=True)]
    assert 6 * meetings(ways) < meetings([shortest_way(made, robot) for robot in range(250)])
    for robot in range(250):
        way = ways[robot]
        assert way[0] == made.start[robot]
        assert way[-1] == made.goal[robot]
        assert len(way) - 1 <= ways_of(made)[robot] + SLACK
        for place, to in itertools.pairwise(way):
            assert to in made.target[made.first[place] : made.first[place + 1]]
    totals = []
    for each in (None, guides):
        search = Search(made, 0, each)
        while search.outcome == RUNNING:
            search.go(8)
        assert search.ways is not None
        paths = paths_of(search.ways)
        require_lawful(made, paths)
        totals.append(int(arrivals(paths).sum()))
    assert totals[1] < totals[0]


def test_turns_find_other_paths_that_arrive_as_early() -> None:
    made = crowd(12, 1)
    made.start[0], made.goal[0] = 0, 143
    measure(Native(made), np.arange(1, dtype=np.int32), 0, 1, FAR)
    found = set()
    for seed in range(30):
        improving = Improving(made, planned_in_order(made).rounds.paths, seed)
        improving.begin(lambda: True)
        improving.play(1, 1 << 15, turning=True)
        size = int(improving.rounds.paths.size[0])
        assert improving.total == ways_of(made)[0]
        found.add(tuple(improving.rounds.paths.place[0, :size].tolist()))
    assert len(found) > 5
