"""The experiments beside the first: what they count and compare."""

from dataclasses import replace
from pkgutil import resolve_name

import msgspec
import pytest

import carp_optimized
import carp_reference
from carp_experiments.experiments import EXPERIMENTS, Experiment, Profile
from carp_experiments.paper import polishing
from carp_experiments.paper.adding_time import PAPER, time_row
from carp_experiments.paper.claims import related_claims, reuse_claims
from carp_experiments.paper.map_cases import MapCase, instance_of
from carp_experiments.paper.related_work import FIXED, METHODS, Related, related_report, related_row
from carp_experiments.paper.reuse_counts import ReuseOf, reuse_report
from carp_experiments.paper.small_gaps import COMPARED, POLISHED, GapRow, gap_report, gap_row
from carp_experiments.statistics import Interval
from carp_experiments.store import digest_of
from carp_spec import Carp, FixedPaths, Greedy, LongestFirst, Planner, plan_cost


def test_a_robot_alone_is_timed() -> None:
    assert MapCase(time_row, 15, 0, 1).run()["planned"] == dict.fromkeys(PAPER, 1)


def test_queries_are_told_apart_by_what_they_are_for() -> None:
    asked = {"nothing": 100, "kept": 70, "prefixes": 80, "the paper's": 50, "all": 9}
    row = {
        "asked": {name: dict.fromkeys(("3", "4", "5", "6", "10"), count) for name, count in asked.items()},
        "avoided": {size: {"kept": 30} for size in ("4", "5", "6", "10")},
    }
    summary = msgspec.convert(reuse_report([row], 20).summary, tuple[ReuseOf, ...])
    of_four = summary[0]
    assert of_four.outside.estimate == (18 + 17 + 16) - (100 - 70)
    assert of_four.orders.estimate == 50 - of_four.outside.estimate
    assert of_four.replanned.estimate == pytest.approx(100 * 21 / 51)
    assert [claim.verdict for claim in reuse_claims(summary)][-1] == "not reproduced"
    fewer = [replace(each, outside=Interval(20, 19, 21), orders=Interval(30, 22, 38)) for each in summary]
    assert [claim.verdict for claim in reuse_claims(fewer)][-1] == "reproduced"


def test_a_gap_is_measured_from_the_optimum() -> None:
    case = MapCase(gap_row, 3, 0, 5)
    row = case.run()
    assert row["decided"]
    results = row["results"]
    assert isinstance(results, dict)
    assert list(results) == [*COMPARED, POLISHED]
    assert all(total >= row["optimum"] for planned, total in results.values() if planned == 5)
    reported = msgspec.convert(row, GapRow)
    assert reported.shortest is not None
    assert reported.optimum is not None
    assert reported.shortest <= reported.bound <= reported.optimum
    assert results[POLISHED][1] <= results["Proposed_4"][1]
    best = {"map": 3, "assignment": 1, "shortest": 8, "bound": 9, "optimum": 10, "decided": True}
    reached = {**dict.fromkeys((*COMPARED, POLISHED), (5, 10)), "CARP": (5, 12), "LF": (4, 3)}
    unsolvable = {**best, "optimum": None, "results": reached}
    table = gap_report([{**best, "results": reached}, unsolvable], 5).tables[0]
    cells = {line[0]: line[1] for line in table.rows}
    assert cells["optimum known"] == "1/2"
    assert cells["CARP"] == "20.00 ± 0.00"
    assert cells["LF"] == "- (1 failed)"
    assert cells["lower bound"] == "-10.00 ± 0.00"


@pytest.mark.ci
def test_related_methods_are_those_of_the_reference() -> None:
    case = MapCase(related_row, 5, 2, 20)
    instance = instance_of(case)
    costs = case.run()["costs"]
    assert isinstance(costs, dict)
    assert set(costs) == set(METHODS)
    planners: dict[str, Planner] = {
        "3 shortest paths": FixedPaths(3, "shortest"),
        "3 disjoint paths": FixedPaths(3, "disjoint"),
        "CARP": Carp(),
        "LF": LongestFirst(),
        "greedy": Greedy(),
    }
    for name, planner in planners.items():
        plans = {each.robot: each for each in carp_reference.plan(instance, planner).plans}
        expected = [plan_cost(instance, plans[robot.id]) if robot.id in plans else None for robot in instance.robots]
        assert costs[name] == expected
    assert len({tuple(costs[name]) for name in planners}) == len(planners)
    report = related_report([case.run()], 20)
    assert [table.name for table in report.tables] == ["related-unplanned", "related-totals"]


def stored_costs(fixed: list[int | None], **ordered: list[int | None]) -> dict[str, object]:
    orders: dict[str, list[int | None]] = {name: [10, 10, 10] for name in ("CARP", "LF", "greedy")}
    return {"map": 7, "costs": {**dict.fromkeys(FIXED, fixed), **orders, **ordered}}


def test_fixed_paths_are_compared_over_the_first_robots_and_orders_over_all() -> None:
    rows = [
        stored_costs([11, 12, None], greedy=[8, None, 8], LF=[9, 9, 9]),
        stored_costs([None, 4, 5], greedy=[9, 9, 9]),
    ]
    unplanned, totals = ({line[0]: line[1] for line in table.rows} for table in related_report(rows, 3).tables)
    assert unplanned["3 disjoint paths"] == "1.0 ± 0.0"
    assert totals["3 disjoint paths"] == "15.0 ± 0.0 (1 of 2)"
    assert totals["greedy"] == "-10.0 ± 0.0 (1 of 2)"
    assert totals["LF"] == "-5.0 ± 9.8"
    assert "CARP" not in totals


@pytest.mark.parametrize(
    ("carp", "greedy", "longest", "verdicts"),
    [
        (10, 9, 11, ["reproduced", "reproduced"]),
        (10, 9, 8, ["reproduced", "in part"]),
        (10, 11, 12, ["reproduced", "in part"]),
        (10, 11, 9, ["reproduced", "not reproduced"]),
        (None, 9, 11, ["in part", "undecided"]),
    ],
)
def test_what_the_paper_cites_is_judged_by_intervals(
    carp: int | None, greedy: int, longest: int, verdicts: list[str]
) -> None:
    row = stored_costs([10, 11, None], CARP=[10, 10, carp], greedy=[greedy] * 3, LF=[longest] * 3)
    assert related_verdicts([row, row]) == verdicts


def related_verdicts(rows: list[dict[str, object]]) -> list[str]:
    summary = msgspec.convert(related_report(rows, 3).summary, tuple[Related, ...])
    return [claim.verdict for claim in related_claims(summary)]


def test_polished_plans_lie_between_the_bound_and_the_planner(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(
        polishing, "POLISHED", {"Proposed_4": {"polish": 100, "long polish": 300}, "Proposed_10": {"polish": 100}}
    )
    monkeypatch.setattr(polishing, "STEPS", 20)
    row = MapCase(polishing.polish_row, 12, 0, 10).run()
    reported = msgspec.convert(row, polishing.PolishRow)
    planned, polished, longer = (reported.results[name][1] for name in polishing.METHODS[:3])
    assert reported.shortest <= reported.bound <= longer <= polished <= planned
    assert row["left"] == {"Proposed_4": (), "Proposed_10": ()}
    again = dict(MapCase(polishing.polish_row, 12, 0, 10).run())
    assert digest_of(row) == digest_of(again)


def test_what_a_polish_reaches_on_its_way_is_what_a_shorter_one_reaches() -> None:
    instance = instance_of(MapCase(polishing.polish_row, 3, 1, 20))
    solution = carp_optimized.plan(instance, Carp())
    lengths = [50, 100, 400]
    _, (before, *after) = polishing.polish_to(instance, solution, lengths, 9)
    assert before == polishing.reached(instance, solution)
    assert after == [
        polishing.reached(instance, carp_optimized.polish(instance, solution, iterations=length, seed=9))
        for length in lengths
    ]
    assert after[0] != after[-1]


def test_the_functions_of_experiments_are_where_they_are_looked_for() -> None:
    for each in EXPERIMENTS:
        for name in (f"{each.functions}_row", f"{each.functions}_report"):
            assert callable(resolve_name(f"carp_experiments.{name}"))


@pytest.mark.parametrize("experiment", EXPERIMENTS, ids=lambda experiment: experiment.name)
def test_a_larger_profile_holds_the_cases_of_a_smaller_one(experiment: Experiment) -> None:
    small, large = experiment.cases(Profile(2, 4, (3, 9))), experiment.cases(Profile(3, 4, (3, 9, 11)))
    assert {case.key for case in small} <= {case.key for case in large}
    assert len({case.key for case in large}) == len(large) == 9
