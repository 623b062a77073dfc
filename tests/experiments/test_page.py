"""The page says what the stored results say, and a claim is judged by its intervals."""

import re

import pytest

from carp_experiments.page import RESULTS, claims_of, read_run, results
from carp_experiments.paper.claims import up_to
from carp_experiments.paper.quality import Saving
from carp_experiments.statistics import Interval


def test_the_page_shows_every_figure_and_the_tables_of_every_stored_run() -> None:
    page = results()
    assert set(re.findall(r"!\[.*?\]\(figures/(.*?)\)", page)) == {path.name for path in RESULTS.glob("*.svg")}
    assert all(path.read_text() in page for path in RESULTS.glob("*.md"))


def test_what_is_reproduced_in_part_has_its_reason_beside_it() -> None:
    claims = [claim for path in RESULTS.glob("*.json") for claim in claims_of(read_run(path))]
    for claim in claims:
        assert bool(claim.reason) == (claim.verdict == "in part")
        assert bool(claim.reason_with_baseline) == (claim.with_baseline == "in part")
        assert all(f": {reason} |" in results() for reason in (claim.reason, claim.reason_with_baseline) if reason)


@pytest.mark.parametrize(
    ("low", "high", "verdict"), [(50, 70, "reproduced"), (10, 20, "in part"), (-5, 5, "not reproduced")]
)
def test_a_claim_with_a_number_holds_where_the_interval_holds_it(low: int, high: int, verdict: str) -> None:
    saving = Saving(10, "Proposed_6", "CARP", 20, Interval((low + high) / 2, low, high), 1000)
    own = {(10, "CARP"): Interval(1680, 1660, 1700), (10, "Proposed_6"): Interval(1618, 1600, 1636)}
    claim = up_to({(10, "Proposed_6", "CARP"): saving}, own, 10, ("Proposed_6",), 65, "up to 65 fewer")
    assert claim.verdict == verdict
    assert claim.found.endswith("between each one's own means: Proposed_6 62.0")
