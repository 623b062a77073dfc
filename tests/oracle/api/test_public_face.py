"""`import carproof`: what an author of a planner finds there."""

import ast
import json
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from importlib import import_module
from inspect import getdoc, isroutine, signature
from pathlib import Path
from typing import Any

import click
import networkx as nx
import numpy as np
import pytest
from msgspec import structs

import carproof
from carp_spec.documents.bounds import DeadlinesDocument
from carproof import Plan, Refusal, Resource, ResourceGraph, Robot, Solution, Visit
from carproof.conform.run import Options
from carproof.entry.cli import carproof as command
from carproof.protocol.ops import planning, searching
from carproof.pytest_plugin import Conformance

ROOT = Path(__file__).parents[3]
INSTANCE = carproof.Instance(
    ResourceGraph(tuple(map(Resource, "abc")), (("a", "b"), ("b", "c"))),
    (Robot("r", "a", "c"), Robot("s", "a", "b", release=2)),
)
PLANNED = Solution(
    (
        Plan("r", (Visit("a", 0, 1), Visit("b", 1, 2), Visit("c", 2, 3))),
        Plan("s", (Visit("a", 2, 3), Visit("b", 3, 4))),
    ),
    ("r", "s"),
)


def test_each_name_is_there_and_documented() -> None:
    for name in carproof.__all__:
        value = getattr(carproof, name)
        assert not (isroutine(value) or isinstance(value, type)) or getdoc(value), name
        assert name in dir(carproof)


def test_the_version_is_that_of_the_installation() -> None:
    shown = subprocess.run([sys.executable, "-m", "carproof", "--version"], check=True, capture_output=True, text=True)
    assert shown.stdout == f"carproof {carproof.__version__}\n"


def test_importing_the_face_loads_none_of_the_packages() -> None:
    program = "import sys, carproof; print(*(name for name in sys.modules if name.startswith('carp')))"
    loaded = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True).stdout
    assert loaded.split() == ["carproof"]


def test_no_public_name_is_that_of_a_module() -> None:
    folder = ROOT / "oracle" / "carproof"
    modules = {path.stem for path in folder.glob("*.py")} | {path.parent.name for path in folder.glob("*/__init__.py")}
    assert not modules & {*carproof.__all__}


def test_the_documentation_imports_public_names_alone() -> None:
    private = []
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]:
        for block in re.findall(r"^```python[^\n]*\n(.*?)^```", page.read_text(), re.DOTALL | re.MULTILINE):
            for node in ast.walk(ast.parse(block)):
                if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("carp"):
                    public = import_module(node.module).__all__ if node.module.startswith("carproof") else ()
                    private += [(page.name, node.module, each.name) for each in node.names if each.name not in public]
                if isinstance(node, ast.Import):
                    private += [(page.name, "", each.name) for each in node.names if each.name.startswith("carp_")]
    assert private == []


def test_every_document_is_written_and_read() -> None:
    broken = Solution((PLANNED.plans[0], Plan("s", (Visit("a", 0, 1), Visit("b", 1, 2)))), ("r", "s"))
    trace = carproof.execute(INSTANCE, PLANNED, "order").trace
    _, certificate = carproof.certified_query(INSTANCE, PLANNED.plans[:1], "s")
    bound = carproof.bound(INSTANCE, steps=0)
    documents: list[tuple[object, Callable[[Any], bytes], Callable[[bytes], object]]] = [
        (INSTANCE, carproof.write_instance, carproof.read_instance),
        (PLANNED, carproof.write_solution, carproof.read_solution),
        (carproof.check(INSTANCE, PLANNED), carproof.write_verdict, carproof.read_verdict),
        (carproof.check(INSTANCE, broken), carproof.write_verdict, carproof.read_verdict),
        (trace, carproof.write_trace, carproof.read_trace),
        (bound, carproof.write_bound, carproof.read_bound),
        (certificate, carproof.write_query_certificate, carproof.read_query_certificate),
    ]
    for value, write, read in documents:
        assert read(write(value)) == value


def test_a_bound_is_written_of_robots_that_are_seen_in_places_or_have_no_way() -> None:
    seen = DeadlinesDocument(("r", "s"), (1, 2), 1, "", ((1, ("a", 2)), (1, ("b",))))
    bound = structs.replace(carproof.bound(INSTANCE, steps=0), robots=(("r", None), (3, 0)), deadlines=(seen,))
    assert carproof.read_bound(carproof.write_bound(bound)) == bound


def test_a_solution_has_the_plan_of_each_robot_and_a_makespan() -> None:
    assert (PLANNED.plan_of("s"), PLANNED.plan_of("t")) == (PLANNED.plans[1], None)
    assert carproof.total_cost(INSTANCE, PLANNED.plans) == 3
    assert carproof.makespan(INSTANCE, PLANNED.plans) == 3
    assert carproof.makespan(INSTANCE, ()) == 0


def test_a_verdict_that_contradicts_itself_is_refused() -> None:
    document = json.loads(carproof.write_verdict(carproof.check(INSTANCE, PLANNED)))
    with pytest.raises(Refusal, match="it must be true if there are no violations"):
        carproof.read_verdict(json.dumps({**document, "valid": False}).encode())


@pytest.mark.parametrize("kind", [bool, np.uint8, np.int64])
def test_an_array_is_a_grid(kind: type) -> None:
    free: np.typing.NDArray[Any] = np.array([[1, 1, 1], [1, 0, 1]], dtype=kind)
    instance = carproof.instance_from_array(free, np.array([[0, 1], [2, 1]]), [(2, 1), (0, 1)])
    assert instance == carproof.instance_from_array(free.tolist(), [(0, 1), (2, 1)], [(2, 1), (0, 1)])
    assert [each.id for each in instance.graph.resources] == ["0,0", "1,0", "2,0", "0,1", "2,1"]
    assert (instance.robots[0], instance.after_goal) == (Robot("r1", "0,1", "2,1"), "park")
    files = carproof.write_movingai(instance)
    assert carproof.read_movingai(files.map, files.scen) == instance


@pytest.mark.parametrize(
    ("free", "starts", "goals", "path"),
    [
        ([1, 1], [], [], "$"),
        ([[1, 1], [1]], [], [], "$"),
        ([[1.0]], [], [], "$"),
        ([[1, 0]], [(1, 0)], [(0, 0)], "$.starts[0]"),
        ([[1, 1]], [(0, 0)], [(0, 1)], "$.goals[0]"),
        ([[1, 1]], [(0, 0)], [(0.0, 0)], "$.goals[0]"),
        ([[1, 1]], [(0, 0)], [], "$.goals"),
    ],
)
def test_an_array_that_is_no_grid_is_refused(free: Any, starts: Any, goals: Any, path: str) -> None:  # noqa: ANN401
    with pytest.raises(Refusal) as caught:
        carproof.instance_from_array(free, starts, goals)
    assert (caught.value.rule, caught.value.path) == ("adapter/array", path)


@pytest.mark.parametrize("directed", [False, True])
def test_a_resource_graph_goes_to_networkx_and_back(directed: bool) -> None:
    resources = (Resource("a", 2, 3, 0, 1), Resource(7), Resource("c"))
    groups = (carproof.Group("crossing", ("a", 7)),)
    instance = carproof.Instance(
        ResourceGraph(resources, (("c", "a"), ("a", 7)), directed, groups), (Robot("r", "a", 7),)
    )
    graph = carproof.graph_of(instance)
    assert isinstance(graph, nx.DiGraph) == directed
    back = carproof.instance_from_networkx(graph, instance.robots, instance.after_goal)
    assert (back.graph.resources, back.graph.moves, back.graph.groups) == (resources, instance.graph.moves, groups)
    assert (back.robots, back.after_goal) == (instance.robots, instance.after_goal)


def test_a_function_is_judged() -> None:
    assert carproof.conforms(carproof.plan, examples=5, large=1).findings == []
    assert carproof.conforms(lambda _: PLANNED, examples=5).conforms is False
    with pytest.raises(Refusal, match="it must be one of sound, "):
        carproof.conforms(carproof.plan, level="fast")  # type: ignore[arg-type]


def of_command(words: str) -> object:
    """The default of an option of a command, such as `query now`."""
    *path, option = words.split()
    group: click.Command | None = command
    for name in path:
        assert isinstance(group, click.Group)
        group = group.get_command(click.Context(group), name)
    assert group is not None
    return next(each.default for each in group.params if each.name == option)


@pytest.mark.parametrize(
    ("parameter", "functions", "commands"),
    [
        ("now", (carproof.query, planning.query), ("query now",)),
        ("now", (carproof.add, planning.add), ("add now",)),
        ("limit", (carproof.optimum, searching.optimum, carproof.write_proof), ("optimum limit",)),
        ("limit", (carproof.optimum, carproof.optimality_gap), ("gap limit",)),
        ("planner", (carproof.plan, planning.plan), ()),
        ("repair", (carproof.plan,), ("plan repair",)),
        ("examples", (carproof.conforms, Conformance.conforms, Options), ("conform number",)),
        ("level", (carproof.conforms,), ("conform level",)),
        ("large", (carproof.conforms, Conformance.conforms), ("conform large",)),
        ("processes", (carproof.optimum,), ("optimum processes",)),
        ("after_goal", (carproof.instance_from_array, carproof.instance_from_networkx, carproof.read_movingai), ()),
        ("after_goal", (carproof.Instance,), ("generate grid after_goal", "generate warehouse after_goal")),
    ],
)
def test_defaults_are_the_same_in_python_on_the_command_line_and_in_ops(
    parameter: str, functions: Sequence[Callable[..., object]], commands: Sequence[str]
) -> None:
    defaults = [signature(function).parameters[parameter].default for function in functions]
    assert len({*defaults, *map(of_command, commands)}) == 1


def test_the_planner_that_is_not_named_is_the_same_everywhere() -> None:
    options = signature(carproof.add).parameters["options"].default
    assert of_command("plan planner") == carproof.Neighbourhood.name == options.name
