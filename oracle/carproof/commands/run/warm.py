"""`carproof warm`: compile the planner before it is needed."""

from carproof.command_line.answer import Answer
from carproof.command_line.options import listed
from carproof.command_line.tables import print_line
from carproof.engines import warm


@listed("Compile the planner before it is needed.", "carproof warm")
def command() -> Answer:
    """Compile the planner, so that no later command has to. This takes a minute, once per installation.

    Otherwise the first command that plans compiles it, and says so. The machine code is kept in the folder that
    NUMBA_CACHE_DIR names or else in the first of these that can be written: beside the sources of carproof, in the
    user's cache folder, or among the temporary files.

    Exit codes: 0 it is compiled, 2 bad usage.
    """
    print_line("carproof's planner is compiled" + ("" if warm() else " already"))
    return Answer.YES
