"""The search for cuts: groups of robots that cost more together than they do, on average, near the best prices.

First it tries pairs of robots that are in each other's way near the best prices, those most often in the way before the
others; then groups that are already cuts, with one robot more. It searches for the optimum of each group
(`carp_optimum.sat.core_guided`). A lower bound on that optimum is a cut if the robots' average costs are below it.
"""

from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import combinations, count

from carp_optimum.lagrangian.price_search import PriceSearch
from carp_optimum.sat.core_guided import core_guided
from carp_optimum.sat.proving import refutation
from carp_optimum.sat.solver import NANOSECONDS, Deadline, TimeOver
from carp_spec import Instance, Refusal
from carp_spec.documents.bounds import CutDocument
from carp_verify.bound.cuts import group_of
from carp_verify.optimum.encoding import beat_formula

LOOKS = 400  # of the search for a group's optimum at its clock
STEPS = 120
EVERY = 6
LARGEST_GROUP = 8
TRIED_PAIRS = 150  # groups in a round
TRIED_LARGER = 50
LONGEST_REFUTATION = 1_000_000  # characters
LEAST_SURPLUS = 20  # one part of a tick

Members = tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Cut:
    """A group, robots by position, and the certificate of its least total, without multiplier."""

    members: Members
    document: CutDocument


class CutSearch:
    """Finds cuts for a search for prices; `known` has the groups that were tried, with their results."""

    def __init__(self, search: PriceSearch) -> None:
        self.search = search
        self.instance = search.instance
        self.known: dict[Members, Cut | None] = {}
        self.cuts: list[Cut] = []
        self.is_exhausted = False

    def round(self, check: Callable[[], None]) -> int:
        """Add the cuts that the average costs near the best prices break, and return by how much, in parts of a tick.

        Afterwards `is_exhausted` is whether all candidate groups have been tried.
        """
        self.is_exhausted = True
        meetings: Counter[Members] = Counter()
        steps = count()

        def look() -> None:
            check()
            if next(steps) % EVERY == 0:
                meetings.update(meeting(self.search))

        delays = self.search.wander(STEPS, self.search.scale // 4, look)
        requests = self.search.market.requests
        costs = (requests.earliest - requests.release) * STEPS + delays.sum(axis=0)
        broken: list[tuple[int, Cut]] = []
        for members in self._groups(meetings):
            cut = self._cut(members, check)
            if cut is not None and cut not in self.cuts:
                surplus = STEPS * cut.document.least - int(costs[list(members)].sum())
                if surplus * LEAST_SURPLUS > STEPS:
                    broken.append((surplus, cut))
        return self._take(broken) * self.search.scale // STEPS

    def _take(self, broken: list[tuple[int, Cut]]) -> int:
        """Add the cuts that are broken most and have no robot in common."""
        taken: set[int] = set()
        total = 0
        chosen = []
        for surplus, cut in sorted(broken, key=lambda each: (-each[0], each[1].members)):
            if taken.isdisjoint(cut.members):
                taken.update(cut.members)
                total += surplus
                chosen.append(cut)
        self.cuts.extend(chosen)
        self.search.add_cuts([(cut.members, cut.document.least) for cut in chosen])
        return total

    def _groups(self, meetings: Counter[Members]) -> Iterator[Members]:
        """Groups to try, in order: those known, then pairs, then cuts with one robot more."""
        yield from [members for members, cut in self.known.items() if cut is not None]
        pairs = [pair for pair, _ in sorted(meetings.items(), key=lambda each: (-each[1], each[0]))]
        near: dict[int, list[int]] = defaultdict(list)
        for one, other in pairs:
            near[one].append(other)
            near[other].append(one)
        larger = [
            tuple(sorted({*cut.members, robot}))
            for cut in self.cuts
            if len(cut.members) < LARGEST_GROUP
            for robot in dict.fromkeys(other for member in cut.members for other in near[member][:4])
            if robot not in cut.members
        ]
        for groups, most in ((pairs, TRIED_PAIRS), (larger, TRIED_LARGER)):
            fresh = [members for members in dict.fromkeys(groups) if members not in self.known]
            self.is_exhausted &= len(fresh) <= most
            yield from fresh[:most]

    def _cut(self, members: Members, check: Callable[[], None]) -> Cut | None:
        if members not in self.known:
            self.known[members] = prove(self.instance, members, check)
        return self.known[members]


def meeting(search: PriceSearch) -> set[Members]:
    """The pairs of robots that are in each other's way in the cheapest ways: in one place or on one move's way."""
    present: dict[tuple[int, ...], list[int]] = defaultdict(list)
    ways = search.market.ways
    for robot, visits in enumerate(ways.length.tolist()):
        places = ways.resource[robot, :visits].tolist()
        enters = ways.enter[robot, :visits].tolist()
        for place, enter, leave in zip(places, enters, [*enters[1:], enters[-1] + 1] if enters else [], strict=True):
            for tick in range(enter, min(leave, search.horizon)):
                present[place, tick].append(robot)
        for source, target, tick in zip(places, places[1:], enters[1:], strict=False):
            present[min(source, target), max(source, target), tick].append(robot)
    return {pair for robots in present.values() if len(robots) > 1 for pair in combinations(sorted(set(robots)), 2)}


def prove(instance: Instance, members: Members, check: Callable[[], None]) -> Cut | None:
    """A lower bound on the total of some of the robots, above that of their shortest paths, with its proof."""
    looks = count()

    def clock() -> int:
        check()
        return next(looks) * NANOSECONDS

    robots = tuple(instance.robots[position].id for position in members)
    group = group_of(instance, robots)
    try:
        best = core_guided(group, LOOKS, clock)
        check()
        if best.shortest is None or best.lower <= best.shortest:
            return None
        formula = beat_formula(group, best.lower, best.evidence).formula
        lines = refutation(formula, Deadline(LOOKS, clock))
    except (TimeOver, Refusal):
        check()
        return None
    if len(lines) > LONGEST_REFUTATION:
        return None
    evidence = best.evidence
    return Cut(members, CutDocument(robots, best.lower, 0, evidence.horizons, evidence.order, lines))
