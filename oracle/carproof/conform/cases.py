"""A case: one question to a program. It holds nothing of the answer."""

from dataclasses import asdict, dataclass
from typing import Any, Literal, TypeAlias, get_args

from carp_spec import Instance, Neighbourhood, Planner, RobotId, Solution
from carp_spec.documents import instance_document, solution_document

Op: TypeAlias = Literal["check", "query", "plan", "add", "polish", "optimum", "bound"]
OPS: tuple[Op, ...] = get_args(Op)
WITH_SOLUTION: tuple[Op, ...] = ("check", "query", "add", "polish")
Stage: TypeAlias = Literal["smoke", "vectors", "random"]
OPTIMUM_SECONDS = 3
BOUND_STEPS = 100
POLISH_ROUNDS = 30
NO_PLANS = Solution((), ())


@dataclass(frozen=True, slots=True)
class Case:
    """A question: an op of the protocol with its fields.

    `check` and `polish` need the solution, `query` and `add` the solution, the robot and the tick `now`. A planner of
    `None` for `plan` leaves the choice to the program: that is what programs are asked that only plan whole
    instances. A `classical` one is answered in a format of classical planners, which does not tell the order of the
    plans.
    """

    stage: Stage
    name: str
    op: Op
    instance: Instance
    solution: Solution = NO_PLANS
    robot: RobotId | None = None
    now: int = 0
    planner: Planner | None = None
    classical: bool = False

    @property
    def size(self) -> tuple[int, int, int, int]:
        """How much there is to look at, for who wants the smallest failure."""
        graph = self.instance.graph
        visits = sum(len(plan.visits) for plan in self.solution.plans)
        return (len(self.instance.robots), len(graph.resources), len(graph.edges), visits)

    @property
    def options(self) -> Neighbourhood:
        """The options of `add`."""
        return self.planner if isinstance(self.planner, Neighbourhood) else Neighbourhood()


def case_input(case: Case) -> dict[str, Any]:
    """The fields of the request besides the op and the instance."""
    fields: dict[str, Any] = {"solution": solution_document(case.solution)} if case.op in WITH_SOLUTION else {}
    match case.op:
        case "query":
            fields |= {"robot": case.robot, "now": case.now}
        case "add":
            fields |= {"robot": case.robot, "now": case.now, **asdict(case.options)}
        case "polish":
            fields |= {"iterations": POLISH_ROUNDS}
        case "plan" if case.planner is not None:
            fields |= {"planner": case.planner.name, **asdict(case.planner)}
        case "optimum":
            fields |= {"limit": OPTIMUM_SECONDS}
        case "bound":
            fields |= {"steps": BOUND_STEPS}
    return fields


def request_fields(case: Case) -> dict[str, Any]:
    """The fields of the request besides its id and op."""
    return {"instance": instance_document(case.instance), **case_input(case)}
