"""The claims of the paper's experiments, our measurements, and whether these reproduce the claims."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from carp_experiments.paper.adding_time import PAPER, SHOWN, Time
from carp_experiments.paper.map_cases import FULL_MAP, TENTH_MAP
from carp_experiments.paper.quality import FEWEST_SHOWN, RIVALS, QualitySummary, Saving
from carp_experiments.paper.related_work import FIXED, Related
from carp_experiments.paper.reuse_counts import PAPERS_SHARES, ReuseOf
from carp_experiments.statistics import Interval

Verdict: TypeAlias = Literal["reproduced", "in part", "not reproduced", "undecided"]
Savings: TypeAlias = Mapping[tuple[int | None, str, str], Saving]
Means: TypeAlias = Mapping[tuple[int, str], Interval]
BASELINE = " + baseline"
PROPOSED = ("Proposed_4", "Proposed_5", "Proposed_6", "Proposed_10")
COMPARABLE_PER_CENT = 1.0
HALF = 50  # per cent
OTHER_CONVENTIONS = (
    "fewer, but not as many; the number comes out with the baseline, robots that stay one tick longer at their goals, "
    "and starts and goals that repeat"
)
SOME_MAPS = "the intervals show it on some maps, but not on every one"
NO_BASELINE = "most probably the paper's program had the baseline, with which all hold"
FASTER = (
    "CARP100 is the slowest, but our program avoids most queries of the neighbourhood planner that the paper's asks"
)
MORE = "there fewer than half remain"


@dataclass(frozen=True, slots=True)
class Claim:
    """A claim of the paper, our finding, and the verdict; also the verdict on our variant, whose baseline is on.

    A verdict in part has a reason: what of the claim does not come out, and why.
    """

    claim: str
    found: str
    verdict: Verdict
    with_baseline: Verdict | None = None
    reason: str = ""
    reason_with_baseline: str = ""


def quality_claims(summary: QualitySummary) -> Iterator[Claim]:
    """The claims about failures and totals."""
    more = {(each.algorithm, each.rival): scaled(each.more, 100) for each in summary.failures}
    saved = {(each.map, each.algorithm, each.rival): each for each in summary.savings}
    yield judged(
        "Proposed fails less often than CARP",
        "its share of failures above that of CARP, in points, all maps",
        lambda name: more[name, "CARP"],
        below_zero,
    )
    yield judged(
        "Proposed fails more often than CARP10",
        "its share of failures above that of CARP10, in points, all maps",
        lambda name: more[name, "CARP10"],
        above_zero,
    )
    own = {(each.map, each.algorithm): each.total for each in summary.algorithms if each.total is not None}
    tenth = "up to 65 fewer actions than CARP on the 10th map (Proposed_6)"
    yield up_to(saved, own, TENTH_MAP, ("Proposed_6",), 65, tenth)
    full = "up to 35 fewer than CARP on the original grid (Proposed_6, Proposed_10)"
    yield up_to(saved, own, FULL_MAP, ("Proposed_6", "Proposed_10"), 35, full)
    yield from comparisons(saved)


def comparisons(saved: Savings) -> Iterator[Claim]:
    """The claims about which algorithm has the smaller total, over all maps and where neither fails."""
    yield judged(
        "Proposed_10 has the best results of the variants",
        "fewer actions than Proposed_10, all maps",
        lambda name: saving_of(saved, name, "Proposed_10"),
        below_zero,
        PROPOSED[:-1],
        has_baseline=False,
    )
    yield judged(
        "all variants outperform CARP10",
        "fewer actions than CARP10, all maps",
        lambda name: saving_of(saved, name, "CARP10"),
        above_zero,
    )
    yield judged(
        "all variants are at least comparable to CARP100",
        "fewer actions than CARP100, in per cent of its total, all maps "
        f"(comparable: at most {COMPARABLE_PER_CENT:g} % more)",
        lambda name: share_of_total(saved.get((None, name, "CARP100"))),
        lambda each: above_zero(shifted(each, COMPARABLE_PER_CENT)),
    )
    yield judged(
        "LF generates the worst results",
        "fewer actions of LF than of the others, all maps",
        lambda name: saving_of(saved, "LF", name),
        below_zero,
        RIVALS,
        has_baseline=False,
    )


def judged(
    claim: str,
    what: str,
    measured: Callable[[str], Interval | None],
    holds: Callable[[Interval], bool | None],
    names: Sequence[str] = PROPOSED,
    has_baseline: bool = True,
) -> Claim:
    """A claim that holds of all the algorithms, or of their variants with the baseline; open where nothing is known."""

    def verdict_on(variants: Sequence[str]) -> tuple[Verdict, str, str]:
        known = {name: measured(name) for name in variants}
        found = listed({name: each for name, each in known.items() if each is not None})
        parts = {name: None if each is None else holds(each) for name, each in known.items()}
        return verdict_of([*parts.values()]), found, parts_of(parts)

    verdict, found, reason = verdict_on(names)
    found = f"{what}: {found}"
    if not has_baseline:
        return Claim(claim, found, verdict, reason=reason)
    with_baseline, based, other_reason = verdict_on([name + BASELINE for name in names])
    if reason and with_baseline == "reproduced":
        reason += f"; {NO_BASELINE}"
    return Claim(claim, f"{found}; with the baseline: {based}", verdict, with_baseline, reason, other_reason)


def parts_of(parts: Mapping[str, bool | None]) -> str:
    """Of which names a claim holds, and of which it does not, if it holds in part."""
    kinds = {"holds for": True, "not for": False, "open for": None}
    named = {kind: [name for name, each in parts.items() if each is value] for kind, value in kinds.items()}
    said = "; ".join(f"{kind} {', '.join(names)}" for kind, names in named.items() if names)
    return said if verdict_of([*parts.values()]) == "in part" else ""


def saving_of(saved: Savings, name: str, rival: str) -> Interval | None:
    """What an algorithm saves over a rival on all maps; `None` if one of the two fails wherever the other does not."""
    saving = saved.get((None, name, rival))
    return None if saving is None else saving.saving


def up_to(saved: Savings, own: Means, map: int, names: Sequence[str], paper: int, claim: str) -> Claim:
    """A claim of a number of fewer actions than CARP on a map.

    The claim also has the map with the largest number, and the number between each algorithm's own means.
    """
    based = [name + BASELINE for name in names]
    here = {name: saved[map, name, "CARP"].saving for name in (*names, *based) if (map, name, "CARP") in saved}
    every = [
        each for (place, name, rival), each in saved.items() if place is not None and name in here and rival == "CARP"
    ]
    known = [each for each in every if 4 * each.cases >= max((other.cases for other in every), default=0)]
    found = f"map {map}: {listed(here)}"
    if known:
        most = max(known, key=lambda each: each.saving.estimate)
        found += f"; the most is on map {most.map}: {most.algorithm} {most.saving:.1f} ({most.cases} cases)"
    between = {name: own[map, "CARP"].estimate - own[map, name].estimate for name in here}
    if between:
        found += "; between each one's own means: " + ", ".join(f"{name} {less:.1f}" for name, less in between.items())
    of_paper = [here[name] for name in names if name in here]
    with_baseline = [here[name] for name in based if name in here]
    verdicts = number_verdict(of_paper, paper), number_verdict(with_baseline, paper)
    return Claim(claim, found, *verdicts, *(OTHER_CONVENTIONS if each == "in part" else "" for each in verdicts))


def number_verdict(found: Sequence[Interval], paper: int) -> Verdict:
    """Reproduced if the intervals hold the paper's number, in part if they show at least that there are fewer."""
    if not found:
        return "undecided"
    if all(each.low <= paper <= each.high for each in found):
        return "reproduced"
    return "in part" if all(above_zero(each) for each in found) else "not reproduced"


def reuse_claims(summary: Sequence[ReuseOf]) -> Iterator[Claim]:
    """The claims about queries."""
    last = {f"Proposed_{each.m}": each.last for each in summary if each.last is not None}
    wanted = [PAPERS_SHARES[each.m] for each in summary if each.last is not None]
    yield Claim(
        "with shared beginnings of orders, 67 %, 54 % and 45 % of the queries of 4, 5 and 6 neighbours remain",
        "of the last round's queries for orders: " + listed(last, unit=" %"),
        verdict_of([abs(each.estimate - paper) <= 1 for each, paper in zip(last.values(), wanted, strict=True)]),
    )
    outside = {f"Proposed_{each.m}": each.replanned for each in summary}
    halved: dict[str, bool | None] = {name: each.low <= HALF <= each.high for name, each in outside.items()}
    above = [name for name, each in outside.items() if each.low > HALF]
    yield Claim(
        "robots before the one taken out keep their plans, which halves the queries for those outside on average",
        "of them remain: " + listed(outside, unit=" %"),
        verdict_of([*halved.values()]),
        reason=parts_of(halved) + (f"; {MORE}" if parts_of(halved) and not above else ""),
    )
    longer = {each.m: below(each.outside, each.orders) for each in summary}
    yield Claim(
        "in Proposed_6 to test all orders takes longer than to plan the other robots again",
        "queries for orders and for the others, with the paper's two reductions: "
        + ", ".join(f"Proposed_{each.m} {each.orders:.1f} and {each.outside:.1f}" for each in summary),
        verdict_of([longer[6]]),
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
            reason=FASTER if verdict_of(verdicts) == "in part" else "",
        )
    last = max(k for _, k in ratio)
    faster = {name: ratio["CARP100", last].estimate / ratio[name, last].estimate for name in PROPOSED}
    yield Claim(
        "Proposed is much faster than CARP100",
        f"CARP100's time at robot {last} over theirs: "
        + ", ".join(f"{name} {each:.0f}" for name, each in faster.items()),
        verdict_of([each > 1 for each in faster.values()]),
    )


def related_claims(summary: Sequence[Related]) -> Iterator[Claim]:
    """The claims about others' work that the paper cites, map by map."""
    by_place = {(each.method, each.map): each for each in summary}
    maps = sorted({each.map for each in summary})
    is_known = all(each.assignments > 1 for each in summary)
    fewer = [[above_zero(by_place[name, map].more_unplanned) for map in maps] for name in FIXED]
    cheaper = [[above_zero(each) for each in known_totals(by_place, name, maps).values()] for name in FIXED]
    verdict = verdict_of([each for of_method in (*fewer, *cheaper) for each in of_method]) if is_known else "undecided"
    yield Claim(
        "CARP is superior in all measured qualities to fixed paths, k shortest and k disjoint (ter Mors' comparison)",
        f"maps on which CARP leaves fewer robots without a plan: {counts(FIXED, fewer)}; on which its total for the "
        f"same robots is smaller: {counts(FIXED, cheaper)}",
        verdict,
        reason=SOME_MAPS if verdict == "in part" else "",
    )
    greedy, longest = known_totals(by_place, "greedy", maps), known_totals(by_place, "LF", maps)
    both = [(map, greedy[map], longest[map]) for map in greedy if map in longest]
    parts = [part for _, ours, theirs in both for part in (below_zero(ours), below(ours, theirs))]
    verdict = verdict_of(parts) if both else "undecided"
    yield Claim(
        "greedy best-first has the best joint plan cost of the orders by priority (ter Mors' heuristics)",
        "totals above that of the order given, CARP's, in per cent, of greedy and of LF, on the maps where these plan "
        "all robots in a quarter of the assignments: "
        + ", ".join(f"map {map} {ours:.1f} and {theirs:.1f}" for map, ours, theirs in both),
        verdict,
        reason=SOME_MAPS if verdict == "in part" else "",
    )


def known_totals(by_place: Mapping[tuple[str, int], Related], name: str, maps: Sequence[int]) -> dict[int, Interval]:
    """A method's totals above CARP's, on maps where at least a quarter of the assignments, and more than one, count."""
    known = [by_place[name, map] for map in maps if by_place[name, map].compared > 1]
    return {
        each.map: each.above_carp
        for each in known
        if each.above_carp is not None and FEWEST_SHOWN * each.compared >= each.assignments
    }


def counts(names: Iterable[str], verdicts: Sequence[Sequence[bool | None]]) -> str:
    """The number of true verdicts of each name."""
    return ", ".join(f"{name} {each.count(True)} of {len(each)}" for name, each in zip(names, verdicts, strict=True))


def verdict_of(parts: Sequence[bool | None]) -> Verdict:
    """A claim of several parts; each holds, does not, or is open."""
    if all(parts):
        return "reproduced"
    if not any(parts):
        return "undecided" if None in parts else "not reproduced"
    return "in part"


def above_zero(interval: Interval) -> bool | None:
    """Whether the interval lies above zero; `None` if it holds zero."""
    return True if interval.low > 0 else False if interval.high < 0 else None


def below_zero(interval: Interval) -> bool | None:
    """Whether the interval lies below zero; `None` if it holds zero."""
    return above_zero(Interval(-interval.estimate, -interval.high, -interval.low))


def below(interval: Interval, other: Interval) -> bool | None:
    """Whether an interval lies below another; `None` if they overlap."""
    return True if interval.high < other.low else False if interval.low > other.high else None


def shifted(interval: Interval, by: float) -> Interval:
    """The interval, so much higher."""
    return Interval(interval.estimate + by, interval.low + by, interval.high + by)


def share_of_total(saving: Saving | None) -> Interval | None:
    """The saving in per cent of the rival's total, if it is known."""
    return None if saving is None else scaled(saving.saving, 100 / saving.total)


def scaled(interval: Interval, by: float) -> Interval:
    """The interval times a number above zero."""
    return Interval(interval.estimate * by, interval.low * by, interval.high * by)


def listed(intervals: Mapping[str, Interval], unit: str = "") -> str:
    """Each name with its interval."""
    return ", ".join(f"{name} {each:.1f}{unit}" for name, each in intervals.items())
