"""What is asked of plans that are written: they are lawful, and ids differ as text (not 1 and "1")."""

from collections.abc import Iterable, Mapping

from carp_spec import Instance, Refusal, ResourceId, RobotId, Solution, judge
from carproof.formats.walks import solution_has_walks
from carproof.input_rules import Code


def require_lawful(instance: Instance, solution: Solution) -> None:
    """Raise `Refusal` if the solution breaks a rule; robots may be unplanned."""
    for violation in judge(instance, solution).violations:
        message = f"it must break no rule to be written in this format: {violation}"
        raise Refusal("document", "SOLUTION", solution_has_walks.id, message)


def ids_by_text(instance: Instance, code: Code) -> tuple[Mapping[str, RobotId], Mapping[str, ResourceId]]:
    """The ids of robots and of resources by their texts; raises `Refusal` where two print alike."""
    return _by_text(instance.robot, "robots", code), _by_text(instance.graph.index, "resources", code)


def _by_text(ids: Iterable[str | int], what: str, code: Code) -> Mapping[str, str | int]:
    found: dict[str, str | int] = {}
    for id in ids:
        if str(id) in found:
            raise code.refuse("INSTANCE", f"two {what} must not both print as {id}")
        found[str(id)] = id
    return found
