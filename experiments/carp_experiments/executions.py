"""Delayed executions of small random solutions: in order none breaks a rule or stops, on the clock some collide.

`python -m carp_experiments.executions FILE --to NUMBER` takes the questions up to that number, and continues where FILE
ends. Each line of FILE is about `PART` questions.
"""

import argparse
import json
from collections import Counter
from dataclasses import replace
from pathlib import Path

import carp_reference
from carp_reference.execution import Order, order_of
from carp_spec import Carp, check
from carp_spec.execution_rules import trace_violations
from carp_spec.permutations import splitmix64
from carproof.delays import Delay, executed, in_order, on_the_clock, stuck
from carproof.questions import Draw, draw_instance

PART = 1000
EACH = 100  # executions of one solution
TOGETHER = {"joint/capacity", "joint/exchange", "joint/following"}


class BrokenError(Exception):
    """An execution in order broke a rule or stopped."""


def part(first: int) -> Counter[str]:
    """The results of `PART` executions from that number on; equal numbers give equal executions."""
    found: Counter[str] = Counter()
    for number in range(first, first + PART, EACH):
        draw = Draw(splitmix64(number))
        instance = draw_instance(draw)
        if draw.happens(3):
            instance = replace(instance, following="forbidden")
        solution = carp_reference.plan(instance, Carp())
        order = order_of(instance, solution)
        kind = "cyclic" if stuck(order) else "acyclic"
        for _ in range(EACH):
            found[kind] += 1
            found.update(look(order, draw, kind == "cyclic"))
    return found


def look(order: Order, draw: Draw, is_cyclic: bool) -> Counter[str]:
    """Execute a solution once with random delays; raises `BrokenError`."""
    instance, solution = order.instance, order.solution
    places = [(plan.robot, place) for plan in solution.plans for place in range(len(plan.visits) - 1)]
    delays = [Delay(*node, draw.between(1, 6)) for node in places if draw.happens(4)]
    enters = in_order(order, delays)
    trace = executed(order, enters, delays)
    total = sum(delay.ticks for delay in delays)
    broken = [violation.rule for violation in trace_violations(instance, solution, trace)]
    broken += [violation.rule for violation in check(instance, trace.plans) if violation.rule in TOGETHER]
    too_late = any(tick > order.visit(node).enter + total for node, tick in enters.items())
    stands = len(enters) < len(order.nodes)
    if broken or too_late or stands != is_cyclic:
        raise BrokenError(f"{broken}, too late: {too_late}, stands: {stands}: {instance} {solution} {delays}")
    clock = executed(order, on_the_clock(order, delays), delays)
    collides = any(violation.rule in TOGETHER for violation in check(instance, clock.plans))
    return Counter(delayed=bool(delays), stands=stands, collides=collides)


def main() -> None:
    """Run the campaign."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("file", type=Path)
    parser.add_argument("--to", type=int, default=1_000_000)
    options = parser.parse_args()
    done = options.file.read_text().splitlines() if options.file.exists() else []
    totals: Counter[str] = Counter()
    for line in done:
        totals.update(json.loads(line))
    with options.file.open("a") as file:
        for first in range(len(done) * PART, options.to, PART):
            found = part(first)
            totals.update(found)
            file.write(json.dumps(found) + "\n")
            file.flush()
    print(json.dumps(totals))  # noqa: T201 - the result


if __name__ == "__main__":
    main()
