"""`python -m carp_optimum` compiles what bounds and planners run, so that no later call has to."""

from carp_optimized.__main__ import compile_all as compile_planner
from carp_optimum import price_steps, priced_ways  # noqa: F401 - what is to be compiled, not only when it is asked for
from carp_optimum.bound import lower_bound
from carp_spec import Instance, Resource, ResourceGraph, Robot


def compile_all() -> None:
    """Call each entry once."""
    compile_planner()
    graph = ResourceGraph(tuple(map(Resource, "abcd")), (("a", "b"), ("b", "c"), ("b", "d")))
    lower_bound(Instance(graph, (Robot("r", "a", "c"), Robot("s", "c", "a"), Robot("t", "d", "a"))), steps=20)


if __name__ == "__main__":
    compile_all()
