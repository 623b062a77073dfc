"""A small town with queries of every kind, and their honest certificates."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

from tests.spec.making import plan_of

import carp_reference
from carp_reference.certifying import Certifier
from carp_spec import AfterGoal, Instance, Plan, Refusal, Resource, ResourceGraph, Robot, RobotId, Solution, Stop
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


EAST = Robot("r", "a", "d")
WEST = Robot("s", "d", "a")
WESTWARDS = plan_of("s", ("d", 0, 1), ("c", 1, 3), ("b", 3, 4), ("a", 4, 5))
VANISHING = town("vanish", EAST, WEST)
PARKING = town("park", EAST, replace(WEST, stops=(Stop("e"),)))
HOME = town("vanish", Robot("r", "b", "b"), WEST)
QUESTIONS = {
    "alone": beside(VANISHING, "r"),
    "head-on": beside(VANISHING, "r", WESTWARDS),
    "blocked for ever": beside(
        town("park", EAST, replace(WEST, stops=(Stop("c"),))), "r", plan_of("s", ("d", 0, 1), ("c", 1, None))
    ),
    "parking": beside(PARKING, "r", plan_of("s", ("d", 0, 1), ("c", 1, 3), ("b", 3, 4), ("e", 4, None))),
    "a goal that is passed later": beside(
        town("park", replace(EAST, stops=(Stop("b"),)), replace(WEST, stops=(Stop("e"),))),
        "r",
        plan_of("s", ("d", 0, 1), ("c", 1, 3), ("b", 3, 4), ("e", 4, None)),
    ),
    "out of reach": beside(town("vanish", replace(WEST, id="r"), directed=True), "r"),
    "room for two": beside(town("vanish", EAST, WEST, capacity=2), "r", WESTWARDS),
    "room for two, and back into it": beside(
        town("vanish", EAST, replace(WEST, pace=3), Robot("t", "e", "a"), capacity=2),
        "r",
        plan_of("s", ("d", 0, 3), ("c", 3, 9), ("b", 9, 12), ("a", 12, 15)),
        plan_of("t", ("e", 0, 4), ("b", 4, 5), ("a", 5, 6)),
    ),
    "slow": beside(town("vanish", replace(EAST, pace=2), WEST), "r", WESTWARDS),
    "under way": beside(
        VANISHING, "r", WESTWARDS, plan_of("r", ("a", 0, 1), ("b", 1, 2), ("c", 2, 4), ("d", 4, 5)), now=1
    ),
    "ended": beside(HOME, "r", plan_of("r", ("b", 0, 1)), now=4),
    "ended, and in the way": beside(
        town("vanish", Robot("r", "b", "b"), Robot("s", "b", "e")),
        "r",
        plan_of("s", ("b", 0, 1), ("e", 1, 2)),
        plan_of("r", ("b", 0, 1)),
        now=4,
    ),
    "in the way": beside(
        VANISHING, "r", WESTWARDS, plan_of("r", ("a", 0, 4), ("b", 4, 5), ("c", 5, 7), ("d", 7, 8)), now=4
    ),
    "in the way before it left": beside(
        VANISHING, "r", WESTWARDS, plan_of("r", ("a", 0, 5), ("b", 5, 6), ("c", 6, 8), ("d", 8, 9)), now=5
    ),
    "at its goal": beside(HOME, "r"),
    "may leave its goal now": beside(HOME, "r", now=1),
    "stayed too long at its goal": beside(
        HOME, "r", plan_of("s", ("d", 0, 6), ("c", 6, 8), ("b", 8, 9), ("a", 9, 10)), now=3
    ),
}


SHUTTLE = Robot("r", "a", stops=(Stop("c", 5), Stop("a"), Stop("d", 4)))
OVER_STOPS = {
    "over stops": beside(town("vanish", SHUTTLE, WEST), "r", WESTWARDS),
    "over stops, to park": beside(
        town("park", SHUTTLE, replace(WEST, stops=(Stop("e"),))),
        "r",
        plan_of("s", ("d", 0, 1), ("c", 1, 3), ("b", 3, 4), ("e", 4, None)),
    ),
    "a stop served at the start": beside(
        town("vanish", replace(SHUTTLE, stops=(Stop("a", 3), Stop("d"))), WEST), "r", WESTWARDS
    ),
    "one stop served, under way": beside(
        town("vanish", SHUTTLE, replace(WEST, release=20)),
        "r",
        plan_of("s", ("d", 20, 21), ("c", 21, 23), ("b", 23, 24), ("a", 24, 25)),
        plan_of(
            "r",
            ("a", 0, 1),
            ("b", 1, 2),
            ("c", 2, 7),
            ("b", 7, 8),
            ("a", 8, 9),
            ("b", 9, 10),
            ("c", 10, 12),
            ("d", 12, 16),
        ),
        now=8,
    ),
    "a stop served by now, under way": beside(
        town("vanish", replace(SHUTTLE, stops=(Stop("a", 2), Stop("d"))), replace(WEST, release=5)),
        "r",
        plan_of("s", ("d", 5, 6), ("c", 6, 8), ("b", 8, 9), ("a", 9, 10)),
        plan_of("r", ("a", 0, 4), ("b", 4, 5), ("c", 5, 7), ("d", 7, 8)),
        now=3,
    ),
    "two stops served, and in the way": beside(
        town("vanish", SHUTTLE, replace(WEST, release=11)),
        "r",
        plan_of("s", ("d", 11, 12), ("c", 12, 14), ("b", 14, 15), ("a", 15, 16)),
    ),
    "stayed too long at the last stop": beside(
        town("vanish", replace(SHUTTLE, stops=(Stop("a", 2), Stop("d"))), replace(WEST, release=20)),
        "r",
        plan_of("s", ("d", 20, 21), ("c", 21, 23), ("b", 23, 24), ("a", 24, 25)),
        plan_of("r", ("a", 0, 2), ("b", 2, 3), ("c", 3, 5), ("d", 5, 9), ("c", 9, 11), ("d", 11, 12)),
        now=7,
    ),
    "a stop out of reach": beside(town("vanish", replace(SHUTTLE, start="b"), WEST, directed=True), "r"),
    "a long service at the goal": beside(
        town("vanish", replace(EAST, stops=(Stop("d", 6),)), replace(WEST, release=8)),
        "r",
        plan_of("s", ("d", 8, 9), ("c", 9, 11), ("b", 11, 12), ("a", 12, 13)),
    ),
}
QUESTIONS |= OVER_STOPS


def fleets(question: Question) -> Iterator[Question]:
    """The same plans, asked for each robot of the instance, at the start and at the tick."""
    for robot in question.instance.robot:
        for now in sorted({0, question.now}):
            yield replace(question, robot=robot, now=now)
