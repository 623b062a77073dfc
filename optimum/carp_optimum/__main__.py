"""`python -m carp_optimum` compiles what bounds and planners run, so that no later call has to."""

from carp_optimized.__main__ import compile_all as compile_planner
from carp_optimized.jit.compiling import note_that_it_is_compiled
from carp_optimum.bound import lower_bound
from carp_optimum.branching.branching import Branching
from carp_optimum.claims.pair_search import SightSearch
from carp_optimum.lagrangian.deadlines import Deadlines, Member
from carp_optimum.lagrangian.price_search import PriceSearch
from carp_spec import Instance, Resource, ResourceGraph, Robot


def compile_all() -> None:
    """Call each entry once."""
    compile_planner()
    graph = ResourceGraph(tuple(map(Resource, "abcd")), (("a", "b"), ("b", "c"), ("b", "d")))
    instance = Instance(graph, (Robot("r", "a", "c"), Robot("s", "c", "a"), Robot("t", "d", "a")))
    lower_bound(instance, steps=20)
    search = PriceSearch(instance, 1)
    search.add_deadlines([Deadlines([Member(0, 0, 0, ()), Member(1, 0, 1, (1,))])])
    SightSearch(search).round(lambda: None)
    list(Branching(instance, 12, lambda: None).run())
    search.restore()
    search.least_costs()
    note_that_it_is_compiled("carp_optimum")


if __name__ == "__main__":
    compile_all()
