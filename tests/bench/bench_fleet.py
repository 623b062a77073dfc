"""How long a client of `carproof serve` takes to have a robot added to a fleet, beside the compiled core's own time.

`python -m tests.bench.bench_fleet 100 1000 3000`: a robot comes every tick into a warehouse of 123 by 122 cells. Some
have plans by CARP, and 40 more are added by the client and by the core in turns. Times are medians of the processor's,
and of the wall's.
"""

import sys
from dataclasses import replace
from pathlib import Path
from statistics import median
from time import perf_counter, process_time

from tests.bench.soak import Server

from carp_optimized import plan
from carp_optimized.adding import add
from carp_optimized.fleet import PlannedFleet
from carp_spec import Carp, Instance, Neighbourhood
from carp_spec.documents.instances import instance_document, robot_document
from carp_spec.documents.solutions import solution_document
from carproof.generate import Fleet, Range, Warehouse, warehouse_instance

TIMES = 40


def processor_seconds(server: Server) -> float:
    """What the process of the server that plans has used."""
    return int(Path(f"/proc/{server.processes[1]}/schedstat").read_text().split()[0]) / 1e9


def measure(robots: int) -> str:
    """A line of the table."""
    whole = warehouse(robots + TIMES)
    first, more = replace(whole, robots=whole.robots[:robots]), whole.robots[robots:]
    solution = plan(first, Carp())
    client, core = Server(), PlannedFleet(first)
    core.commit(solution.plans)
    client.ask(op="fleet/open", fleet="f", instance=instance_document(first), solution=solution_document(solution))
    alone, serving, asking, walls = [], [], [], []
    for number, robot in enumerate(more, robots):
        served = processor_seconds(client)
        before = perf_counter(), process_time()
        answer = client.ask(op="fleet/add", fleet="f", robot=robot_document(robot))
        after = perf_counter(), process_time()
        walls.append(after[0] - before[0])
        asking.append(after[1] - before[1])
        serving.append(processor_seconds(client) - served)
        assert answer["result"]["now"] == 0
        start = process_time()
        add(core, core.enlist(robot), 0, Neighbourhood(), number)
        alone.append(process_time() - start)
    client.ask(op="stop")
    client.process.wait()
    core_ms, server_ms, client_ms, wall_ms = (1000 * median(each) for each in (alone, serving, asking, walls))
    ratios = f"{server_ms / core_ms:12.2f} {(server_ms + client_ms) / core_ms:10.2f}"
    return f"{robots:6} {core_ms:10.2f} {server_ms:12.2f} {client_ms:12.2f} {ratios} {wall_ms:10.2f}\n"


def warehouse(robots: int) -> Instance:
    """Robots that come one a tick."""
    plan = Warehouse(columns=12, rows=30, stations=60)
    return warehouse_instance(plan, Fleet(robots=robots, distinct="none", release=Range(0, robots)))


if __name__ == "__main__":
    sys.stdout.write("robots   core, ms   server, ms   client, ms   server/core  both/core   wall, ms\n")
    for asked in map(int, sys.argv[1:]):
        sys.stdout.write(measure(asked))
