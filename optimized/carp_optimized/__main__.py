"""`python -m carp_optimized` compiles the planner, so that no later call has to; once done, it does nothing."""

from carp_optimized import passes
from carp_optimized.adding import add
from carp_optimized.certifying import potentials
from carp_optimized.crowds.crowd import crowd_of
from carp_optimized.crowds.distances import are_right, landmarks_of
from carp_optimized.execution.following import retime
from carp_optimized.fixed_paths import fixed_paths
from carp_optimized.fleet import PlannedFleet
from carp_optimized.improve.ejection import plan_left_out
from carp_optimized.improve.planning import plan_crowd
from carp_optimized.jit.compiling import note_that_it_is_compiled
from carp_optimized.orderings import carp, greedy, shuffled
from carp_optimized.polishing import play, to_polish
from carp_spec import (
    FixedPaths,
    Instance,
    Neighbourhood,
    Plan,
    Resource,
    ResourceGraph,
    Robot,
    Shuffled,
    Solution,
    Stop,
    Visit,
)
from carp_spec.execution.traces import Trace


def compile_all() -> None:
    """Call each entry once."""
    graph = ResourceGraph((Resource("a"), Resource("b"), Resource("c")), (("a", "b"), ("b", "c")))
    instance = Instance(graph, (Robot("r", "a", "b"), Robot("s", "b", "c"), Robot("t", "c", "c", 9)), "vanish")
    fleet = PlannedFleet(instance)
    greedy(fleet, lambda: None)
    shuffled(fleet, Shuffled(2), range(2), lambda: None)
    carp(fleet, range(2))
    fleet.ticks_to_goal(0)
    potentials(fleet, 0)
    add(fleet, 2, 0, Neighbourhood(m=2))
    plans = fleet.plans
    fleet.clear()
    fleet.call(lambda: passes.repeat_query(fleet.native, 0, 1))
    fleet.find(0, None, 0)
    fleet.commit(plans)
    play(fleet, to_polish(fleet, 0), 1)
    fleet.forget()
    fixed_paths(fleet, FixedPaths(2))
    fixed_paths(fleet, FixedPaths(2, "disjoint"))
    with_stops = Robot("u", "a", stops=(Stop("b", 1), Stop("c")))
    potentials(PlannedFleet(Instance(graph, (with_stops,))), 0)
    siding = ResourceGraph((*graph.resources, Resource("d")), (*graph.edges, ("b", "d")))  # no order plans the two
    swapping = Instance(siding, (Robot("r", "a", "c"), Robot("s", "c", "a")))
    plan_crowd(swapping, iterations=1, seconds=None)
    fleet = PlannedFleet(swapping)
    carp(fleet, range(2))
    plan_left_out(fleet, lambda: True, times=1)
    crowd = crowd_of(instance)
    are_right(crowd, landmarks_of(crowd))
    here = Plan("t", (Visit("c", 9, 10),))
    retime(instance, Solution((here,), ("t",), ("r", "s")), Trace(0, (Plan("t", ()),)))
    note_that_it_is_compiled("carp_optimized")


if __name__ == "__main__":
    compile_all()
