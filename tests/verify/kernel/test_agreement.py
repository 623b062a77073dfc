"""The proved kernel and the checkers in Python agree: on every small instance, large solutions, random questions."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice

import msgspec
import pytest
from tests.enumeration import ASKED, PATTERNS, Pattern, SmallCase, small_cases
from tests.verify.kernel.program import program

import carp_optimized
import carp_reference
from carp_experiments.measuring import kernel_verdicts
from carp_experiments.measuring.blocks import BLOCK
from carp_experiments.measuring.kernel_verdicts import VERDICTS, Question, Verdicts, checked, compared, verified
from carp_spec import Carp, Instance, Solution
from carp_verify.kernel import KernelVerdict, ask
from carproof.generate import Fleet, Grid, Warehouse, grid_instance, warehouse_instance
from carproof.testing.mutations import MUTATIONS


@pytest.fixture(autouse=True)
def _kernel() -> None:
    program()


def differences(questions: Iterator[Question]) -> list[object]:
    """The questions on which the kernel differs, asked in blocks; all kinds of verdicts must be among the answers."""
    found: list[object] = []
    kinds = set()
    while block := list(islice(questions, BLOCK)):
        kinds |= {each.kind for each in block}
        found += compared(0, block, ask([each.request for each in block])).differences
    assert {"sound", "broken"} <= kinds
    return found


def small_questions(case: SmallCase) -> Iterator[Question]:
    """The third robot's plan beside the others and without heed to them, and its certificate, honest and too high."""
    instance, others = case.instance, Solution.of(case.instance, case.committed)
    certifier = carp_reference.certifier(instance)
    alone, _ = certifier.certify(ASKED)
    certifier.commit(case.committed)
    plan, certificate = certifier.certify(ASKED)
    for each in (plan, alone):
        yield checked(instance, others if each is None else Solution.of(instance, (*case.committed, each)))
    yield verified(instance, others, certificate)
    later = None if certificate.bound is None else certificate.bound + 1
    yield verified(instance, others, msgspec.structs.replace(certificate, bound=later))


@pytest.mark.parametrize(
    ("pattern", "last", "step"),
    [
        pytest.param(PATTERNS[3], 3000, 7, id="some"),
        *(pytest.param(pattern, None, 1, id=str(pattern.durations), marks=pytest.mark.nightly) for pattern in PATTERNS),
    ],
)
def test_the_kernel_agrees_on_every_small_instance(pattern: Pattern, last: int | None, step: int) -> None:
    """Connected graphs of up to 4 resources, three robots, both policies; the first 3,000 have up to 3 resources."""
    cases = islice(small_cases(pattern), 0, last, step)
    assert differences(question for case in cases for question in small_questions(case)) == []


def large_questions(instance: Instance, mutants: int) -> Iterator[Question]:
    """A large solution, the first mutants of it of each kind, and the certificate of the last robot planned."""
    solution = carp_optimized.plan(instance, Carp())
    yield checked(instance, solution)
    for mutation in MUTATIONS:
        for mutant in islice(mutation(instance, solution), mutants):
            yield checked(mutant.instance, mutant.solution)
    last = solution.order[-1]
    plans = tuple(plan for plan in solution.plans if plan.robot != last)
    others = replace(solution, plans=plans, order=solution.order[:-1], unplanned=(*solution.unplanned, last))
    certifier = carp_optimized.certifier(instance)
    certifier.commit(plans)
    _, certificate = certifier.certify(last)
    assert certificate.bound is not None
    yield verified(instance, others, certificate)
    yield verified(instance, others, msgspec.structs.replace(certificate, bound=certificate.bound + 1))


def test_the_kernel_agrees_on_solutions_of_the_papers_size() -> None:
    instance = grid_instance(Grid(map=10), Fleet(robots=100, seed=4))
    assert differences(large_questions(instance, 1)) == []


@pytest.mark.nightly
def test_the_kernel_agrees_on_solutions_of_the_size_of_movingai_benchmarks() -> None:
    """161 x 63 cells, as warehouse-10-20-10-2-1 has, and 200 robots."""
    warehouse = Warehouse(columns=13, rows=15, rack_length=10, stations=40)
    instance = warehouse_instance(warehouse, Fleet(robots=200, seed=4, after_goal="park", distinct="starts"))
    assert differences(large_questions(instance, 2)) == []


# ---- the campaign ----


def test_the_campaign_finds_no_difference_and_draws_all_kinds() -> None:
    report = VERDICTS.report(case.run() for case in VERDICTS.cases(300, seed=5))
    assert report.holds
    counts = [int(cell) for cell in report.tables[0].rows[0]]
    assert counts[0] == sum(counts[1:5]) == 300
    assert all(count > 20 for count in counts[1:5])
    assert counts[5] == 0


@pytest.mark.parametrize("change", [{"verdict": "refused", "rule": "plan/pace"}, {"cost": 1000, "bound": 1000}])
def test_a_planted_difference_is_shown_with_its_question(
    monkeypatch: pytest.MonkeyPatch, change: dict[str, object]
) -> None:
    def wrong(requests: list[bytes]) -> list[KernelVerdict]:
        return [msgspec.structs.replace(answer, **change) for answer in ask(requests)]

    monkeypatch.setattr(kernel_verdicts, "ask", wrong)
    (row,) = (case.run() for case in VERDICTS.cases(30, seed=0))
    block = msgspec.convert(row, Verdicts)
    accepted = block.sound + block.proved
    assert accepted > 0
    assert len(block.differences) == (30 if "verdict" in change else accepted)
    report = VERDICTS.report([row])
    assert not report.holds
    assert "A DIFFERENCE" in report.lines[0]
    assert '"request"' in report.lines[0]
