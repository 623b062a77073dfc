"""Planners that read MovingAI files and write formats of their own are asked as they are, without glue code."""

import json
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.oracle.formats.foreign_files import INSTANCE
from tests.oracle.running import Run
from tests.profiles import draws, rest_in

import carp_reference
from carp_optimum.optimum import optimum
from carp_spec import Carp, Instance, Refusal, Resource, ResourceGraph, Robot, Solution
from carp_spec.permutations import splitmix64
from carproof.conform.asking.random_cases import classical_case
from carproof.conform.levels import Level
from carproof.conform.programs.function import Function
from carproof.conform.run import Options, conform
from carproof.formats.movingai import movingai_instance, read_map, read_scenario
from carproof.formats.movingai_writer import is_classical, write_movingai
from carproof.testing.random_instances import Draw

PLANNER = [sys.executable, "-I", "-S", str(Path(__file__).parent / "grid_planner.py")]
FILES = ["{map}", "{scen}", "{agents}"]


@settings(max_examples=draws(200))
@given(st.integers(0, 2**64 - 1))
def test_what_is_drawn_is_classical_and_survives_the_way_to_files_and_back(seed: int) -> None:
    instance = classical_case(Draw(splitmix64(seed))).instance
    assert is_classical(instance)
    files = write_movingai(instance)
    grid = read_map(files.map)
    kept = {(resource.x, resource.y) for resource in instance.graph.resources}
    read = movingai_instance(grid, read_scenario(files.scen, grid, None), "park")
    assert read == instance
    assert kept == {(x, y) for y in range(grid.height) for x in range(grid.width) if grid.is_passable(x, y)}


RESOURCES, EDGES = INSTANCE.graph.resources, INSTANCE.graph.edges
FIRST, SECOND = INSTANCE.robots


def with_graph(resources: tuple[Resource, ...] = RESOURCES, edges: tuple[Any, ...] = EDGES) -> Instance:
    return replace(INSTANCE, graph=ResourceGraph(resources, edges))


def with_robots(*robots: Robot) -> Instance:
    return replace(INSTANCE, robots=robots)


@pytest.mark.parametrize(
    "instance",
    [
        replace(INSTANCE, after_goal="vanish"),
        with_robots(),
        with_robots(replace(FIRST, release=1), SECOND),
        with_robots(FIRST, replace(SECOND, pace=2)),
        with_robots(FIRST, replace(SECOND, start=FIRST.start)),
        with_robots(FIRST, replace(SECOND, stops=FIRST.stops)),
        with_graph((replace(RESOURCES[0], capacity=2), *RESOURCES[1:])),
        with_graph((*RESOURCES[:-1], replace(RESOURCES[-1], duration=2))),
        with_graph((replace(RESOURCES[0], x=None), *RESOURCES[1:])),
        with_graph((replace(RESOURCES[0], x=-1), *RESOURCES[1:])),
        with_graph((replace(RESOURCES[0], x=1), *RESOURCES[1:])),
        with_graph((*RESOURCES, Resource("far", x=10**6, y=10**6))),
        with_graph(edges=EDGES[1:]),
        with_graph(edges=(*EDGES, ("0,0", "2,0"))),
    ],
)
def test_an_instance_that_the_files_cannot_say_is_not_classical_and_not_written(instance: Instance) -> None:
    assert is_classical(INSTANCE)
    assert not is_classical(instance)
    with pytest.raises(Refusal):
        write_movingai(instance)


def report_of(process: Run, *arguments: str) -> dict[str, Any]:
    outcome = process("conform", "--one-shot", "--json", "--seed", "0", "--large", "2", *arguments)
    assert outcome.code in (0, 1), outcome
    report: dict[str, Any] = json.loads(outcome.stdout)
    return report


@pytest.mark.parametrize(
    ("options", "template"),
    [
        ([], [*PLANNER, *FILES, "-o", "{solution}"]),
        (["--from", "paths-x-y"], [*PLANNER, *FILES, "--paths"]),
    ],
)
def test_a_right_planner_conforms_and_is_not_asked_what_its_files_cannot_say(
    process: Run, elsewhere: Path, options: list[str], template: list[str]
) -> None:
    report = report_of(process, "--examples", "20", *options, "--", *template)
    assert report["conforms"], report["failures"]
    assert report["cases"]["random"] == {"passed": 20}
    assert report["cases"]["smoke"].keys() == {"passed", "not asked"}
    assert report["cases"]["vectors"].keys() <= {"passed", "not asked"}
    assert list(elsewhere.iterdir()) == [], "nothing is left behind"


@pytest.mark.parametrize(
    ("forgotten", "rule"), rest_in("ci", [("swaps", "joint/exchange"), ("parked", "joint/capacity")], 0)
)
def test_a_bug_is_refused_by_its_rule_with_a_small_benchmark(
    process: Run, elsewhere: Path, forgotten: str, rule: str
) -> None:
    template = [*PLANNER, *FILES, "--forget", forgotten]
    report = report_of(process, "--shrinking", "4", "--", *template)
    assert {failure["rule"] for failure in report["failures"]} == {rule}
    assert report["failures"][0]["robots"] == 2
    assert report["failures"][0]["resources"] <= 5
    found = elsewhere / report["saved"]
    grid = read_map((found / "instance.map").read_bytes())
    assert len(read_scenario((found / "instance.scen").read_bytes(), grid, None)) == 2
    assert process("check", str(found / "instance.json"), str(found / "solution.json")).code == 1


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize(("program", "category"), [("cat", "protocol error"), ("false", "crash")])
def test_a_program_that_writes_no_solution_has_failed(process: Run, program: str, category: str) -> None:
    report = report_of(process, "--examples", "0", "--", program, "{map}", "{scen}")
    assert {failure["category"] for failure in report["failures"]} == {category}


def test_a_format_that_could_be_two_is_asked_for_before_any_case(process: Run, elsewhere: Path) -> None:
    template = [sys.executable, "-c", "print('Agent 0: (0,0)->(0,1)->')", *FILES]
    outcome = process("conform", "--one-shot", "--", *template)
    assert (outcome.code, outcome.stdout) == (2, "")
    assert "the format must be named by --from: it could be paths-row-column, paths-x-y" in outcome.stderr
    assert list(elsewhere.iterdir()) == []


@pytest.mark.usefixtures("elsewhere")
def test_a_program_that_never_writes_a_plan_does_not_conform(process: Run) -> None:
    report = report_of(process, "--examples", "10", "--", "true", "{map}", "{scen}")
    assert (report["conforms"], report["failures"]) == (False, [])
    assert "[program/tries]" in report["shortfalls"][0]


def best(instance: Instance) -> Solution:
    found = optimum(instance, 3)
    return found.solution or Solution((), (), tuple(instance.robot))


def test_who_plans_best_reaches_the_highest_level_of_such_planners() -> None:
    options = Options(Level.OPTIMAL, examples=40, whole=True, classical=True)
    assert conform(Function(best, "best"), options).conforms


def prioritized(instance: Instance) -> Solution:
    return carp_reference.plan(instance, Carp())


def test_a_prioritized_planner_is_complete_in_context_and_not_complete() -> None:
    planner = Function(prioritized, "prioritized")
    assert conform(planner, Options(Level.CONTEXT_OPTIMAL, examples=30, whole=True)).conforms
    report = conform(planner, Options(Level.COMPLETE, examples=0, whole=True))
    assert {finding.rule for finding in report.findings} == {"program/complete"}
    wrong = [outcome.case.name for outcome in report.outcomes if outcome.finding is not None]
    assert "plan: one must make room for the other, park" in wrong
