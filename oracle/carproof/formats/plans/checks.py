"""What is asked of plans that are written: they are lawful, and ids differ as text (not 1 and "1")."""

from collections.abc import Iterable, Mapping
from typing import TypeVar

from carp_spec import Instance, Refusal, Solution, judge
from carproof.formats.walks import solution_has_walks
from carproof.input_rules import Code

Id = TypeVar("Id", bound=str | int)


def require_lawful(instance: Instance, solution: Solution) -> None:
    """Raise `Refusal` if the solution breaks a rule; robots may be unplanned."""
    for violation in judge(instance, solution).violations:
        message = f"it must break no rule to be written in this format: {violation}"
        raise Refusal("document", "SOLUTION", solution_has_walks.id, message)


def names_of(ids: Iterable[Id], what: str, code: Code) -> Mapping[Id, str]:
    """The ids with their texts; raises `Refusal` where two print alike."""
    names: dict[Id, str] = {}
    taken: set[str] = set()
    for id in ids:
        if str(id) in taken:
            raise code.refuse("INSTANCE", f"two {what} must not both print as {id}")
        taken.add(str(id))
        names[id] = str(id)
    return names
