"""Solutions in other planners' formats, one per module, and instances of other tools.

`read_foreign_solution` reads any format, and recognises it if it is not named; `write_foreign_solution` writes them.
`walks` defines the semantics of the formats that planners have. `plans.vda5050` writes orders for robots.
`read_movingai` and `write_movingai` are for files of the MovingAI benchmarks, `instance_from_array` for grids of NumPy,
`instance_from_networkx` and `graph_of` for graphs of networkx. To add a format, write its module and put its adapter
into `ADAPTERS`.
"""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from carp_spec import Instance, Refusal, Rule, Solution
from carp_spec.inputs.values import require_instance, require_solution
from carp_spec.rule import DESIGN
from carp_spec.shapes import require_shape
from carproof.formats import agent_paths, carproof_documents, lacam, libmultirobotplanning, mapf_tracker
from carproof.formats.adapter import Adapter
from carproof.formats.arrays import RIGHT_ARRAY, instance_from_array
from carproof.formats.logs.cells import RIGHT_LOG
from carproof.formats.movingai import read_movingai
from carproof.formats.movingai_writer import MovingAIFiles, write_movingai
from carproof.formats.networkx_graphs import graph_of, instance_from_networkx, node_is_right
from carproof.formats.plans import table
from carproof.formats.plans.vda5050 import RIGHT_NAMES, settings_are_right
from carproof.formats.walks import WALK_RULES
from carproof.input_rules import Code

__all__ = [
    "ADAPTERS",
    "ADAPTER_RULES",
    "MovingAIFiles",
    "format_of",
    "graph_of",
    "instance_from_array",
    "instance_from_networkx",
    "looks_like_none",
    "named_as",
    "read_foreign_solution",
    "read_movingai",
    "write_foreign_solution",
    "write_movingai",
]

ADAPTERS: Mapping[str, Adapter] = {
    each.name: each
    for each in (
        carproof_documents.ADAPTER,
        lacam.ADAPTER,
        libmultirobotplanning.ADAPTER,
        mapf_tracker.ADAPTER,
        agent_paths.ROW_COLUMN,
        agent_paths.X_Y,
        table.ADAPTER,
    )
}
"""The formats by name."""


CLEAR_FORMAT = Code(
    "adapter/format",
    "A solution is text in UTF-8. If its format is not named, it looks like one; of those that it looks like, it is "
    "the one in which every robot begins at its start, or it means the same in each.",
    DESIGN,
)
ADAPTER_RULES: tuple[Rule[..., Any] | Code, ...] = (
    *WALK_RULES,
    CLEAR_FORMAT,
    lacam.RIGHT_LINES,
    libmultirobotplanning.RIGHT_SCHEDULE,
    mapf_tracker.RIGHT_MOVES,
    agent_paths.RIGHT_PATHS,
    table.RIGHT_TABLE,
    settings_are_right,
    RIGHT_NAMES,
    RIGHT_LOG,
    node_is_right,
    RIGHT_ARRAY,
)
"""The rules of the formats."""


def read_foreign_solution(data: bytes, instance: Instance, file: str = "file", format: str | None = None) -> Solution:
    """Read a solution in the format named or, if none is, in the one that it looks like.

    Raises `Refusal` with file and line, also where two formats are possible or none is.
    """
    require_instance(instance)
    require_shape(data, bytes, file)
    return _adapter(format or format_of(data, instance, file)).read(_text(data, file), instance, file)


def write_foreign_solution(instance: Instance, solution: Solution, format: str) -> bytes:
    """Write a solution in the format named; raises `Refusal` if it is malformed or breaks a rule of the format."""
    require_solution(instance, solution)
    return _adapter(format).write(instance, solution).encode()


def format_of(data: bytes, instance: Instance, file: str = "file") -> str:
    """The format that a solution looks like; raises `Refusal` where two are possible or none is."""
    require_instance(instance)
    text = _text(data, file)
    looks = _looks(text)
    possible = looks if len(looks) == 1 else _fitting(looks, text, instance)
    if len(possible) == 1:
        return possible[0]
    what = f"it could be {', '.join(looks)}" if looks else f"it looks like none of {', '.join(ADAPTERS)}"
    raise CLEAR_FORMAT.refuse(file, f"the format must be named by --from: {what}")


def named_as(instance: Instance, format: str) -> Instance:
    """The instance with its robots named as in files of the format, if these have names."""
    require_instance(instance)
    agent = _adapter(format).agent
    if agent is None:
        return instance
    robots = tuple(replace(robot, id=f"{agent}{number}") for number, robot in enumerate(instance.robots))
    return replace(instance, robots=robots)


def _adapter(format: str) -> Adapter:
    require_shape(format, str, "$.format")
    if format not in ADAPTERS:
        message = f"there is no format {format!r}; the formats are {', '.join(ADAPTERS)}"
        raise Refusal("option", "$.format", CLEAR_FORMAT.id, message)
    return ADAPTERS[format]


def looks_like_none(data: bytes) -> bool:
    """Whether the data look like no format at all."""
    return not _looks(data.decode(errors="replace"))


def _text(data: bytes, file: str) -> str:
    """The text; bytes that are not UTF-8 are kept in JSON alone, whose reader refuses them."""
    is_json = data.lstrip().startswith(b"{")
    text = data.decode(errors="surrogateescape") if is_json else CLEAR_FORMAT.text(data, file)
    return text.replace("\r\n", "\n")


def _looks(text: str) -> list[str]:
    return [name for name, each in ADAPTERS.items() if each.looks_like(text)]


def _fitting(names: list[str], text: str, instance: Instance) -> list[str]:
    """The formats in which the text can be read and robots begin at their starts, or one if all agree."""
    read = {name: solution for name in names if (solution := _solution(text, instance, name)) is not None}
    begin = [name for name, solution in read.items() if _begins_at_starts(solution, instance)]
    likely = begin or list(read)
    agree = all(read[name] == read[likely[0]] for name in likely)
    return likely[:1] if agree else begin


def _solution(text: str, instance: Instance, format: str) -> Solution | None:
    try:
        return ADAPTERS[format].read(text, instance, "file")
    except Refusal:
        return None


def _begins_at_starts(solution: Solution, instance: Instance) -> bool:
    return all(plan.visits[0].resource == instance.robot[plan.robot].start for plan in solution.plans)
