"""What a fleet in memory knows, and what news changes in it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from msgspec import structs

from carp_spec import Instance, Plan, Refusal, Robot, RobotId, Solution
from carp_spec.documents.solutions import PlanColumns
from carp_spec.execution.traces import Trace
from carp_spec.plan_rules import stops_served
from carproof.api.fleet_rules import NOT_BACK
from carproof.execution.delays import until
from carproof.judging.audit import Audit

if TYPE_CHECKING:
    from carp_optimized.jit.kinds import Ints


@dataclass(frozen=True, slots=True)
class Change:
    """What news changed: the plans that are new or other than before, and who is no longer in the fleet.

    `unplanned` found no plan: those that were to be added are not in the fleet, and one that was to get stops keeps
    those that it had. `left` are in the fleet no more: they were removed, or have vanished by the tick `now`, and by
    the tick before it where following is forbidden. `audit` is the proof, if it was asked for.
    """

    now: int
    columns: tuple[PlanColumns, ...]
    unplanned: tuple[RobotId, ...]
    left: tuple[RobotId, ...]
    audit: Audit | None = None

    @property
    def plans(self) -> tuple[Plan, ...]:
        """The plans that are new or other than before, made of their columns when they are asked for."""
        return tuple(each.plan for each in self.columns)


@dataclass(frozen=True, slots=True)
class Known:
    """What a fleet knows: robots in the order of their arrival, their plans, and how many came so far.

    `empty` is the instance without robots; `places` are the numbers of the robots in planning order, and `ids` the ids
    by number. `numbers` say how many came before each robot. `told` is the tick of the last trace, -1 without one, and
    `heard` that of the last trace which named a robot.
    """

    empty: Instance
    now: int
    robots: Mapping[RobotId, Robot]
    plans: Mapping[RobotId, PlanColumns]
    places: "Ints"
    ids: Sequence[RobotId]
    numbers: Mapping[RobotId, int]
    count: int
    told: int = -1
    heard: Mapping[RobotId, int] = field(default_factory=dict)

    def from_tick(self, now: int) -> int:
        """The tick from which plans may change at the tick now: what a trace told of its tick has happened."""
        return max(now, self.told + 1)

    @property
    def order(self) -> tuple[RobotId, ...]:
        """The robots in planning order."""
        return tuple(self.ids[place] for place in self.places.tolist())

    @property
    def instance(self) -> Instance:
        """The resource graph with the robots."""
        return replace(self.empty, robots=tuple(self.robots.values()))

    @property
    def solution(self) -> Solution:
        """The plans of the robots."""
        return Solution(tuple(self.plans[id].plan for id in self.robots), self.order)

    def rest(self) -> tuple[Instance, Solution]:
        """The robots and plans from after the moves of the tick now on."""
        return self._of([self._ahead(*each) for each in self._since(self.now)])

    def left(self) -> tuple[Instance, Solution]:
        """Without the visits that are over before now; moves at now may be in the way of others."""
        return self._of(self._since(self.now - 1))

    def _of(self, each: Sequence[tuple[Robot, Plan]]) -> tuple[Instance, Solution]:
        robots, plans = tuple(robot for robot, _ in each), tuple(plan for _, plan in each)
        return replace(self.empty, robots=robots), Solution(plans, self.order)

    def _since(self, tick: int) -> list[tuple[Robot, Plan]]:
        """Each robot in the place where it is at a tick, released as it entered it, and its plan from there."""
        found = []
        for id, robot in self.robots.items():
            plan = self.plans[id].plan
            entered = sum(visit.enter <= tick for visit in plan.visits)
            place = max(entered - 1, 0)
            here = plan.visits[place]
            stops = robot.stops[stops_served(robot.stops[:-1], plan.visits[:place]) :]
            kept = replace(robot, start=here.resource, stops=stops, release=here.enter)
            found.append((kept, replace(plan, visits=plan.visits[place:])))
        return found

    def _ahead(self, robot: Robot, plan: Plan) -> tuple[Robot, Plan]:
        """The same, released so late that it cannot leave by now; of a service under way the rest is to do."""
        here, *later = plan.visits
        ticks = robot.pace * self.empty.graph.resource[here.resource].duration
        release = max(here.enter, self.now + 1 - ticks)
        if here.enter > self.now or (here.leave is not None and not later):
            return robot, plan
        stops = robot.stops
        serves = here.leave is None or here.leave - here.enter >= stops[0].service
        if serves and stops[0].resource == here.resource:
            left = max(stops[0].service - (release - here.enter), 0)
            stops = (replace(stops[0], service=left), *stops[1:])
        visits = (structs.replace(here, enter=release), *later)
        return replace(robot, stops=stops, release=release), replace(plan, visits=visits)

    def require_heard(self, whole: Trace) -> None:
        """Raise `Refusal` where a trace of all robots contradicts an earlier one that named the robot."""
        for number, plan in enumerate(whole.plans):
            heard = self.heard.get(plan.robot)
            if heard is None:
                continue
            both = Trace(heard, (self.plans[plan.robot].plan, plan))
            before, again = (each.visits for each in until(both, heard).plans)
            for old, new in zip(before, again, strict=False):  # who has gone less far has not left the last visit
                if old != new:
                    left = "not left it" if old.leave is None else f"left it at {old.leave}"
                    had = f"had entered {old.resource} at {old.enter} and {left}"
                    message = f"a trace has told that by {heard} robot {plan.robot} {had}"
                    raise Refusal("request", f"$.plans[{number}]", NOT_BACK.id, message)
