"""Cases of `document/...` and `planner/options`: what is refused before anything is judged."""

from collections.abc import Mapping, Sequence
from typing import Any

from tests.vectors.making import EDGE, Flags, case, instance, robot, row, solution

from carp_spec.vectors import Fields, Vector

TOWN = instance(row("ab"), robot("r1", "a", "b"))
WALK = solution(r1="a 0 1, b 1 2")
DONE = {"cost": 1, "unplanned": 0}


def _json(id: str, comment: str, text: str, *, right: bool, flags: Flags = ()) -> Vector:
    violated = [] if right else ["document/json"]
    return case(id, "document/json", comment, input={"text": text}, violated=violated, flags=flags)


def _bytes(id: str, comment: str, hexadecimal: str) -> Vector:
    return case(id, "document/json", comment, input={"hex": hexadecimal}, violated=["document/json"])


JSON: Sequence[Vector] = (
    _json("object", "the least document", "{}", right=True, flags=EDGE),
    _json("space-around", "white space around the value is allowed", ' \n{"a": [1, null]}\r\n\t', right=True),
    _json("beyond-ascii", "ids may be written in any script", '"kávová linka"', right=True),
    _json("exponent", "1e3 is a JSON number; that it is no whole number is a matter of shape", "[1e3]", right=True),
    _json("empty", "nothing is no value", "", right=False, flags=EDGE),
    _json("cut-short", "a file whose writer was killed", '{"format":"carproof-solution/1","plans":[', right=False),
    _json("two-values", "a reader that stops at the first value misses the second", "{}{}", right=False),
    _json("not-a-number", "NaN is Python's, not JSON's", "[NaN]", right=False),
    _json("comma-at-the-end", "allowed in Python and in JSON5, not in JSON", "[1,]", right=False),
    _json("single-quotes", "what printing a Python value gives", "{'a': 1}", right=False),
    _json("name-twice", "readers differ in which of the two they keep", '{"a": 1, "a": 2}', right=False),
    _json("too-many-digits", "a number of 101 digits is a mistake or an attack", "1" * 101, right=False, flags=EDGE),
    _json("hundred-digits", "100 are allowed", "1" * 100, right=True, flags=EDGE),
    _bytes("latin-1", "the byte ff never occurs in UTF-8", "22ff22"),
    _bytes("byte-order-mark", "JSON in UTF-8 has none", "efbbbf7b7d"),
)


def _check(  # noqa: PLR0913 - the fields of a case
    id: str,
    comment: str,
    instance: Any,  # noqa: ANN401 - malformed documents too
    solution: Any = WALK,  # noqa: ANN401 - malformed documents too
    *,
    rule: str = "",
    refused: str = "",
    flags: Flags = (),
) -> Vector:
    answer: Fields = {"refused": refused} if refused else DONE
    violated = [rule] if refused else []
    input = {"solution": solution}
    return case(id, "check", comment, instance=instance, input=input, violated=violated, answer=answer, flags=flags)


def _without(document: Fields, name: str) -> Fields:
    return {field: value for field, value in document.items() if field != name}


def _format(id: str, comment: str, instance: Any, solution: Any = WALK, refused: str = "") -> Vector:  # noqa: ANN401 - malformed documents too
    return _check(id, comment, instance, solution, rule="document/format", refused=refused)


FORMAT: Sequence[Vector] = (
    _format("both-right", "instance and solution each name their kind and version", TOWN),
    _format("format-last", "the order of fields means nothing", {**_without(TOWN, "format"), "format": TOWN["format"]}),
    _format("spaces-in-ids", "a format is compared, ids are not parsed", TOWN, WALK),
    _format("missing", "a document without format may be anything", _without(TOWN, "format"), WALK,
            "$.instance.format"),
    _format("later-version", "a later version may mean other things by the same fields",
            {**TOWN, "format": "carproof-instance/2"}, WALK, "$.instance.format"),
    _format("solution-as-instance", "files given in the wrong order", WALK, WALK, "$.instance.format"),
    _format("instance-as-solution", "files given in the wrong order", TOWN, TOWN, "$.solution.format"),
    _format("list", "valid JSON, and no document", [], WALK, "$.instance.format"),
)  # fmt: skip


def _shape(id: str, comment: str, instance: Any, solution: Any = WALK, refused: str = "") -> Vector:  # noqa: ANN401 - malformed documents too
    return _check(id, comment, instance, solution, rule="document/shape", refused=refused)


def _node(**fields: object) -> Fields:
    return {**TOWN, "graph": {**TOWN["graph"], "nodes": [{"id": "a", **fields}, {"id": "b"}]}}


def _request(**fields: object) -> Fields:
    return {**TOWN, "robots": [{**robot("r1", "a", "b"), **fields}]}


def _visits(*visits: object) -> Fields:
    return {**WALK, "plans": [{"robot": "r1", "visits": [*visits]}]}


SHAPE: Sequence[Vector] = (
    _shape("defaults-left-out", "capacity, duration, release and pace default to 1, 1, 0 and 1", TOWN),
    _shape("defaults-given", "the same instance with all of them", _request(release=0, pace=1)),
    _shape("negative-position", "positions are any whole numbers", _node(x=-3, y=0)),
    _shape("graph-name", "networkx gives a graph attributes; the name is for people",
           {**TOWN, "graph": {**TOWN["graph"], "graph": {"name": "town"}}}),
    _shape("unknown-field", "a misspelt field would silently keep its default",
           _request(realease=5), WALK, "$.instance.robots[0]"),
    _shape("true-as-number", "true is 1 in Python and C", _node(capacity=True), WALK,
           "$.instance.graph.nodes[0].capacity"),
    _shape("float-as-tick", "1.0 equals 1 in JavaScript, and 0.1 + 0.2 does not equal 0.3",
           _request(release=1.0), WALK, "$.instance.robots[0].release"),
    _shape("text-as-number", "some languages add the text 1 to numbers",
           _node(duration="1"), WALK, "$.instance.graph.nodes[0].duration"),
    _shape("null-as-position", "absent is left out, not null", _node(x=None, y=None), WALK,
           "$.instance.graph.nodes[0].x"),
    _shape("no-robots", "an instance without robots has an empty list", _without(TOWN, "robots"), WALK, "$.instance"),
    _shape("unknown-policy", "only two things can be done after the goal",
           {**TOWN, "after_goal": "stay"}, WALK, "$.instance.after_goal"),
    _shape("visit-of-two", "a visit without leave is not for ever; null is",
           TOWN, _visits(["a", 0, 1], ["b", 1]), "$.solution.plans[0].visits[1]"),
    _shape("enter-null", "only leave may be null", TOWN, _visits(["a", None, 1]), "$.solution.plans[0].visits[0][1]"),
    _shape("plans-by-robot", "an object would lose the planning order", TOWN, {**WALK, "plans": {}},
           "$.solution.plans"),
)  # fmt: skip


def _options(id: str, comment: str, refused: str = "", flags: Flags = (), **options: object) -> Vector:
    answer: Fields = {"refused": refused} if refused else DONE
    violated = ["planner/options"] if refused else []
    return case(id, "plan", comment, instance=TOWN, input=options, violated=violated, answer=answer, flags=flags)


OPTIONS: Sequence[Vector] = (
    _options("defaults", "no option has to be given", planner="neighbourhood"),
    _options("no-neighbours", "a neighbourhood of the new robot alone is CARP", flags=EDGE, planner="neighbourhood",
             m=1),
    _options("one-order", "a sample of one", flags=EDGE, planner="neighbourhood", m=3, sample=1),
    _options("largest-seed", "a seed is a word of 64 bits", flags=EDGE, planner="shuffled", seed=2**64 - 1),
    _options("one-path", "one path leaves no choice", flags=EDGE, planner="fixed-paths", k=1, paths="disjoint"),
    _options("no-sample", "null stands for all orders", planner="neighbourhood", sample=None, fallback=None),
    _options("empty-neighbourhood", "the new robot is always in it", "$.m", EDGE, planner="neighbourhood", m=0),
    _options("no-attempt", "at least the given order is tried", "$.attempts", EDGE, planner="shuffled", attempts=0),
    _options("seed-too-large", "it would wrap around to 0", "$.seed", EDGE, planner="shuffled", seed=2**64),
    _options("seed-negative", "it would wrap around too", "$.seed", EDGE, planner="neighbourhood", seed=-1),
    _options("sample-of-none", "no order would be planned", "$.sample", EDGE, planner="neighbourhood", sample=0),
    _options("true-as-count", "true is no number", "$.m", planner="neighbourhood", m=True),
    _options("one-as-truth", "and 1 is not true", "$.baseline", planner="neighbourhood", baseline=1),
    _options("unknown-paths", "there are two kinds of paths", "$.paths", planner="fixed-paths", paths="longest"),
    _options("option-of-another", "attempts are shuffled's", "$.attempts", planner="carp", attempts=10),
    _options("unknown-planner", "a name is not guessed", "$.planner", planner="CARP"),
)  # fmt: skip

CASES: Mapping[str, Sequence[Vector]] = {
    "document/json": JSON,
    "document/format": FORMAT,
    "document/shape": SHAPE,
    "planner/options": OPTIONS,
}
