"""How fast documents of large fleets are read and judged, beside `json.loads` of the same text: `make bench-documents`.

Times are the least of the processor's in runs that take turns, in milliseconds.
"""

import gc
import json
import sys
from collections.abc import Callable
from time import process_time

from tests.bench.bench_fleet import warehouse

import carproof
from carp_optimized.fleet import PlannedFleet
from carproof import Carp, read_instance, read_solution, write_instance, write_solution

TURNS = 7


def least(*functions: Callable[[], object]) -> list[float]:
    """The least milliseconds of each, in turns."""
    found = [[] for _ in functions]  # type: list[list[float]]
    for _ in range(TURNS):
        for times, function in zip(found, functions, strict=True):
            gc.collect()
            start = process_time()
            function()
            times.append(1000 * (process_time() - start))
    return [min(times) for times in found]


def measure(robots: int) -> str:
    """The rows of a table."""
    instance = warehouse(robots)
    solution = carproof.plan(instance, Carp())
    text, network = write_solution(solution), write_instance(instance)
    fleet = PlannedFleet(instance)
    fleet.commit(solution.plans)

    def from_arrays() -> None:
        fleet._plans.clear()
        assert len(fleet.plans) == len(solution.plans)

    def check() -> None:
        assert carproof.check(read_instance(network), read_solution(text)).valid

    work = {
        "json.loads of the solution": lambda: json.loads(text),
        "read_solution": lambda: read_solution(text),
        "write_solution": lambda: write_solution(solution),
        "both read, and checked": check,
        "plans from arrays": from_arrays,
    }
    times = least(*work.values())
    return "".join(
        f"{robots:6} {name:28} {ms:8.1f} {ms / times[0]:6.2f}\n" for name, ms in zip(work, times, strict=True)
    )


if __name__ == "__main__":
    sys.stdout.write("robots                                    ms  ratio\n")
    for asked in map(int, sys.argv[1:] or ("3000", "5000")):
        sys.stdout.write(measure(asked))
