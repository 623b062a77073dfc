"""Experiment 1: its shortcuts change no result, and its summary counts what failed."""

import pytest

import carp_optimized
from carp_experiments.paper.map_cases import MapCase, instance_of
from carp_experiments.paper.quality import ALGORITHMS, quality_report, quality_row, seeded, summarise
from carp_experiments.store import Row
from carp_spec import total_cost


@pytest.mark.parametrize("case", [MapCase(quality_row, 4, 1, 30), MapCase(quality_row, 17, 2, 20)])
def test_a_case_has_the_totals_of_the_planners_alone(case: MapCase) -> None:
    instance = instance_of(case)
    results = case.run()["results"]
    assert isinstance(results, dict)
    for name, planner in ALGORITHMS.items():
        planned, total = results[name]
        solution = carp_optimized.plan(instance, seeded(planner, case.assignment))
        assert (planned == case.robots) == (not solution.unplanned), name
        if planned == case.robots:
            assert total == total_cost(instance, solution.plans), name


def row(map: int, assignment: int, **results: tuple[int, int]) -> Row:
    every = dict.fromkeys(ALGORITHMS, (2, 10)) | results
    return {"map": map, "assignment": assignment, "shortest": 8, "results": every}


def test_the_summary_counts_failures_and_compares_where_neither_fails() -> None:
    rows = [row(0, 0, CARP=(2, 14)), row(0, 1, CARP=(1, 3)), row(0, 2, CARP=(2, 18), LF=(0, 0))]
    summary = summarise(rows, robots=2)
    carp = summary.algorithms[0]
    assert (carp.algorithm, carp.failures, carp.assignments) == ("CARP", 1, 3)
    assert carp.total is not None
    assert carp.total.estimate == 16
    savings = {(each.map, each.algorithm, each.rival): each for each in summary.savings}
    assert savings[0, "Proposed_4", "CARP"].saving.estimate == 6
    assert savings[0, "Proposed_4", "CARP"].total == 16
    assert savings[0, "LF", "CARP"].cases == 1
    more = {(each.algorithm, each.rival): each.more.estimate for each in summary.failures}
    assert more["Proposed_4", "CARP"] == pytest.approx(-1 / 3)
    assert more["LF", "CARP"] == 0
    assert "all failed" not in quality_report(rows, 2).tables[1].markdown


def test_what_is_measured_on_one_assignment_counts_as_one_over_all_maps() -> None:
    rows = [row(map, assignment, CARP=(2, 12 + 2 * assignment)) for map in (0, 1) for assignment in (0, 1)]
    one, all = (
        next(each for each in summarise(rows, 2).savings if (each.map, each.algorithm) == (map, "LF"))
        for map in (0, None)
    )
    assert (one.saving, one.cases) == (all.saving, 2)
    assert all.cases == 4
