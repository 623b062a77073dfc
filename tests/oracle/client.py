"""A program that uses the public face as an author of a planner does; mypy --strict checks it."""

from carproof import (
    Carp,
    Instance,
    Neighbourhood,
    Plan,
    Resource,
    ResourceGraph,
    Robot,
    Solution,
    Verdict,
    add,
    check,
    plan,
    polish,
    query,
    read_instance,
    total_cost,
    write_instance,
)


def lane() -> Instance:
    cells = tuple(Resource(cell) for cell in "abc")
    graph = ResourceGraph(cells, (("a", "b"), ("b", "c")))
    return Instance(graph, (Robot("r", "a", "c"), Robot("s", "a", "b", release=2)))


def cost_of(instance: Instance) -> int:
    solution: Solution = plan(read_instance(write_instance(instance)), Carp())
    better = polish(instance, solution, iterations=10)
    verdict: Verdict = check(instance, better)
    assert verdict.valid
    found: Plan | None = query(instance, better.plans, "r")
    assert found is not None
    alone = Solution((found,), ("r",), ("s",))
    assert add(instance, alone, "s", 0, Neighbourhood(m=2)).unplanned == ()
    return total_cost(instance, better.plans)
