"""The crosscheck campaign: its questions are sound and various, and it finds what differs."""

import pytest

import carp_optimized
from carp_experiments.measuring.crosscheck_campaign import CROSSCHECK, Block, ask_both
from carp_spec import Instance, Neighbourhood, Planner, ResourceGraph, Solution, judge
from carp_spec.instance_rules import instance_faults
from carproof.testing.random_instances import question


def test_questions_are_sound_and_the_same_every_time() -> None:
    for number in range(300):
        subject, planner = question(5, number)
        assert question(5, number) == (subject, planner)
        instance = subject if isinstance(subject, Instance) else subject.instance
        assert instance_faults(instance) == ()
        if not isinstance(subject, Instance):
            assert judge(subject.instance, subject.solution).valid
            assert subject.robot in subject.solution.unplanned


def test_questions_mix_everything() -> None:
    asked = [question(0, number) for number in range(300)]
    instances = [subject for subject, _ in asked if isinstance(subject, Instance)]
    assert {instance.after_goal for instance in instances} == {"vanish", "park"}
    assert {instance.graph.directed for instance in instances} == {False, True}
    assert {planner.name for _, planner in asked} == {"carp", "shuffled", "longest-first", "greedy", "neighbourhood"}
    added = [(subject, planner) for subject, planner in asked if not isinstance(subject, Instance)]
    assert all(isinstance(planner, Neighbourhood) for _, planner in added)
    assert len({subject.now for subject, _ in added}) > 5


@pytest.mark.parametrize("kind", [None, "stops"])
def test_the_engines_agree(kind: str | None) -> None:
    report = CROSSCHECK.report(case.run() for case in CROSSCHECK.cases(150, 3, kind))
    assert report.holds
    assert report.tables[0].rows[0][0] == "150"


def test_the_engines_and_searches_tick_by_tick_agree_with_groups() -> None:
    report = CROSSCHECK.report(case.run() for case in CROSSCHECK.cases(60, 3, "groups"))
    assert report.holds


def test_windows_that_forget_groups_differ_by_ticks(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ResourceGraph, "constraints_of", lambda graph, resource: (graph.index[resource],))
    report = CROSSCHECK.report(case.run() for case in CROSSCHECK.cases(30, 0, "groups"))
    assert not report.holds
    assert '"by ticks"' in report.lines[0]


@pytest.mark.parametrize("number", [277171, 286610, 726564])
def test_the_engines_agree_where_they_once_differed(number: int) -> None:
    """A robot whose new plan, but not the one that it follows, has ended by now can still be taken in."""
    block = Block(1)
    ask_both(block, seed=0, number=number)
    assert block.differences == []


def test_a_planted_difference_is_told_with_its_question(monkeypatch: pytest.MonkeyPatch) -> None:
    plan = carp_optimized.plan

    def forgetful(instance: Instance, planner: Planner) -> Solution:
        right = plan(instance, planner)
        return Solution(right.plans[::-1], right.order, right.unplanned)

    monkeypatch.setattr(carp_optimized, "plan", forgetful)
    report = CROSSCHECK.report(case.run() for case in CROSSCHECK.cases(30, seed=0))
    assert not report.holds
    assert "A DIFFERENCE" in report.lines[0]
    assert '"question"' in report.lines[0]
