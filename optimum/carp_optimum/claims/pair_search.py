"""The search for deadlines of two robots that are seen at ticks: which pairs are looked at, and which claims are kept.

`carp_optimum.claims.pair_constraints` finds the claims of a pair. They are true, so prices may count on them at once. A
certificate needs their refutations, which take longer to find. So only the claims that have a price after a climb are
proved; the others are dropped, and a later round finds them again where they are still broken.
"""

from collections import Counter
from collections.abc import Callable, Sequence
from itertools import chain, combinations
from typing import TypeAlias

import numpy as np

from carp_optimized.jit.kinds import IntTable, Longs
from carp_optimum.claims.pair_constraints import Pair, side_of, work_of
from carp_optimum.lagrangian.deadlines import Deadlines, Member
from carp_optimum.lagrangian.price_search import PriceSearch
from carp_optimum.sat.proving import short_refutation
from carp_verify.bound.rules import ContradictionError

STEPS = 120
PERIOD = 200  # steps; ways of the last `STEPS` among them are looked at
EVERY = 4  # step: the places in it are compared
MARGIN = 4  # ticks of delay above the largest of a robot's ways
LARGEST_DELAY = 30  # ticks of a robot of a pair
LARGEST_ENCODING = 2_000_000
MOST_WORK = 150_000_000  # pairs of states by ticks, in a round
MOST_DOUBLINGS = 6  # of a pair's work, by searches that found no claim
MOST_FOUND = 400  # claims in a round
LEAST_GAIN = 100  # one part of the best bound: what a round's claims must be broken by for another round
SLOW = 500  # one part of the best bound: claims about more ticks are searched for where a period gains less
LONGEST_REFUTATION = 300_000  # characters


Ways: TypeAlias = tuple[Longs, IntTable]
"""The robots' delays after a step, and their places, by robot and tick."""


class SightSearch:
    """Finds deadlines of pairs of robots for a search for prices."""

    def __init__(self, search: PriceSearch) -> None:
        self.search = search
        self.instance = search.instance
        self.most = min(LARGEST_DELAY, search.dual.delays - 1)
        self.without_proof: set[Sequence[Member]] = set()
        self.entries: dict[int, Longs] = {}
        self.searched: Counter[tuple[int, int]] = Counter()
        self.before = 0
        self.is_slow = False
        self.watched = 0
        self.ways: list[Ways] = []

    def round(self, check: Callable[[], None]) -> int:
        """Add claims that the ways near the best prices break, and return by how much, in parts of a tick; 0 if little.

        `check` may raise `TimeOver`; the claims found until then are added first.
        """
        search = self.search
        if not self.is_small:
            return 0
        ways = [(search.delays(), search.places()) for _ in search.wander(STEPS, check)]
        gained = self.add(ways, check)
        return gained if gained * LEAST_GAIN >= search.best else 0

    @property
    def is_small(self) -> bool:
        """Whether the tables of all robots are small enough."""
        wide = max(len(self.instance.graph.resources), self.search.dual.delays, self.search.horizon)
        return len(self.instance.robots) * wide <= LARGEST_ENCODING

    def watch(self, check: Callable[[], None]) -> None:
        """Look at the ways after a step of a climb; now and then add claims that the last ones break, and drop others.

        A claim that has no price after `PERIOD` steps is dropped. `check` may raise `TimeOver`.
        """
        search = self.search
        self.watched = self.watched % PERIOD + 1
        if self.watched > PERIOD - STEPS:
            self.ways.append((search.delays(), search.places()))
        if self.watched == PERIOD:
            ways, self.ways = self.ways, []
            search.drop_idle_deadlines()
            self.is_slow = (search.best - self.before) * SLOW < search.best
            self.before = search.best
            self.add(ways, check)

    def add(self, ways: Sequence[Ways], check: Callable[[], None]) -> int:
        """Add claims that these ways break, those that are found fastest first: by how much, in parts of a tick.

        On a tree, robots whose ways are short or cannot pass each other break claims most often, and have few states.
        A pair counts as twice the work for each search since its last claim, so that every pair has its turn.
        """
        search = self.search
        delays, at = (np.stack(each) for each in zip(*ways, strict=True))
        most = np.minimum(delays.max(axis=0) + MARGIN, self.most).tolist()
        known = {tuple(claim.members) for claim in search.deadlines} | self.without_proof
        pairs = pairs_in(at, len(self.instance.graph.resources))
        side = {each: side_of(search, each, at[:, each], most[each], self.entries) for each in {*chain(*pairs)}}
        work = {(one, other): work_of(search, side[one], side[other]) for one, other in pairs}
        chosen: list[Deadlines] = []
        gain = 0
        left = MOST_WORK
        try:
            for pair in sorted(work, key=lambda each: (work[each] << min(self.searched[each], MOST_DOUBLINGS), each)):
                check()
                left -= work[pair]
                if left < 0 or len(chosen) == MOST_FOUND:
                    break
                one, other = (side[each] for each in pair)
                self.searched[pair] += 1
                if one is None or other is None:
                    continue
                weight, members = Pair(search, (one, other), len(ways)).claim(self.is_slow, check)
                if weight > 0 and members not in known:
                    chosen.append(Deadlines(members))
                    gain += weight
                    del self.searched[pair]
        finally:
            search.add_deadlines(chosen)
        return gain * search.scale // len(ways)

    def prove(self, check: Callable[[], None]) -> None:
        """Prove the claims that have a price, the dearest first, and drop those without a proof.

        `check` may raise `TimeOver`; the claims proved until then are kept.
        """
        search = self.search
        if all(each.refutation for each in search.deadlines):
            return
        search.restore()
        kept = [number for number, each in enumerate(search.deadlines) if each.refutation]
        priced = {number: fee for number, fee in enumerate(search.fees.tolist()) if fee > 0 and number not in kept}
        try:
            for number in sorted(priced, key=lambda each: -priced[each]):
                members = search.deadlines[number].members
                search.deadlines[number] = Deadlines(members, self._refutation(search.deadlines[number], check))
                if search.deadlines[number].refutation:
                    kept.append(number)
                else:
                    self.without_proof.add(members)
        finally:
            search.keep_deadlines(kept)

    def _refutation(self, claim: Deadlines, check: Callable[[], None]) -> str:
        """The refutation of the claim's contrary, or nothing if it is too long."""
        try:
            return short_refutation(lambda: claim.formula(self.instance), check, LONGEST_REFUTATION)
        except ContradictionError:
            check()
            return ""


def pairs_in(at: IntTable, resources: int) -> set[tuple[int, int]]:
    """Pairs of robots that are in the same place at the same tick, in one step or in different ones."""
    places = at[::EVERY]
    _, robots, ticks = places.shape
    _, robot, tick = np.nonzero((places >= 0) & (places < resources))
    place = places[(places >= 0) & (places < resources)].astype(np.int64)
    cell, robot = np.divmod(np.unique((place * ticks + tick) * robots + robot), robots)
    groups = np.split(robot, np.flatnonzero(np.diff(cell)) + 1)
    return {pair for group in groups for pair in combinations(group.tolist(), 2)}
