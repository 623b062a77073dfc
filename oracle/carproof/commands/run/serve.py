"""`carproof serve`: the oracle's protocol."""

import sys
from contextlib import redirect_stdout

import click

from carproof.command_line.answer import Answer
from carproof.command_line.options import engine_option, examples
from carproof.engines import engine_named
from carproof.protocol.ops.published import op_list
from carproof.protocol.server import serve


@click.command(
    short_help="Answer requests, one a line.",
    epilog=op_list()
    + examples(
        """echo '{"id": 1, "op": "start", "version": 1}' | carproof serve""",
        "carproof serve < requests.jsonl > responses.jsonl",
    ),
)
@engine_option
def command(engine: str | None) -> Answer:
    """Answer requests, one a line, until stop or the end of the input.

    Each line of standard input is a JSON object with id and op and the fields of the op; each gets one line on
    standard output. A bad line gets an error response, and never ends the process. docs/reference/protocol.md
    lists the fields of each op.
    """
    requests, responses = sys.stdin.buffer, sys.stdout.buffer
    with redirect_stdout(sys.stderr):
        serve(requests, responses, engine_named(engine))
    return Answer.YES
