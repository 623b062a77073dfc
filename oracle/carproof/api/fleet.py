"""A fleet in memory: news goes in, and the plans that changed come out."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from time import perf_counter
from types import MappingProxyType
from typing import TYPE_CHECKING, TypeVar

from carp_spec import Instance, Neighbourhood, Plan, Refusal, Robot, RobotId, Solution, Stop
from carp_spec.documents.solutions import PlanColumns
from carp_spec.execution.traces import Trace
from carp_spec.inputs.options import require_planner, require_polish_options
from carp_spec.inputs.values import require_instance
from carp_spec.plan_rules import has_ended
from carp_spec.planners import BY_DEFAULT
from carp_spec.polish_rules import last_round
from carp_spec.requests import about_stops, further_stops, require_tick, sound_solution
from carp_spec.shapes import require_shape
from carproof.engines import compile_what_is_kept, engine_named, fleet_of
from carproof.execution.delays import until
from carproof.judging.audit import Audit, audit_in_order, in_order

if TYPE_CHECKING:
    from carp_optimized.fleet import PlannedFleet

from carproof.api.fleet_memory import Change, Known
from carproof.api.fleet_rules import (
    FEW_ROBOTS,
    MOST_ROBOTS,
    MOST_STOPS,
    MOST_VISITS,
    NOT_BACK,
    OWN_ROBOTS,
    require_new,
    require_own,
    require_time,
)

T = TypeVar("T")
NOBODY: Mapping[RobotId, Robot] = MappingProxyType({})


class Fleet:
    """Robots under way on a resource graph, with plans that break no rule together, while time goes on.

    What is not told is taken to have happened as planned. With `vanish` a robot leaves the fleet when its plan has
    ended. What is refused or fails leaves the fleet as it was. Plans are those that `add` makes at the same ticks; only
    the planner's `fallback` shuffles the robots of the fleet alone, where `add` shuffles those that have left too.
    With `audit` a change is proved: the law judges all plans, and no robot of a changed plan, with what it has done by
    the tick `now`, can arrive earlier beside the plans before its own.
    """

    def __init__(
        self,
        instance: Instance,
        solution: Solution | None = None,
        now: int = 0,
        planner: Neighbourhood = BY_DEFAULT,
        *,
        audit: bool = False,
    ) -> None:
        """Take over the plans of a solution, and plan the instance's other robots at the tick `now`, one by one.

        `opening` is the change by that. Raises `Refusal` for a malformed instance, solution, tick or planner, for a
        solution that breaks a rule, and for numbers or fleets that are too large.
        """
        require_instance(instance)
        require_planner(planner, Neighbourhood)
        require_tick(now)
        sound = sound_solution(instance, Solution((), ()) if solution is None else solution)
        by_robot = {plan.robot: plan for plan in sound.plans}
        robots = {id: robot for id, robot in instance.robot.items() if id in by_robot}
        for place, robot in enumerate(instance.robots):
            if robot.id not in by_robot:
                require_time(robot, now, f"$.robots[{place}]")
        self._planner = planner
        empty = replace(instance, robots=())
        core = fleet_of(replace(instance, robots=tuple(robots.values())), [by_robot[id] for id in sound.order])
        self._core: PlannedFleet | None = core
        numbers = {id: number for number, id in enumerate(robots)}
        plans = {id: PlanColumns.of(plan) for id, plan in by_robot.items()}
        self._known = Known(empty, now, robots, plans, *core.places, numbers, len(robots))
        self.opening = self.add(*(each for each in instance.robots if each.id not in by_robot), now=now, audit=audit)

    @property
    def now(self) -> int:
        """The tick of the last news."""
        return self._known.now

    @property
    def instance(self) -> Instance:
        """The resource graph with the robots of the fleet, in the order of their arrival."""
        return self._known.instance

    @property
    def solution(self) -> Solution:
        """The plans of the fleet."""
        return self._known.solution

    def rest(self) -> tuple[Instance, Solution]:
        """What is to come after the moves of the tick `now`, as an instance and a solution of their own.

        A robot under way starts where it is, with the stops that it has not left yet; of one that its plan is serving,
        what is left of the service.
        """
        return self._known.rest()

    def add(self, *robots: Robot, now: int | None = None, audit: bool = False) -> Change:
        """Add robots one by one by the neighbourhood planner; those near them may get new plans from `now` on.

        Raises `Refusal` for a tick that has passed, a malformed robot, one released before `now` or of an id in use,
        and for numbers or fleets that are too large.
        """
        now = self._tick(now)
        if robots:
            require_new(robots, self._known.empty, self._known.robots, now)
            self._made().require_robots(robots)
            size = len(self._known.robots) + len(robots)
            if size > MOST_ROBOTS and size - len(self._made().ended(now)) > MOST_ROBOTS:
                message = f"the fleet must have at most {MOST_ROBOTS} robots, and would have more"
                raise Refusal("limit", "$.robots", FEW_ROBOTS.id, message)
            self._require_little("$.robots", max(len(robot.stops) for robot in robots))
        from carp_optimized.adding import add  # noqa: PLC0415 - planners are loaded when needed

        core, unplanned = self._taken(), list[RobotId]()
        for number, robot in enumerate(robots, self._known.count):
            place = core.enlist(robot)
            if not add(core, place, self._known.from_tick(now), self._planner, number):
                unplanned.extend(core.dismiss([place]))
        return self._take_over(core, now, audit, unplanned, {robot.id: robot for robot in robots})

    def assign(self, robot: RobotId, stops: Sequence[Stop], now: int | None = None, *, audit: bool = False) -> Change:
        """Give a robot that is under way or parked further stops, behind those that it has, as `carproof.assign` does.

        It is planned again together with robots near it. If it finds no plan, it is `unplanned`, and all stays as it
        was. Raises `Refusal` for a tick that has passed, a robot that is not there or has left by then, for stops that
        break `instance/stops`, and for numbers or fleets that are too large.
        """
        from carp_optimized.adding import assign  # noqa: PLC0415 - planners are loaded when needed

        now = self._tick(now)
        require_shape(robot, RobotId, "$.robot")
        before, at = self._known.robots.get(robot), self._known.from_tick(now)
        if before is None or has_ended(self._known.plans[robot].plan, at):
            message = f"it must be a robot of the fleet that has not left by {at}, and {robot!r} is not"
            raise Refusal("request", "$.robot", OWN_ROBOTS.id, message)
        further = further_stops(self._known.empty, before, stops)
        with about_stops(0):
            self._made().require_robots((further,))
        self._require_little("$.stops", len(further.stops))
        core, plan = self._taken(), self._known.plans[robot].plan
        if assign(core, further, before, plan, at, self._planner, self._known.numbers[robot]):
            return self._take_over(core, now, audit, new={robot: further})
        return self._take_over(core, now, audit, unplanned=[robot])

    def remove(self, robot: RobotId, now: int | None = None) -> Change:
        """Take a robot off the floor, one that has broken down for example; from the tick now on its places are free.

        No other plan changes; `polish` makes use of the room. Raises `Refusal` for a tick that has passed, and for a
        robot that is not there.
        """
        now = self._tick(now)
        require_own(robot, self._known.robots, "$.robot")
        change = self.advance(now)
        if robot in change.left:
            return change
        core, known = self._taken(), self._known
        core.remove(core.index(robot))
        places, ids = core.places
        self._known = replace(
            known,
            robots=_without(robot, known.robots),
            plans=_without(robot, known.plans),
            places=places,
            ids=ids,
            numbers=_without(robot, known.numbers),
        )
        self._core = core
        return replace(change, left=(*change.left, robot))

    def forget(self) -> None:
        """Forget what is done by the tick `now`: robots start in the visits under way, as of when they entered them."""
        instance, solution = self._known.left()
        core = fleet_of(instance, [*in_order(solution)])
        plans = {plan.robot: PlanColumns.of(plan) for plan in solution.plans}
        places, ids = core.places
        self._known = replace(self._known, robots={**instance.robot}, plans=plans, places=places, ids=ids)
        self._core = core

    def advance(self, now: int, *, audit: bool = False) -> Change:
        """Let time go on as planned. Raises `Refusal` for a tick that has passed."""
        require_tick(now)
        return self.add(now=now, audit=audit)

    def trace(self, trace: Trace, *, audit: bool = False) -> Change:
        """Report what robots have done by the tick of a trace, where it is not what was planned; plans are retimed.

        Robots that the trace does not name have done what was planned, later only where they wait for others in the
        planned order. Nobody moves otherwise at that tick any more: other news of it changes plans from the next on.
        Raises `Refusal` for a tick that has passed, unknown robots, a trace that does not follow the plans, one that
        contradicts those before it, and one by which a robot appears late or, with `vanish`, leaves its goal late.
        """
        require_shape(trace, Trace)
        now = self._tick(trace.now)
        for place, plan in enumerate(trace.plans):
            require_own(plan.robot, self._known.robots, f"$.plans[{place}].robot")
        compile_what_is_kept()
        from carp_optimized.execution.following import held_up, retime  # noqa: PLC0415 - numba is slow to load

        instance, solution = self.instance, self.solution
        told = {plan.robot for plan in trace.plans}
        others = tuple(plan for plan in held_up(instance, solution, trace).plans if plan.robot not in told)
        whole = Trace(now, (*trace.plans, *until(Trace(now, others), now).plans))
        try:
            after = retime(instance, solution, whole)
            self._known.require_heard(whole)
        except Refusal as refusal:
            if refusal.path not in {f"$.plans[{place}]" for place in range(len(trace.plans), len(whole.plans))}:
                raise
            raise Refusal(refusal.kind, "$.plans", refusal.rule, refusal.message) from refusal
        core = self._taken()
        core.replan([plan for plan in after.plans if plan != self._known.plans[plan.robot].plan], after.order)
        change = self._take_over(core, now, audit, told=after.plans)
        named = dict.fromkeys(told & self._known.robots.keys(), now)
        self._known = replace(self._known, heard={**self._known.heard, **named})
        return change

    def polish(
        self, *, iterations: int | None = None, seconds: float | None = None, seed: int = 0, audit: bool = False
    ) -> Change:
        """Improve the plans of the rest of the way as `carproof.polish` does; raises `Refusal` for wrong options.

        Draws are among the robots of the fleet, in the order of their places in memory.
        """
        from carp_optimized.polishing import polish_fleet  # noqa: PLC0415 - planners are loaded when needed

        started = perf_counter()
        require_polish_options(iterations, seconds, seed)
        core, now = self._taken(), self._known.from_tick(self.now)

        def goes_on() -> bool:
            return seconds is None or perf_counter() - started < seconds

        polish_fleet(core, goes_on, last_round(iterations, seconds), seed, now)
        return self._take_over(core, self.now, audit)

    def _tick(self, now: int | None) -> int:
        if now is None:
            return self.now
        require_tick(now)
        if now < self.now:
            raise Refusal("request", "$.now", NOT_BACK.id, f"the tick must be at least {self.now}, and is {now}")
        from carp_optimized.state.limits import refuse_tick  # noqa: PLC0415 - numpy is slow to load

        refuse_tick("$.now", now)
        return now

    def _require_little(self, path: str, stops: int) -> None:
        if stops > MOST_STOPS:
            message = (
                f"a robot must have at most {MOST_STOPS} stops, and would have {stops}; forgetting drops those done"
            )
            raise Refusal("limit", path, FEW_ROBOTS.id, message)
        if self._made().has_more_visits(MOST_VISITS):
            message = f"the plans must have at most {MOST_VISITS} visits, and have more; forgetting drops those done"
            raise Refusal("limit", path, FEW_ROBOTS.id, message)

    def _taken(self) -> "PlannedFleet":
        """The compiled fleet, its plans noted; unless a change is taken over, it is made again from what is known."""
        core, self._core = self._made(), None
        core.note()
        return core

    def _made(self) -> "PlannedFleet":
        if self._core is None:
            self._core = fleet_of(self.instance, [self._known.plans[id].plan for id in self._known.order])
        return self._core

    def _take_over(
        self,
        core: "PlannedFleet",
        now: int,
        audit: bool,
        unplanned: Sequence[RobotId] = (),
        new: Mapping[RobotId, Robot] = NOBODY,
        told: Sequence[Plan] | None = None,
    ) -> Change:
        """Know what the compiled fleet holds, without the plans that have ended by now.

        Robots that are `new` have come or have other stops. They have followed the plans before until then, or those
        that a trace has `told`; beside these an audit looks at the changed ones.
        """
        known = self._known
        changed = tuple(each for each in core.changed() if each != known.plans.get(each.robot))
        come = {id: number for number, id in enumerate((id for id in new if id not in known.robots), known.count)}
        robots, numbers = {**known.robots, **new}, {**known.numbers, **come}
        plans = {**known.plans, **{each.robot: each for each in changed}}
        left = core.dismiss(core.ended(now))
        for id in (*left, *(each for each in unplanned if each in come)):
            del robots[id], numbers[id]
            plans.pop(id, None)
        heard = {id: tick for id, tick in known.heard.items() if id in robots}
        last = known.told if told is None else now
        after = Known(known.empty, now, robots, plans, *core.places, numbers, known.count + len(come), last, heard)
        found = _audited(known.solution.plans if told is None else told, after, changed) if audit else None
        self._known, self._core = after, core
        return Change(now, changed, tuple(unplanned), left, found)


def _without(robot: RobotId, of: Mapping[RobotId, T]) -> Mapping[RobotId, T]:
    return {id: value for id, value in of.items() if id != robot}


def _audited(before: Sequence[Plan], known: Known, changed: Sequence[PlanColumns]) -> Audit:
    sound, engine = sound_solution(known.instance, known.solution), engine_named("optimized")
    plans = {plan.robot: plan for plan in before}
    followed = {each.robot: plans.get(each.robot) for each in changed}
    return audit_in_order(known.instance, sound, engine, followed=followed, now=known.from_tick(known.now))
