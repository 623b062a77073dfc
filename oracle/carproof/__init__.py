"""The public face of carproof, for authors of planners.

    from carproof import check, plan, read_instance

    instance = read_instance(Path("town.json").read_bytes())
    verdict = check(instance, plan(instance))

It has the model (`Instance`, `ResourceGraph`, `Resource`, `Robot`, `Stop`, `Solution`, `Plan`, `Visit`) and its
documents (`read_...`, `write_...`); the checkers (`check`, `check_trace`, `audit`, `conforms`); the planners (`plan`,
`plan_within`, `query`, `add`, `assign`, `polish`) with their options (`Carp`, `Neighbourhood`, ...); bounds and optima
(`bound`, `optimum`, `optimality_gap`, `verify_...`); executions (`execute`, `drive`, `retime`, ...) and
pictures (`view`). `carproof.formats` reads and writes other tools' formats, `carproof.generate` makes instances, and
`carproof.testing.strategies` draws them for hypothesis.

The imports below are the one list of public names. Type checkers read them; at run time they are not executed, so that
importing this page costs nothing: a name is loaded from its module when it is first used.
"""

from functools import cache
from importlib import import_module

TYPE_CHECKING = False  # typing is slow to load, and type checkers know the name
if TYPE_CHECKING:
    from carp_optimized import add as add
    from carp_optimized import assign as assign
    from carp_optimized import query as query
    from carp_optimum.deadline import TimeOver as TimeOver
    from carp_optimum.gap import Gap as Gap
    from carp_optimum.gap import PlannerGap as PlannerGap
    from carp_optimum.sat.core_guided import Optimum as Optimum
    from carp_spec import AfterGoal as AfterGoal
    from carp_spec import Carp as Carp
    from carp_spec import Fault as Fault
    from carp_spec import FixedPaths as FixedPaths
    from carp_spec import Greedy as Greedy
    from carp_spec import Group as Group
    from carp_spec import Instance as Instance
    from carp_spec import LongestFirst as LongestFirst
    from carp_spec import Move as Move
    from carp_spec import Neighbourhood as Neighbourhood
    from carp_spec import Plan as Plan
    from carp_spec import Planner as Planner
    from carp_spec import Refusal as Refusal
    from carp_spec import Resource as Resource
    from carp_spec import ResourceGraph as ResourceGraph
    from carp_spec import ResourceId as ResourceId
    from carp_spec import Robot as Robot
    from carp_spec import RobotId as RobotId
    from carp_spec import Rule as Rule
    from carp_spec import Shuffled as Shuffled
    from carp_spec import Solution as Solution
    from carp_spec import Stop as Stop
    from carp_spec import TimeExpanded as TimeExpanded
    from carp_spec import Verdict as Verdict
    from carp_spec import Violation as Violation
    from carp_spec import Visit as Visit
    from carp_spec import check_update as check_update
    from carp_spec import plan_cost as plan_cost
    from carp_spec import stops_served as stops_served
    from carp_spec import total_cost as total_cost
    from carp_spec.documents.bounds import BoundDocument as BoundDocument
    from carp_spec.documents.bounds import read_bound as read_bound
    from carp_spec.documents.instances import read_instance as read_instance
    from carp_spec.documents.instances import write_instance as write_instance
    from carp_spec.documents.query_certificates import QueryCertificateDocument as QueryCertificateDocument
    from carp_spec.documents.query_certificates import read_query_certificate as read_query_certificate
    from carp_spec.documents.solutions import read_solution as read_solution
    from carp_spec.documents.solutions import read_trace as read_trace
    from carp_spec.documents.solutions import write_solution as write_solution
    from carp_spec.documents.solutions import write_trace as write_trace
    from carp_spec.documents.verdicts import write_verdict as write_verdict
    from carp_spec.execution.logs import LogVerdict as LogVerdict
    from carp_spec.execution.logs import Served as Served
    from carp_spec.execution.logs import judge_log as judge_log
    from carp_spec.execution.traces import Trace as Trace
    from carp_spec.inputs.costs import makespan as makespan
    from carp_spec.model import Following as Following
    from carp_verify.bound.verify import verify_bound as verify_bound
    from carp_verify.footprint.rules import Footprint as Footprint
    from carp_verify.optimum.proof import ProofError as ProofError
    from carp_verify.optimum.proof import Verified as Verified
    from carp_verify.optimum.proof import verify_proof as verify_proof
    from carp_verify.query.verify import verify_query as verify_query
    from carp_verify.release.rules import Grant as Grant
    from carproof.api.documents import read_verdict as read_verdict
    from carproof.api.documents import write_bound as write_bound
    from carproof.api.documents import write_query_certificate as write_query_certificate
    from carproof.api.executing import check_grants as check_grants
    from carproof.api.executing import drive as drive
    from carproof.api.executing import execute as execute
    from carproof.api.executing import give_way as give_way
    from carproof.api.executing import release as release
    from carproof.api.executing import retime as retime
    from carproof.api.executing import untangle as untangle
    from carproof.api.fleet import Fleet as Fleet
    from carproof.api.fleet_memory import Change as Change
    from carproof.api.judging import audit as audit
    from carproof.api.judging import check as check
    from carproof.api.judging import check_trace as check_trace
    from carproof.api.planning import certified_query as certified_query
    from carproof.api.planning import plan as plan
    from carproof.api.planning import plan_within as plan_within
    from carproof.api.planning import polish as polish
    from carproof.api.searching import bound as bound
    from carproof.api.searching import optimality_gap as optimality_gap
    from carproof.api.searching import optimum as optimum
    from carproof.api.searching import write_proof as write_proof
    from carproof.conform.python import LevelName as LevelName
    from carproof.conform.python import conforms as conforms
    from carproof.conform.run import Report as Report
    from carproof.execution.delays import Delay as Delay
    from carproof.execution.giving_way import GivenWay as GivenWay
    from carproof.execution.releasing import GrantsVerdict as GrantsVerdict
    from carproof.execution.releasing import Released as Released
    from carproof.execution.simulation import Driver as Driver
    from carproof.execution.simulation import Execution as Execution
    from carproof.execution.untangling import Untangled as Untangled
    from carproof.formats import MovingAIFiles as MovingAIFiles
    from carproof.formats import graph_of as graph_of
    from carproof.formats import instance_from_array as instance_from_array
    from carproof.formats import instance_from_networkx as instance_from_networkx
    from carproof.formats import read_foreign_solution as read_foreign_solution
    from carproof.formats import read_movingai as read_movingai
    from carproof.formats import write_foreign_solution as write_foreign_solution
    from carproof.formats import write_movingai as write_movingai
    from carproof.formats.plans.vda5050 import OrderSettings as OrderSettings
    from carproof.formats.plans.vda5050 import write_orders as write_orders
    from carproof.judging.audit import Audit as Audit
    from carproof.judging.audit import Late as Late
    from carproof.layouts import Imported as Imported
    from carproof.layouts import Settings as Settings
    from carproof.layouts import import_layout as import_layout
    from carproof.planner_options import planner_named as planner_named
    from carproof.registry import RULES as RULES
    from carproof.viewer.page import view as view
    from carproof.viewer.stills import view_chart as view_chart
    from carproof.viewer.stills import view_map as view_map

__all__: list[str]
__version__: str


@cache
def _modules() -> dict[str, str]:
    """The module of each name that the imports above name `as` itself."""
    import ast  # noqa: PLC0415 - slow to load
    from importlib.resources import files  # noqa: PLC0415

    page = ast.parse(files(__name__).joinpath("__init__.py").read_text(encoding="utf-8"))
    listed = (each for each in ast.walk(page) if isinstance(each, ast.ImportFrom))
    return {name.asname: str(each.module) for each in listed for name in each.names if name.asname}


if not TYPE_CHECKING:  # a type checker is to refuse a name that the imports do not name

    def __getattr__(name: str) -> object:
        """Load a name of this page when it is first used."""
        if name == "__version__":
            return import_module("importlib.metadata").version("carproof")
        if name == "__all__":
            return sorted(_modules())
        if name.startswith("_") or name not in _modules():
            raise AttributeError(f"module 'carproof' has no attribute {name!r}")
        value = globals()[name] = getattr(import_module(_modules()[name]), name)
        return value


def __dir__() -> list[str]:
    """The names of this page."""
    return [*_modules(), "__version__"]
