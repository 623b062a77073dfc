"""carproof's own solution document, among the formats to choose from."""

from weakref import ref

from carp_spec import Instance, Refusal, Solution
from carp_spec.documents.solutions import read_solution, write_solution
from carp_spec.inputs.values import remember
from carproof.formats.adapter import Adapter


def read(text: str, instance: Instance, file: str) -> Solution:
    """Read a document; a refusal names the file and the path. The instance, which is right, remembers the solution."""
    try:
        solution = read_solution(text.encode(errors="surrogateescape"))
    except Refusal as refusal:
        raise Refusal(refusal.kind, f"{file}: {refusal.path}", refusal.rule, refusal.message) from refusal
    remember(instance, ref(solution))  # what is read has the right shape
    return solution


def write(instance: Instance, solution: Solution) -> str:
    """Write a document."""
    del instance
    return write_solution(solution).decode()


ADAPTER = Adapter(
    "carproof",
    "carproof's own document, for every instance",
    lambda text: text.lstrip().startswith("{"),
    read,
    write,
)
