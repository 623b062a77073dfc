"""Each claim of the paper's experiments: what it says, what we measured, and whether that reproduces it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from carp_experiments.adding_time import PAPER, SHOWN, Time
from carp_experiments.quality import FULL_MAP, QualitySummary, Saving
from carp_experiments.reuse_counts import PAPERS_SHARES, ReuseOf
from carp_experiments.statistics import Interval

Verdict: TypeAlias = Literal["reproduced", "in part", "not reproduced", "undecided"]
PROPOSED = ("Proposed_4", "Proposed_5", "Proposed_6", "Proposed_10")
TENTH_MAP = 10
COMPARABLE_PER_CENT = 1.0


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim of the paper, what we find, and the verdict on it."""

    claim: str
    found: str
    verdict: Verdict


def quality_claims(summary: QualitySummary) -> Iterator[Claim]:
    """The claims about failures and totals."""
    more = {(each.algorithm, each.rival): each.more for each in summary.failures}
    saved = {(each.map, each.algorithm, each.rival): each for each in summary.savings}
    than_carp = {name: more[name, "CARP"] for name in PROPOSED}
    than_carp10 = {name: more[name, "CARP10"] for name in PROPOSED}
    based = {rival: {name: more[f"{name} + baseline", rival] for name in PROPOSED} for rival in ("CARP", "CARP10")}
    yield Claim(
        "Proposed fails less often than CARP",
        "share of failures above CARP's, all maps: "
        f"{listed(than_carp, 100, 'points')}; with the baseline {listed(based['CARP'], 100, 'points')}",
        verdict_of([below_zero(each) for each in than_carp.values()]),
    )
    yield Claim(
        "Proposed fails more often than CARP10",
        "share of failures above CARP10's, all maps: "
        f"{listed(than_carp10, 100, 'points')}; with the baseline {listed(based['CARP10'], 100, 'points')}",
        verdict_of([above_zero(each) for each in than_carp10.values()]),
    )
    yield up_to(saved, TENTH_MAP, ("Proposed_6",), 65, "up to 65 fewer actions than CARP on the 10th map (Proposed_6)")
    both = ("Proposed_6", "Proposed_10")
    yield up_to(saved, FULL_MAP, both, 35, "up to 35 fewer than CARP on the original grid (Proposed_6, Proposed_10)")
    yield from comparisons(saved)


def comparisons(saved: Mapping[tuple[int | None, str, str], Saving]) -> Iterator[Claim]:
    """The claims about which algorithm has the smaller total, over all maps and where neither fails."""
    best = {name: saved[None, name, "Proposed_10"].saving for name in PROPOSED[:-1]}
    yield Claim(
        "Proposed_10 has the best results of the variants",
        "fewer actions than Proposed_10, all maps: " + listed(best),
        verdict_of([below_zero(each) for each in best.values()]),
    )
    than_carp10 = {name: saved[None, name, "CARP10"].saving for name in PROPOSED}
    yield Claim(
        "all variants outperform CARP10",
        "fewer actions than CARP10, all maps: " + listed(than_carp10),
        verdict_of([above_zero(each) for each in than_carp10.values()]),
    )
    than_carp100 = {name: share_of_total(saved[None, name, "CARP100"]) for name in PROPOSED}
    yield Claim(
        "all variants are at least comparable to CARP100",
        f"fewer actions than CARP100, in per cent of its total (comparable: at most {COMPARABLE_PER_CENT:g} % more): "
        + listed(than_carp100, unit="%"),
        verdict_of([above_zero(shifted(each, COMPARABLE_PER_CENT)) for each in than_carp100.values()]),
    )
    longest = {rival: saved[None, "LF", rival].saving for rival in ("CARP", "CARP10", "CARP100", "Proposed_10")}
    yield Claim(
        "LF generates the worst results",
        "fewer actions of LF than of the others, all maps: " + listed(longest),
        verdict_of([below_zero(each) for each in longest.values()]),
    )


def up_to(
    saved: Mapping[tuple[int | None, str, str], Saving], map: int, names: Sequence[str], paper: int, claim: str
) -> Claim:
    """A claim of so many fewer actions than CARP on a map; where another map has more, it is told too."""
    here = {name: saved[map, name, "CARP"].saving for name in names if (map, name, "CARP") in saved}
    every = [
        each for (place, name, rival), each in saved.items() if place is not None and name in names and rival == "CARP"
    ]
    known = [each for each in every if 4 * each.cases >= max(other.cases for other in every)]
    most = max(known, key=lambda each: each.saving.estimate)
    there = f"{most.algorithm} {plain(most.saving)} ({most.cases} cases)"
    found = f"map {map}: {listed(here)}; the most is on map {most.map}: {there}"
    verdicts: list[bool | None] = [each.low <= paper <= each.high for each in here.values()]
    more = [each.low > paper for each in here.values()]
    verdict = verdict_of(verdicts)
    if verdict != "reproduced" and all(above_zero(each) for each in here.values()):
        verdict = "in part"
        found += "; fewer than CARP, and " + ("more so than in the paper" if all(more) else "not by as many")
    return Claim(claim, found, verdict)


def reuse_claims(summary: Sequence[ReuseOf]) -> Iterator[Claim]:
    """The claims about queries."""
    last = {f"Proposed_{each.m}": each.last for each in summary if each.last is not None}
    wanted = [PAPERS_SHARES[each.m] for each in summary if each.last is not None]
    yield Claim(
        "with shared beginnings of orders, 67 %, 54 % and 45 % of the queries of 4, 5 and 6 neighbours remain",
        "of the last round's queries for orders: " + listed(last, unit="%"),
        verdict_of([abs(each.estimate - paper) <= 1 for each, paper in zip(last.values(), wanted, strict=True)]),
    )
    outside = {f"Proposed_{each.m}": each.replanned for each in summary if each.replanned is not None}
    yield Claim(
        "robots before the one taken out keep their plans, which halves the queries for those outside on average",
        "of them remain: " + listed(outside, unit="%"),
        verdict_of([each.low <= 50 <= each.high for each in outside.values()]),  # noqa: PLR2004 - a half
    )


def time_claims(summary: Sequence[Time]) -> Iterator[Claim]:
    """The claims about times, by the order of the means."""
    ratio = {(each.algorithm, each.k): each.ratio for each in summary}
    for place, k in enumerate(SHOWN):
        if ("CARP", k) not in ratio:
            continue
        papers = sorted(PAPER, key=lambda name: -PAPER[name][place])
        ours = sorted(PAPER, key=lambda name: -ratio[name, k].estimate)
        found = ", ".join(f"{name} {ratio[name, k].estimate:.1f}" for name in ours)
        verdicts: list[bool | None] = [ours[0] == papers[0], ours == papers]
        yield Claim(
            f"from the slowest to the fastest at robot {k}: {', '.join(papers)}",
            f"times CARP's: {found}",
            verdict_of(verdicts),
        )
    last = max(k for _, k in ratio)
    faster = {name: ratio["CARP100", last].estimate / ratio[name, last].estimate for name in PROPOSED}
    yield Claim(
        "Proposed is much faster than CARP100",
        f"CARP100's time at robot {last} over theirs: "
        + ", ".join(f"{name} {each:.0f}" for name, each in faster.items()),
        verdict_of([each > 1 for each in faster.values()]),
    )


def verdict_of(parts: Sequence[bool | None]) -> Verdict:
    """A claim of several parts, each of which holds, does not, or is open."""
    if all(parts):
        return "reproduced"
    if not any(parts):
        return "undecided" if None in parts else "not reproduced"
    return "in part"


def above_zero(interval: Interval) -> bool | None:
    """Whether the interval says so; `None` if it holds zero."""
    return True if interval.low > 0 else False if interval.high < 0 else None


def below_zero(interval: Interval) -> bool | None:
    """Whether the interval says so; `None` if it holds zero."""
    return above_zero(Interval(-interval.estimate, -interval.high, -interval.low))


def shifted(interval: Interval, by: float) -> Interval:
    """The interval, so much higher."""
    return Interval(interval.estimate + by, interval.low + by, interval.high + by)


def share_of_total(saving: Saving) -> Interval:
    """The saving in per cent of the rival's total."""
    return scaled(saving.saving, 100 / saving.total)


def scaled(interval: Interval, by: float) -> Interval:
    """The interval times a number above zero."""
    return Interval(interval.estimate * by, interval.low * by, interval.high * by)


def listed(intervals: Mapping[str, Interval], by: float = 1, unit: str = "") -> str:
    """Each name with its interval."""
    return ", ".join(
        f"{name} {plain(scaled(each, by))}{' ' + unit if unit else ''}" for name, each in intervals.items()
    )


def plain(interval: Interval) -> str:
    """The estimate and half its interval."""
    return f"{interval.estimate:.1f} ± {interval.high - interval.estimate:.1f}"
