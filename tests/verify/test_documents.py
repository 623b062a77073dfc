"""Documents: what is read is what was written, and every malformed document is refused with path and rule."""

import gc
import json
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any, cast

import networkx as nx
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.spec.making import PARKED, SOLVED, VANISHING, plan_of, solution_of
from tests.spec.strategies import FEWER, SIZES, solutions

from carp_spec import Instance, Refusal, Resource, ResourceGraph, Robot, Solution, judge
from carp_spec.documents.decoding import MOST_DIGITS, has_format, has_shape, is_json, uncapitalized
from carp_spec.documents.instances import INSTANCE_FORMAT, InstanceDocument, read_instance, write_instance
from carp_spec.documents.solutions import (
    SOLUTION_FORMAT,
    SolutionDocument,
    read_solution,
    read_trace,
    write_solution,
    write_trace,
)
from carp_spec.documents.verdicts import write_verdict
from carp_spec.execution.traces import Trace
from carp_spec.model import Following
from carproof.testing.strategies import instances, resource_graphs

Json = Any


def instance_json() -> Json:
    return json.loads(write_instance(VANISHING))


def solution_json() -> Json:
    return json.loads(write_solution(solution_of(PARKED)))


def encode(value: Json) -> bytes:
    return json.dumps(value).encode()


def refusal(read: Callable[[bytes], object], data: bytes) -> tuple[str, str]:
    """The path and the rule with which the document is refused."""
    with pytest.raises(Refusal) as caught:
        read(data)
    assert caught.value.kind == "document"
    assert caught.value.message
    return caught.value.path, caught.value.rule


@pytest.mark.parametrize("is_on", [True, False])
def test_reading_leaves_the_collection_of_garbage_as_it_was(is_on: bool) -> None:
    (gc.enable if is_on else gc.disable)()
    try:
        read_solution(write_solution(solution_of(SOLVED)))
        assert gc.isenabled() is is_on
    finally:
        gc.enable()


@FEWER
@given(instance=instances(SIZES))
def test_an_instance_is_read_as_it_was_written(instance: Instance) -> None:
    assert read_instance(write_instance(instance)) == instance


@FEWER
@given(solution=solutions())
def test_a_solution_is_read_as_it_was_written(solution: Solution) -> None:
    assert read_solution(write_solution(solution)) == solution


@pytest.mark.parametrize("following", ["allowed", "forbidden"])
def test_following_is_written_where_it_is_forbidden(following: Following) -> None:
    instance = replace(VANISHING, following=following)
    data = write_instance(instance)
    assert read_instance(data) == instance
    assert (b'"following"' in data) == (following == "forbidden")


def test_the_schema_that_editors_read_is_not_kept() -> None:
    for read, document in ((read_instance, instance_json()), (read_solution, solution_json())):
        assert read(encode({**document, "$schema": "a.schema.json"})) == read(encode(document))


@pytest.mark.parametrize("now", [0, 3])
def test_a_trace_is_read_as_it_was_written(now: int) -> None:
    trace = Trace(now, PARKED)
    assert read_trace(write_trace(trace)) == trace
    assert refusal(read_trace, write_trace(Trace(-1, PARKED))) == ("$.now", "document/shape")


def test_defaults_may_be_left_out() -> None:
    nodes = [{"id": "a"}, {"id": 2}]
    graph = {"nodes": nodes, "edges": [{"source": "a", "target": 2}]}
    robots = [{"id": "r", "start": "a", "goal": 2}]
    document = {"format": "carproof-instance/1", "graph": graph, "after_goal": "park", "robots": robots}
    expected = Instance(ResourceGraph((Resource("a"), Resource(2)), (("a", 2),)), (Robot("r", "a", 2),), "park")
    assert read_instance(encode(document)) == expected


DOCUMENTS = {"instance": (read_instance, instance_json), "solution": (read_solution, solution_json)}
KINDS: list[tuple[tuple[str, ...], tuple[type, ...]]] = [
    (("id", "source", "target", "start", "goal", "robot"), (int, str)),
    (("capacity", "duration", "x", "y", "release", "pace"), (int,)),
    (("nodes", "edges", "robots", "plans", "visits", "order", "unplanned"), (list,)),
    (("graph",), (dict,)),
    (("directed", "multigraph"), (bool,)),
    (("after_goal",), ()),
]
"""The JSON kinds that each field may have; an entry of a list of objects is an object."""
STRANGE: list[Json] = [None, True, 1.0, 7, "seven", [0, 1], {"seven": 7}]
GONE = object()


def steps_of(path: str) -> list[str | int]:
    parts = path.replace("[", ".").replace("]", "").split(".")[1:]
    return [int(part) if part.isdigit() else part for part in parts]


def put(document: Json, path: str, value: Json) -> bytes:
    """The document with another value at the path, or none."""
    *steps, last = steps_of(path)
    holder = document
    for step in steps:
        holder = holder[step]
    if value is GONE:
        del holder[last]
    else:
        holder[last] = value
    return encode(document)


def places(value: Json, path: str = "$") -> Iterator[tuple[str, tuple[type, ...]]]:
    """Every path of a document below its root, without visits, with what may stand there."""
    kinds = {field: accepted for fields, accepted in KINDS for field in fields}
    if isinstance(value, dict):
        for field in value.keys() & kinds.keys():
            yield f"{path}.{field}", kinds[field]
            yield from places(value[field], f"{path}.{field}")
    elif isinstance(value, list) and not path.endswith("]"):
        for number, entry in enumerate(value):
            yield f"{path}[{number}]", (type(entry),) if isinstance(entry, dict | list) else (int, str)
            yield from places(entry, f"{path}[{number}]")


@pytest.mark.parametrize("name", DOCUMENTS)
def test_a_value_of_another_kind_is_refused_at_its_path(name: str) -> None:
    read, document = DOCUMENTS[name]
    count = 0
    for path, accepted in places(document()):
        for value in (each for each in STRANGE if type(each) not in accepted):
            assert refusal(read, put(document(), path, value)) == (path, "document/shape")
            count += 1
    assert count > 100


@pytest.mark.parametrize(
    ("name", "path", "value", "where", "rule"),
    [
        ("instance", "$.format", "carproof-instance/2", None, "document/format"),
        ("instance", "$.format", "carproof-solution/1", None, "document/format"),
        ("instance", "$.robots[0].start", "x", None, "instance/endpoint"),
        ("instance", "$.graph.multigraph", True, "$.graph", "document/shape"),
        ("instance", "$.graph.nodes[4].y", GONE, "$.graph.nodes[4]", "instance/position"),
        ("solution", "$.plans[0].visits[1]", ["b", 2], None, "document/shape"),
        ("solution", "$.plans[0].visits[1]", ["b", 2, 3, 4], None, "document/shape"),
        ("solution", "$.plans[0].visits[1]", {"resource": "b"}, None, "document/shape"),
        ("solution", "$.plans[0].visits[1][0]", True, None, "document/shape"),
        ("solution", "$.plans[0].visits[1][1]", None, None, "document/shape"),
        ("solution", "$.plans[0].visits[1][1]", 2.0, None, "document/shape"),
        ("solution", "$.plans[0].visits[1][2]", False, None, "document/shape"),
        ("solution", "$.plans[0].visits[1][2]", "3", None, "document/shape"),
    ],
)
def test_a_document_is_refused_where_it_is_wrong(
    name: str, path: str, value: Json, where: str | None, rule: str
) -> None:
    read, document = DOCUMENTS[name]
    assert refusal(read, put(document(), path, value)) == (where or path, rule)


OBJECTS = {
    "instance": {
        "$": ("graph", "after_goal", "robots"),
        "$.graph": ("nodes", "edges"),
        "$.graph.nodes[0]": ("id",),
        "$.graph.edges[0]": ("source", "target"),
        "$.robots[0]": ("id", "start", "goal"),
    },
    "solution": {"$": ("plans", "order", "unplanned"), "$.plans[0]": ("robot", "visits")},
}


@pytest.mark.parametrize("name", DOCUMENTS)
def test_fields_that_are_missing_or_unknown_are_refused_at_their_object(name: str) -> None:
    read, document = DOCUMENTS[name]
    for where, needed in OBJECTS[name].items():
        for field, value in (("colour", 1), *((each, GONE) for each in needed)):
            assert refusal(read, put(document(), f"{where}.{field}", value)) == (where, "document/shape")


def test_a_field_whose_name_looks_like_a_path_does_not_mislead() -> None:
    document = instance_json()
    document["robots"][1]["x - at `$.graph"] = 1
    assert refusal(read_instance, encode(document)) == ("$.robots[1]", "document/shape")


@pytest.mark.parametrize("read", [read_instance, read_solution])
@pytest.mark.parametrize("value", [{}, {"format": ""}, [], [{}], "format", 3, None, True])
def test_any_other_json_has_not_the_format(read: Callable[[bytes], object], value: Json) -> None:
    assert refusal(read, encode(value)) == ("$.format", "document/format")


NOT_JSON: dict[str, tuple[bytes, bytes]] = {
    "NaN": (b'"release":1', b'"release":NaN'),
    "infinity": (b'"release":1', b'"release":-Infinity'),
    "more than a float holds": (b'"release":1', b'"release":1e999'),
    "a leading zero": (b'"release":1', b'"release":01'),
    "more digits than a hundred": (b'"release":1', b'"release":' + b"9" * 101),
    "more digits than Python reads": (b'"release":1', b'"release":' + b"9" * 10_000),
    "a name twice": (b'"release":1', b'"release":1,"release":2'),
    "a name twice, and one left out": (b'"release":1,"pace":1', b'"release":1,"release":1'),
    "a byte that is not UTF-8": (b'"r2"', b'"r\xff"'),
    "half a surrogate pair": (b'"r2"', b'"\\ud800"'),
    "a control character": (b'"r2"', b'"r\n2"'),
    "single quotes": (b'"r2"', b"'r2'"),
    "a comma too many": (b'"release":1', b'"release":1,'),
    "a comment": (b'"release":1', b'"release":1 /* tick */'),
}


@pytest.mark.parametrize("what", NOT_JSON)
def test_what_is_not_json_is_refused(what: str) -> None:
    data = write_instance(VANISHING).replace(*NOT_JSON[what])
    assert refusal(read_instance, data) == ("$", "document/json")


@pytest.mark.parametrize(
    "data", [b"", b" ", b"[" * 100_000, b'{"a":' * 100_000, b"\xef\xbb\xbf{}", "{}".encode("utf-16")]
)
@pytest.mark.parametrize("read", [read_instance, read_solution])
def test_bytes_that_hold_no_document_are_refused(read: Callable[[bytes], object], data: bytes) -> None:
    assert refusal(read, data) == ("$", "document/json")


def test_a_solution_followed_by_anything_is_refused() -> None:
    data = write_solution(solution_of(SOLVED))
    assert read_solution(data + b" \r\n\t") == solution_of(SOLVED)
    assert refusal(read_solution, data + b"x") == ("$", "document/json")


@pytest.mark.parametrize(
    ("name", "is_shown"),
    [
        ("trace/1", True),
        ("a" * MOST_DIGITS, True),
        ("", False),
        ("two\nlines", False),
        ("a" * (MOST_DIGITS + 1), False),
    ],
)
def test_another_format_is_shown_if_it_fits_into_a_sentence(name: str, is_shown: bool) -> None:
    with pytest.raises(Refusal) as caught:
        read_instance(encode({"format": name}))
    instead = f", and is {name}" if is_shown else ""
    assert caught.value.message == f"the format must be carproof-instance/1{instead}"


@pytest.mark.parametrize(
    ("sentence", "part"), [("Object missing", "object missing"), ("A b", "a b"), ("JSON is", "JSON is"), ("", "")]
)
def test_a_sentence_becomes_part_of_another(sentence: str, part: str) -> None:
    assert uncapitalized(sentence) == part


def test_the_deepest_nesting_that_is_json_is_no_document_either() -> None:
    for depth in range(900, 1100):
        data = b'{"format":"carproof-solution/1","plans":' + b"[" * depth + b"]" * depth + b"}"
        assert refusal(read_solution, data) in (
            ("$", "document/json"),
            ("$", "document/shape"),
            ("$.plans[0]", "document/shape"),
        )


def test_whole_numbers_of_a_hundred_digits_are_read_and_can_be_judged() -> None:
    huge = 10**100 - 1
    graph = ResourceGraph((Resource("a", huge, huge), Resource("b", 1, huge, -huge, huge)), (("a", "b"),))
    instance = Instance(graph, (Robot(-huge, "a", "b", huge, huge),))
    solution = solution_of([plan_of(-huge, ("a", huge, huge), ("b", -huge, huge))])
    assert read_instance(write_instance(instance)) == instance
    assert read_solution(write_solution(solution)) == solution
    assert not json.loads(write_verdict(judge(instance, solution)))["valid"]


@FEWER
@given(data=st.data())
def test_a_document_with_random_bytes_in_it_is_refused_by_the_first_rule_that_it_breaks(data: st.DataObject) -> None:
    read, whole, format, kind = data.draw(
        st.sampled_from(
            [
                (read_instance, write_instance(VANISHING), INSTANCE_FORMAT, InstanceDocument),
                (read_solution, write_solution(solution_of(PARKED)), SOLUTION_FORMAT, SolutionDocument),
            ]
        )
    )
    start = data.draw(st.integers(0, len(whole)))
    end = data.draw(st.integers(start, start + 8))
    changed = (
        whole[:start]
        + data.draw(st.binary(max_size=4) | st.sampled_from([b"-", b"null", b"1e5", b"[", b'"']))
        + whole[end:]
    )
    laws = {
        "document/json": is_json(changed),
        "document/format": has_format(changed, format),
        "document/shape": has_shape(changed, cast("type[Any]", kind)),
    }
    broken = next((rule for rule, holds in laws.items() if not holds), None)
    found = None
    try:
        assert isinstance(read(changed), Instance | Solution)
    except Refusal as refusal:
        found = refusal.rule
    assert found == broken or (broken is None and str(found).startswith("instance/"))


def test_networkx_node_link_data_is_read() -> None:
    graph = nx.path_graph(3)
    graph.graph["name"] = "a row"
    nx.set_node_attributes(graph, {0: {"capacity": 2}, 1: {"duration": 3, "x": 1, "y": 0}})
    document = {
        "format": "carproof-instance/1",
        "graph": nx.node_link_data(graph, edges="edges"),
        "after_goal": "vanish",
        "robots": [],
    }
    resources = (Resource(0, capacity=2), Resource(1, duration=3, x=1, y=0), Resource(2))
    assert read_instance(encode(document)) == Instance(ResourceGraph(resources, ((0, 1), (1, 2))), ())


@FEWER
@given(graph=resource_graphs(SIZES))
def test_networkx_reads_what_is_written(graph: ResourceGraph) -> None:
    document = json.loads(write_instance(Instance(graph, ())))
    read = nx.node_link_graph(document["graph"], edges="edges")
    assert read.is_directed() == graph.directed
    assert not read.is_multigraph()
    assert list(read) == list(graph.index)
    assert {source: set(targets) for source, targets in read.adjacency()} == {
        source: set(targets) for source, targets in graph.successors.items()
    }
    assert [read.nodes[each.id]["capacity"] for each in graph.resources] == [each.capacity for each in graph.resources]


PLANNED = (
    b'{"format":"carproof-solution/1","plans":[{"robot":"r","visits":[["a",0,null]]}],"order":["r"],"unplanned":[]}'
)
FOLLOWED = b'{"format":"carproof-trace/1","now":7,"plans":[{"robot":"r","visits":[["a",0,null]]}]}'


@pytest.mark.parametrize(("read", "data"), [(read_solution, PLANNED), (read_trace, FOLLOWED)])
@pytest.mark.parametrize(
    ("old", "new"),
    [
        (b'"robot":"r"', b'"robot":"r","robot":"r"'),
        (b'"robot":"r"', b'"robot":"s:t","robot" :"r"'),
        (b'"robot":"r"', b'"robot":"r","robo\\u0074":"r"'),
        (b'"robot":"r"', b'"robot":"r","robot":"\\u003a"'),
        (b'{"format"', b'{"plans":[],"format"'),
        (b'{"format"', b'{"plans":1,"format"'),
        (b'"r"', b'"\\ud800"'),
        (b'"r"', b'"\xff"'),
        (b'"r"', b'"\xed\xa0\x80"'),
        (b'"r"', b'"\x01"'),
        (b'"r"', b"1" * 101),
        (b"0,null", b"-" + b"1" * 101 + b",null"),
        (b"null", b"NaN"),
        (b"null", b"1" * 101),
    ],
)
def test_plans_are_refused_that_are_no_json(
    read: Callable[[bytes], object], data: bytes, old: bytes, new: bytes
) -> None:
    read(data)
    with pytest.raises(Refusal) as refused:
        read(data.replace(old, new, 1))
    assert refused.value.rule == "document/json"


@pytest.mark.parametrize(("read", "data"), [(read_solution, PLANNED), (read_trace, FOLLOWED)])
def test_an_escaped_letter_is_the_letter(read: Callable[[bytes], object], data: bytes) -> None:
    assert read(data.replace(b'"r"', b'"\\u0072"')) == read(data)


@pytest.mark.parametrize("new", [b"1.0", b"1e3", b"true", b'"1"', b"[]", b"null,null", b"1,"])
def test_visits_are_refused_that_have_no_shape(new: bytes) -> None:
    with pytest.raises(Refusal):
        read_solution(PLANNED.replace(b"null", new))


def test_names_in_strings_are_no_members() -> None:
    data = PLANNED.replace(b'"r"', b'"\\":r\\":"')
    assert read_solution(data).order == ('":r":',)
    named = data.replace(b'{"format"', b'{"$schema":"urn:carproof:solution:1","format"')
    assert read_solution(named) == read_solution(data)
    assert read_solution(PLANNED.replace(b"null", b"9" * 100)).plans[0].visits[0].leave == int("9" * 100)
