"""The theorems of the proved kernel, and the rules that they support.

`make kernel` has Coq check their proofs, and fails unless each rests on no axiom.
"""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Theorem:
    """A theorem by its name in a Coq module of `verify/kernel`, its statement, and the rules that it supports."""

    module: str
    name: str
    statement: str
    rules: tuple[str, ...] = ()

    @property
    def file(self) -> str:
        """The file with its proof."""
        return f"verify/kernel/{self.module}.v"


_OF_INSTANCES = (
    "resource-id",
    "capacity",
    "duration",
    "edge",
    "group",
    "robot-id",
    "endpoint",
    "stops",
    "release",
    "pace",
)
_OF_PLANS = ("start", "goal", "stops", "resource", "move", "contiguous", "duration")

THEOREMS = (
    Theorem(
        "Checker",
        "instance_is_well_formed_exactly_when_accepted",
        "an instance is accepted if and only if it keeps the rules of instances",
        tuple(f"instance/{name}" for name in _OF_INSTANCES),
    ),
    Theorem(
        "Checker",
        "checker_accepts_exactly_lawful_solutions",
        "a solution is accepted if and only if it keeps every rule at every tick",
        (
            "solution/covers",
            "solution/order",
            *(f"plan/{name}" for name in _OF_PLANS),
            "joint/capacity",
            "joint/exchange",
            "joint/following",
            "joint/group",
        ),
    ),
    Theorem(
        "Checker",
        "accepted_solutions_are_exactly_the_lawful_ones",
        "the same from the documents on: instance and solution",
        (*(f"instance/{name}" for name in _OF_INSTANCES), "solution/covers", "solution/order"),
    ),
    Theorem(
        "Checker",
        "solution_cost_is_the_total_cost",
        "the cost in a verdict is the sum of the plans' costs",
        ("cost/total",),
    ),
    Theorem(
        "Stops",
        "plans_that_serve_all_are_counted",
        "counting a stop as served as soon as a visit allows it accepts exactly the plans that serve all stops",
        ("plan/stops",),
    ),
    Theorem(
        "Stops",
        "stops_served_so_far_count",
        "what has been served so far need not be served again, whatever comes later",
        ("plan/stops", "fleet/history"),
    ),
    Theorem(
        "Windows",
        "free_windows_are_maximal",
        "the computed windows are exactly the maximal intervals in which one more robot has room, in groups too",
        ("window/free",),
    ),
    Theorem(
        "Windows",
        "free_windows_are_in_order_of_time",
        "each computed window has ended before the next one opens",
        ("window/free",),
    ),
    Theorem(
        "QueryOptimal",
        "free_windows_are_unique",
        "two maximal intervals of free ticks that share a tick are the same",
        ("window/free",),
    ),
    Theorem(
        "QuerySound",
        "stays_that_fit_have_room",
        "at each tick of a stay within a free window the resource has room for one more robot",
        ("window/fits", "joint/capacity", "joint/following", "joint/group", "query/sound"),
    ),
    Theorem(
        "QuerySearch",
        "entry_is_the_least_allowed",
        "the tick at which the query enters a window is the least one that is no exchange",
        ("query/optimal", "query/complete", "joint/exchange"),
    ),
    Theorem(
        "QueryOptimal",
        "earliest_entry_dominates",
        "wherever a robot can go after a later entry into a window, it can go after an earlier one",
        ("query/optimal", "query/complete", "window/fits"),
    ),
    Theorem(
        "QuerySearch",
        "settled_entry_is_final",
        "no way leads into a window before the tick at which the query has settled it",
        ("query/optimal",),
    ),
    Theorem(
        "QueryHistory",
        "history_is_kept",
        "the plan found for a robot under way keeps what the robot has done",
        ("fleet/history", "plan/duration"),
    ),
    Theorem(
        "QueryOptimal",
        "query_returns_a_sound_plan_of_least_arrival",
        "the CARP query of a robot with a goal returns a plan that keeps the law, and no such plan arrives earlier",
        ("query/sound", "query/optimal"),
    ),
    Theorem(
        "QueryOptimal",
        "query_returns_none_only_if_there_is_none",
        "the CARP query of a robot with a goal returns no plan only where every plan breaks the law",
        ("query/complete",),
    ),
    Theorem(
        "QueryCertificate",
        "accepted_query_is_optimal",
        "labels closed up to a bound, under a consistent potential (heuristic), leave no plan that arrives before it",
        ("query/optimal", "query/complete"),
    ),
    Theorem(
        "Audit",
        "accepted_query_of_a_solution_is_optimal",
        "the same from the documents on: instance, solution, and `carproof-query/1`",
        ("query/optimal", "query/complete"),
    ),
    Theorem(
        "Audit",
        "plans_of_an_accepted_audit_are_optimal",
        "an audited solution is lawful, and no robot can arrive earlier beside the plans before its own",
        ("query/optimal",),
    ),
    Theorem(
        "Prices",
        "all_pay_no_more_than_prices_times_capacities",
        "the robots of a lawful solution together pay at most the prices times the capacities",
        ("joint/capacity", "joint/exchange"),
    ),
    Theorem(
        "Prices",
        "all_pay_no_more_than_group_prices_times_capacities",
        "the robots of a lawful solution together pay at most the prices of groups times their capacities",
        ("joint/group",),
    ),
    Theorem(
        "Labels",
        "claim_is_below_every_plan",
        "no plan of a robot has less weighted cost and prices than its labels show",
        ("cost/total",),
    ),
    Theorem(
        "Bound",
        "robot_without_a_claim_has_no_way",
        "a robot left out of a bound has no way to its goal",
        ("cost/total",),
    ),
    Theorem(
        "Bound",
        "accepted_bound_is_below_every_solution",
        "no lawful solution that plans every plannable robot costs less than an accepted bound, if its groups hold",
        ("cost/total",),
    ),
    Theorem(
        "Refutation",
        "accepted_refutation_means_unsatisfiable",
        "a formula with an accepted refutation is false, whatever its variables are",
    ),
    Theorem(
        "Total",
        "justified_clause_is_kept",
        "a lawful solution in which robots cost less than a total, or keep deadlines, keeps each clause of the formula",
        ("cost/total", "joint/capacity", "joint/exchange"),
    ),
    Theorem(
        "Total",
        "refuted_total_is_impossible",
        "no lawful solution that plans every plannable robot costs less than a total whose formula is refuted",
        ("cost/total",),
    ),
    Theorem(
        "Total",
        "refuted_instance_has_no_solution",
        "no lawful solution plans every plannable robot if the formula of any total is refuted",
        ("cost/total",),
    ),
    Theorem(
        "Total",
        "proved_claim_holds_of_every_solution",
        "the same two from the documents on: instance, manifest and refutation of a proof directory",
        ("cost/total",),
    ),
    Theorem(
        "Total",
        "refuted_deadlines_are_not_all_kept",
        "in each lawful solution of all plannable robots, one of the robots with refuted deadlines breaks its own",
    ),
    Theorem(
        "Total",
        "bound_with_refuted_groups_is_below_every_solution",
        "from the documents on: no lawful solution of all plannable robots costs less than a `carproof-bound/1` proves",
        ("cost/total",),
    ),
    Theorem(
        "Execution",
        "order_preserving_execution_is_safe",
        "robots that keep the order of a lawful solution break no joint rule, whatever the delays; without groups",
        ("execution/order", "execution/exchange", "joint/capacity", "joint/exchange"),
    ),
    Theorem(
        "Dependencies",
        "safe_switching_keeps_acyclicity",
        "a switch whose new edge closes no cycle leaves a dependency graph without one",
        ("execution/acyclic",),
    ),
    Theorem(
        "Order",
        "lawful_solution_executes_itself",
        "a lawful solution is an execution of itself, without delays",
        ("execution/order", "execution/exchange"),
    ),
    Theorem(
        "Waiting",
        "direct_edges_are_enough",
        "edges of the dependency graph that follow from others can be left out",
        ("execution/order",),
    ),
    Theorem(
        "Waiting",
        "late_robots_never_deadlock",
        "if the dependency graph has no cycle, some robot can move on until all have arrived",
        ("execution/acyclic",),
    ),
    Theorem(
        "Waiting",
        "everybody_arrives_exactly_when_acyclic",
        "every robot gets to enter all its visits if and only if the dependency graph has no cycle",
        ("execution/acyclic",),
    ),
    Theorem(
        "Waiting",
        "cycles_are_rotations",
        "robots that wait for each other in a circle enter at one tick by the plans",
        ("execution/acyclic",),
    ),
    Theorem(
        "Waiting",
        "without_following_no_cycle",
        "where following is forbidden, the dependency graph has no cycle",
        ("execution/acyclic", "joint/following"),
    ),
    Theorem(
        "Retiming",
        "ticks_that_keep_the_edges_are_an_execution",
        "plans at ticks that keep the edges of the dependency graph are an execution of it",
        ("execution/order",),
    ),
    Theorem(
        "Retiming",
        "retime_is_earliest",
        "in no execution in the same order does a robot enter a visit earlier than in the retimed plans",
        ("execution/order",),
    ),
    Theorem(
        "Retiming",
        "retimed_solution_is_lawful",
        "if each robot appears at its release, the retimed plans are a lawful solution; without groups and stops",
        ("execution/duration", "execution/order"),
    ),
    Theorem(
        "Switching",
        "switched_order_is_safe",
        "plans at ticks that keep the edges of a switched order break no joint rule; without groups",
        ("joint/capacity", "joint/exchange"),
    ),
    Theorem(
        "Lateness",
        "lateness_is_at_most_the_delays",
        "no robot that moves as soon as its dependencies allow is later than all delays together",
        ("execution/order",),
    ),
)
