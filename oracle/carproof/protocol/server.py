"""The oracle as a process that stays up: lines in, lines out, until `stop` or the end of the input."""

import sys
import traceback
from typing import BinaryIO

from carp_spec import Refusal
from carp_spec.documents.decoding import write
from carproof.engines import Engine
from carproof.extras import INSTALLED, advice
from carproof.protocol.lines import LONGEST_LINE, MISSING, NULL, SHORT_LINE, ErrorDocument, Request, Response, refused
from carproof.protocol.ops import answer
from carproof.protocol.ops.op import Session

_PIECE = 2**20


def serve(requests: BinaryIO, responses: BinaryIO, engine: Engine) -> None:
    """Answer every line by one line. Fleets that are open at the end are forgotten."""
    session = Session(engine)
    running = True
    while running and (line := requests.readline(LONGEST_LINE + 1)):
        line = line.removesuffix(b"\n")
        if len(line) <= LONGEST_LINE:
            response, running = respond(line, session)
        else:
            _skip_line(requests)
            message = f"the line must have at most {LONGEST_LINE} bytes"
            response = Response(NULL, error=refused(Refusal("limit", "$", SHORT_LINE.id, message)))
        responses.write(write(response))
        responses.flush()


def respond(line: bytes, session: Session) -> tuple[Response, bool]:
    """Answer one line, and return whether to continue."""
    id, op = NULL, ""
    try:
        request = Request(line)
        id = NULL if request.id is MISSING else request.id
        op = request.op()
        return Response(id, result=answer(request, op, session)), op != "stop"
    except Refusal as refusal:
        return Response(id, error=refused(refusal)), True
    except Exception as fault:  # noqa: BLE001 - whatever goes wrong with one request, the next is answered
        advised = advice(fault) if isinstance(fault, ModuleNotFoundError) else None
        if advised is not None:
            return Response(id, error=refused(Refusal("limit", "$.op", INSTALLED.id, f"the op {op} {advised}"))), True
        traceback.print_exc(file=sys.stderr)
        message = f"carproof failed by a fault of its own: {type(fault).__name__}: {fault}"
        return Response(id, error=ErrorDocument("internal", "$", None, message)), True


def _skip_line(requests: BinaryIO) -> None:
    piece = requests.readline(_PIECE)
    while piece and not piece.endswith(b"\n"):
        piece = requests.readline(_PIECE)
