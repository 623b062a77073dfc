"""A small town with queries of every kind, and their honest certificates."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from tests.spec.making import plan_of

import carp_reference
from carp_reference.certifying import Certifier
from carp_spec import (
    AfterGoal,
    Group,
    Instance,
    Plan,
    Refusal,
    Resource,
    ResourceGraph,
    Robot,
    RobotId,
    Solution,
    Stop,
)
from carp_spec.documents.query_certificates import QueryCertificateDocument
from carp_verify.query.verify import verify_query


@dataclass(frozen=True, slots=True)
class Question:
    """A robot to plan at a tick beside the plans of the others; a plan of its own is what it has followed."""

    instance: Instance
    solution: Solution
    robot: RobotId
    now: int = 0

    @property
    def followed(self) -> Plan | None:
        return next((plan for plan in self.solution.plans if plan.robot == self.robot), None)

    def certified(self) -> tuple[Plan | None, QueryCertificateDocument]:
        """The plan of the reference, and its certificate."""
        certifier = Certifier(self.instance)
        certifier.commit([plan for plan in self.solution.plans if plan.robot != self.robot])
        return certifier.certify(self.robot, self.followed, self.now)

    def rule_broken(self, certificate: QueryCertificateDocument) -> str | None:
        """The rule by which the certificate is refused beside these plans, or `None`."""
        try:
            verify_query(self.instance, self.solution, certificate)
        except Refusal as refusal:
            return refusal.rule
        return None

    def is_true(self, certificate: QueryCertificateDocument) -> bool:
        """Whether no plan of the robot named arrives before the bound, by the reference."""
        bound, plans = certificate.bound, self.solution.plans
        best = carp_reference.query(self.instance, plans, certificate.robot, certificate.now)
        return best is None or (bound is not None and bound <= best.visits[-1].enter)


def town(after_goal: AfterGoal, *robots: Robot, directed: bool = False, capacity: int = 1) -> Instance:
    """A lane from a over b and c, which takes two ticks, to d, and e beside b."""
    cells = tuple(Resource(cell, capacity if cell == "b" else 1, 2 if cell == "c" else 1) for cell in "abcde")
    return Instance(
        ResourceGraph(cells, (("a", "b"), ("b", "c"), ("c", "d"), ("b", "e")), directed), robots, after_goal
    )


def beside(instance: Instance, robot: RobotId, *plans: Plan, now: int = 0) -> Question:
    """A question beside plans."""
    return Question(instance, Solution.of(instance, plans), robot, now)


def way(robot: RobotId, visits: str, leave: int | None) -> Plan:
    """A plan by its resources, each with the tick at which it is entered, and the tick at which it ends."""
    stays = [(each[0], int(each[1:])) for each in visits.split()]
    ends = [*(enter for _, enter in stays[1:]), leave]
    return plan_of(robot, *((resource, enter, end) for (resource, enter), end in zip(stays, ends, strict=True)))


EAST = Robot("r", "a", "d")
WEST = Robot("s", "d", "a")
WESTWARDS = way("s", "d0 c1 b3 a4", 5)
VANISHING = town("vanish", EAST, WEST)
PARKING = town("park", EAST, replace(WEST, stops=(Stop("e"),)))
SWAPPED = town("vanish", Robot("r", "a", "b"), Robot("s", "b", "c"))
TOGETHER = replace(SWAPPED.graph, groups=(Group("a or c", ("a", "c"), 1),))
HOME = town("vanish", Robot("r", "b", "b"), WEST)
QUESTIONS = {
    "alone": beside(VANISHING, "r"),
    "head-on": beside(VANISHING, "r", WESTWARDS),
    "blocked for ever": beside(town("park", EAST, replace(WEST, stops=(Stop("c"),))), "r", way("s", "d0 c1", None)),
    "parking": beside(PARKING, "r", way("s", "d0 c1 b3 e4", None)),
    "a goal that is passed later": beside(
        town("park", replace(EAST, stops=(Stop("b"),)), replace(WEST, stops=(Stop("e"),))),
        "r",
        way("s", "d0 c1 b3 e4", None),
    ),
    "out of reach": beside(town("vanish", replace(WEST, id="r"), directed=True), "r"),
    "room for two": beside(town("vanish", EAST, WEST, capacity=2), "r", WESTWARDS),
    "room for two, and back into it": beside(
        town("vanish", EAST, replace(WEST, pace=3), Robot("t", "e", "a"), capacity=2),
        "r",
        way("s", "d0 c3 b9 a12", 15),
        way("t", "e0 b4 a5", 6),
    ),
    "slow": beside(town("vanish", replace(EAST, pace=2), WEST), "r", WESTWARDS),
    "under way": beside(VANISHING, "r", WESTWARDS, way("r", "a0 b1 c2 d4", 5), now=1),
    "ended": beside(HOME, "r", way("r", "b0", 1), now=4),
    "ended, and in the way": beside(
        town("vanish", Robot("r", "b", "b"), Robot("s", "b", "e")), "r", way("s", "b0 e1", 2), way("r", "b0", 1), now=4
    ),
    "in the way": beside(VANISHING, "r", WESTWARDS, way("r", "a0 b4 c5 d7", 8), now=4),
    "in the way before it left": beside(VANISHING, "r", WESTWARDS, way("r", "a0 b5 c6 d8", 9), now=5),
    "an exchange with a robot that moves into its group": beside(
        replace(SWAPPED, graph=TOGETHER), "r", way("s", "b0 c2", 4)
    ),
    "at its goal": beside(HOME, "r"),
    "may leave its goal now": beside(HOME, "r", now=1),
    "stayed too long at its goal": beside(HOME, "r", way("s", "d0 c6 b8 a9", 10), now=3),
}


SHUTTLE = Robot("r", "a", stops=(Stop("c", 5), Stop("a"), Stop("d", 4)))
OVER_STOPS = {
    "over stops": beside(town("vanish", SHUTTLE, WEST), "r", WESTWARDS),
    "over stops, to park": beside(
        town("park", SHUTTLE, replace(WEST, stops=(Stop("e"),))), "r", way("s", "d0 c1 b3 e4", None)
    ),
    "a stop served at the start": beside(
        town("vanish", replace(SHUTTLE, stops=(Stop("a", 3), Stop("d"))), WEST), "r", WESTWARDS
    ),
    "one stop served, under way": beside(
        town("vanish", SHUTTLE, replace(WEST, release=20)),
        "r",
        way("s", "d20 c21 b23 a24", 25),
        way("r", "a0 b1 c2 b7 a8 b9 c10 d12", 16),
        now=8,
    ),
    "a stop served by now, under way": beside(
        town("vanish", replace(SHUTTLE, stops=(Stop("a", 2), Stop("d"))), replace(WEST, release=5)),
        "r",
        way("s", "d5 c6 b8 a9", 10),
        way("r", "a0 b4 c5 d7", 8),
        now=3,
    ),
    "two stops served, and in the way": beside(
        town("vanish", SHUTTLE, replace(WEST, release=11)), "r", way("s", "d11 c12 b14 a15", 16)
    ),
    "stayed too long at the last stop": beside(
        town("vanish", replace(SHUTTLE, stops=(Stop("a", 2), Stop("d"))), replace(WEST, release=20)),
        "r",
        way("s", "d20 c21 b23 a24", 25),
        way("r", "a0 b2 c3 d5 c9 d11", 12),
        now=7,
    ),
    "a stop out of reach": beside(town("vanish", replace(SHUTTLE, start="b"), WEST, directed=True), "r"),
    "a long service at the goal": beside(
        town("vanish", replace(EAST, stops=(Stop("d", 6),)), replace(WEST, release=8)),
        "r",
        way("s", "d8 c9 b11 a12", 13),
    ),
}
QUESTIONS |= OVER_STOPS


def fleets(question: Question) -> Iterator[Question]:
    """The same plans, asked for each robot of the instance, at the start and at the tick."""
    for robot in question.instance.robot:
        for now in sorted({0, question.now}):
            yield replace(question, robot=robot, now=now)
