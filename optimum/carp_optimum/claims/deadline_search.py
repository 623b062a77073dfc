"""The search for deadlines: delays of a group of robots that are too small for all of them together.

Near the best prices, a robot's ways have different delays. Each robot is allowed a delay that only a certain share of
its ways exceeds, and a solver is asked whether all robots can keep these delays together (the clauses are those of
`carp_optimum.sat.core_guided`, conflict by conflict). If not, it names robots that cannot: a core. A core whose shares
add up to less than 1 is broken near the best prices, since one of its robots is late in all plans. The core is made
small, its delays large, and it is proved on its own: the clauses of each robot hold only where that is assumed, so
nothing else follows from the robots outside. Source: the implicit hitting sets of Davies and Bacchus 2011, with the
prices in place of the hitting set.
"""

from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import closing
from typing import TypeAlias

import numpy as np

from carp_optimized.jit.kinds import Longs
from carp_optimized.state.arrays import NONE
from carp_optimum.lagrangian.deadlines import Deadlines, Member
from carp_optimum.lagrangian.price_search import PriceSearch
from carp_optimum.sat.proving import short_refutation
from carp_optimum.sat.solver import Solver
from carp_verify.optimum.clauses import Clause, Formula, Literal
from carp_verify.optimum.encoding import Conflict, Encoding, Exchange, violated

STEPS = 120
SHARES = (0, 12, 24, 36, 48, 60, 80)
"""The largest numbers of steps, of all `STEPS`, in which a robot is later than it is allowed."""
ENOUGH = 110
"""The most steps in which robots of a group are late: one of them would have to be in each of `STEPS`."""
LARGEST_TO_RAISE = 2 * STEPS
"""The most steps in which robots of a core are late whose delays are made larger, so that they are late in fewer."""
LARGEST_ENCODING = 2_000_000
"""Robots times resources, or times delays, beyond which no deadlines are searched for, as tables would be large."""
LARGEST_DELAYS = 300
"""The sum of the robots' largest delays near the best prices, beyond which no deadlines are searched for.

On a spanning tree they are larger, and the formulas so much so that prices gain more in the same time.
"""
CONFLICTS_TO_FIND = 3000
CONFLICTS_TO_SHRINK = 900
CONFLICTS_TO_RAISE = 300
MARGIN = 4  # ticks by which a delay is raised above all that the robot has near the best prices
LARGEST_GROUP = 16
LONGEST_REFUTATION = 1_000_000  # characters

Allowed: TypeAlias = Mapping[int, int]
"""The largest delay that a robot is allowed, for robots by position."""


class DeadlineSearch:
    """Finds deadlines for a search for prices."""

    def __init__(self, search: PriceSearch) -> None:
        self.search = search
        self.instance = search.instance
        self.known: set[tuple[tuple[int, int], ...]] = set()
        self.cores: _Cores | None = None

    def round(self, check: Callable[[], None]) -> int:
        """Add deadlines that the ways near the best prices break, and return by how much, in parts of a tick.

        `check` may raise `TimeOver`; the deadlines found until then are added first.
        """
        if not self.is_possible:
            return 0
        delays = np.stack([self.search.delays() for _ in self.search.wander(STEPS, check)])
        return 0 if delays.max(axis=0).sum() > LARGEST_DELAYS else self.add(delays, check)

    @property
    def is_possible(self) -> bool:
        """Whether the tables of all robots are small enough, and each has a way: clauses have no place without one."""
        wide = max(len(self.instance.graph.resources), self.search.dual.delays)
        all_have_ways = bool((self.search.dual.requests.earliest != NONE).all())
        return all_have_ways and len(self.instance.robots) * wide <= LARGEST_ENCODING

    def add(self, delays: Longs, check: Callable[[], None]) -> int:
        """Add deadlines that `STEPS` ways break, of these delays by step and robot: by how much, in parts of a tick.

        `check` may raise `TimeOver`; the deadlines found until then are added first.
        """
        allowed = range(int(delays.max(initial=0)) + MARGIN + 1)
        later = np.stack([(delays > each).sum(axis=0) for each in allowed], axis=1)  # steps, by robot and delay
        chosen: list[Deadlines] = []
        gain = 0
        try:
            self.cores = self.cores or _Cores(self.search, check)
            self.cores.check = check
            for share in SHARES:
                for part, core in self.cores.disjoint((later <= share).argmax(axis=1).tolist()):
                    if len(core) > LARGEST_GROUP or _steps(later, core) > LARGEST_TO_RAISE:
                        continue
                    oftenest_first = dict(sorted(core.items(), key=lambda each: -later[each]))
                    raised = self.cores.raised(oftenest_first, (later == 0).argmax(axis=1) + MARGIN, part)
                    if _steps(later, raised) <= ENOUGH:
                        deadlines = self._prove(raised, check)
                        if deadlines is not None:
                            chosen.append(deadlines)
                            gain += STEPS - _steps(later, raised)
        finally:
            self.search.add_deadlines(chosen)
        return gain * self.search.scale // STEPS

    def _prove(self, allowed: Allowed, check: Callable[[], None]) -> Deadlines | None:
        """The deadlines with a proof, unless they are known or the proof is too long."""
        key = tuple(sorted(allowed.items()))
        if key in self.known:
            return None
        self.known.add(key)
        earliest = self.search.dual.requests.earliest
        members = [Member(position, int(earliest[position]) + delay, 0, ()) for position, delay in allowed.items()]
        lines = short_refutation(lambda: Deadlines(members).formula(self.instance), check, LONGEST_REFUTATION)
        return Deadlines(members, lines) if lines else None


def _steps(later: Longs, allowed: Allowed) -> int:
    """The steps in which the robots are later than they are allowed, robot by robot."""
    return sum(int(later[each]) for each in allowed.items())


class _Cores:
    """Cores of the formula of all robots that have a way, with the conflicts that were found so far.

    A model of it takes long, as it has plans of all robots. So a core is made smaller, and its delays larger, by the
    clauses about its robots alone: what these refute, all clauses do.
    """

    def __init__(self, search: PriceSearch, check: Callable[[], None]) -> None:
        self.instance = search.instance
        self.check = check
        self.most = search.dual.delays - 1
        self.encoding = Encoding(self.instance, check)
        self.present = [self.encoding.formula.variable() for _ in self.instance.robots]
        self.robot_of = {variable: position for position, variable in enumerate(self.present)}
        self.about: dict[frozenset[int], list[Clause]] = defaultdict(list)
        self.sorted = 0
        self.whole = _Part(range(len(self.present)), self.look)

    def look(self) -> None:
        """Look at the clock of this round."""
        self.check()

    def keeps(self, position: int, delay: int) -> Literal:
        """The literal that the robot has no larger delay; its clauses hold if it is present."""
        robot, formula = self.encoding.robots[position], self.encoding.formula
        clauses, variables = len(formula.clauses), formula.variables
        while robot.horizon < delay:
            robot.grow()
        formula.clauses[clauses:] = [(*clause, -self.present[position]) for clause in formula.clauses[clauses:]]
        self.note_new(position, variables)
        return -robot.late[delay]

    def forbid(self, meeting: Conflict | Exchange) -> None:
        """Forbid the meeting to all robots; the variables that say that a robot takes part are about that robot."""
        encoding = self.encoding
        for position in range(len(encoding.robots)):
            variables = encoding.formula.variables
            if isinstance(meeting, Conflict):
                encoding.presence(position, meeting.constraint, meeting.tick, self.instance.gap)
            else:
                encoding.moves(position, *meeting.one, meeting.tick)
                encoding.moves(position, *meeting.other, meeting.tick)
            self.note_new(position, variables)
        encoding.forbid(meeting)

    def note_new(self, position: int, variables: int) -> None:
        """Note that those after so many variables are about the robot."""
        self.robot_of |= dict.fromkeys(range(variables + 1, self.encoding.formula.variables + 1), position)

    def part(self, robots: Iterable[int]) -> "_Part":
        """The clauses about these robots alone."""
        part = _Part(robots, self.look)
        for about, clauses in self.about.items():
            part.take(about, clauses)
        return part

    def share_out(self, part: "_Part") -> None:
        """Note about which robots the new clauses are, and add them to the formulas.

        The variables of a sum are about no robot, so a clause of it is about the robots that it names, or about none.
        """
        clauses = self.encoding.formula.clauses
        for clause in clauses[self.sorted :]:
            about = frozenset(self.robot_of[each] for each in map(abs, clause) if each in self.robot_of)
            self.about[about].append(clause)
            self.whole.take(about, [clause])
            if part is not self.whole:
                part.take(about, [clause])
        self.sorted = len(clauses)

    def core(self, allowed: Allowed, conflicts: int, part: "_Part") -> Allowed | None:
        """Robots of the part that cannot all keep their delays.

        `None` if all can, or if its clauses and so many conflicts do not suffice to say.
        """
        literals = {self.present[position]: position for position in allowed}
        literals |= {self.keeps(position, delay): position for position, delay in allowed.items()}
        while True:
            self.look()
            self.share_out(part)
            answer = part.satisfiable(literals, conflicts)
            if answer is None:
                return None
            if not answer:
                named = {literals[literal] for literal in part.core()}
                return {position: delay for position, delay in allowed.items() if position in named}
            model = part.model(self.encoding.formula.variables)
            plans = [self.encoding.robots[position].plan(model) for position in allowed]
            meetings = violated(self.instance, [plan for plan in plans if plan is not None])
            if not meetings:
                return None
            for meeting in meetings:
                self.forbid(meeting)

    def disjoint(self, delays: Iterable[int]) -> Iterable[tuple["_Part", Allowed]]:
        """Cores that have no robot in common, of the robots with these delays, each with the clauses about its own."""
        robots = self.encoding.robots
        allowed = {at: delay for at, delay in enumerate(delays) if robots[at].shortest is not None}
        while (core := self.core(allowed, CONFLICTS_TO_FIND, self.whole)) is not None:
            with closing(self.part(core)) as part:
                core = self.shrunk(core, part)
                yield part, core
            if not core:
                return
            allowed = {position: delay for position, delay in allowed.items() if position not in core}

    def shrunk(self, core: Allowed, part: "_Part") -> Allowed:
        """A core within the core, from which the solver drops nothing quickly."""
        kept: dict[int, int] = {}
        while core:
            position, *rest = core
            smaller = self.core({**kept, **{other: core[other] for other in rest}}, CONFLICTS_TO_SHRINK, part)
            if smaller is None:
                kept[position] = core[position]
                core = {other: core[other] for other in rest}
            else:
                core = {other: delay for other, delay in smaller.items() if other not in kept}
                kept = {other: delay for other, delay in kept.items() if other in smaller}
        return kept

    def raised(self, core: Allowed, most: Longs, part: "_Part") -> Allowed:
        """The core with delays that the solver cannot quickly raise any further, up to the largest that are wanted."""
        raised = dict(core)
        for position in core:
            while raised[position] < min(most[position], self.most):
                raised[position] += 1
                if self.core(raised, CONFLICTS_TO_RAISE, part) is None:
                    raised[position] -= 1
                    break
        return raised


class _Part:
    """The clauses about some of the robots, with variables of its own: a solver gives each one a value."""

    def __init__(self, robots: Iterable[int], look: Callable[[], None]) -> None:
        self.robots = frozenset(robots)
        self.formula = Formula()
        self.solver = Solver(self.formula, look)
        self.own: dict[Literal, Literal] = {}
        self.given = [0]

    def close(self) -> None:
        """Free the solver."""
        self.solver.close()

    def take(self, about: frozenset[int], clauses: Iterable[Clause]) -> None:
        """Add clauses about these robots, if they are among its own."""
        if about <= self.robots:
            for clause in clauses:
                self.formula.add(*map(self.literal, clause))

    def literal(self, given: Literal) -> Literal:
        """Its own literal for a given one."""
        if given not in self.own:
            own = self.formula.variable()
            self.own |= {abs(given): own, -abs(given): -own}
            self.given.append(abs(given))
        return self.own[given]

    def satisfiable(self, literals: Iterable[Literal], conflicts: int) -> bool | None:
        """As `Solver.satisfiable`, with given literals."""
        return self.solver.satisfiable([*map(self.literal, literals)], conflicts)

    def core(self) -> Iterable[Literal]:
        """As `Solver.core`, with given literals."""
        return [self.given[own] if own > 0 else -self.given[-own] for own in self.solver.core()]

    def model(self, variables: int) -> Sequence[bool]:
        """As `Solver.model`, with so many given variables; those that it does not have are false."""
        model = [False] * (variables + 1)
        for given, is_true in zip(self.given, self.solver.model(), strict=True):
            model[given] = is_true
        return model
