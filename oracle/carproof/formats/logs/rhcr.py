"""The file paths.txt of RHCR: the number of robots, then a line for each, `cell,heading,tick;` from tick 0 on.

Cells are numbered row by row from the top left. Headings are not judged. The file has no tasks.
Source: what the simulator of Rolling-Horizon Collision Resolution (Li et al. 2021) writes.
"""

import re

from carproof.formats.logs.cells import RIGHT_LOG, CellLog
from carproof.formats.walks import require_bounded

_STATE = re.compile(r"(\d{1,9}),-?\d{1,9},(\d{1,9});")
_LINE = re.compile(rf"(?:{_STATE.pattern})+")


def read(text: str, width: int, file: str) -> CellLog:
    """Read paths."""
    import numpy as np  # noqa: PLC0415 - slow to load

    lines = [line.strip() for line in text.strip().split("\n")]
    if not re.fullmatch(r"\d{1,9}", lines[0]) or int(lines[0]) != len(lines) - 1:
        raise RIGHT_LOG.refuse(
            f"{file}:1", f"the line must be the number of robots, a line for each; there are {len(lines) - 1}"
        )
    require_bounded(text.count(";"), file)
    walks = []
    for number, line in enumerate(lines[1:], start=2):
        packed = re.sub(r"\s", "", line)
        if not _LINE.fullmatch(packed):
            raise RIGHT_LOG.refuse(
                f"{file}:{number}", "the line must be like 5,0,0;6,0,1; with a cell, a heading and a tick each"
            )
        states = [(int(cell), int(tick)) for cell, tick in _STATE.findall(packed)]
        for place, (_, tick) in enumerate(states):
            if tick != place:
                raise RIGHT_LOG.refuse(
                    f"{file}:{number}", f"state {place} must be that of tick {place}, and is that of {tick}"
                )
        cells = np.array([cell for cell, _ in states], np.int32)
        walks.append(np.stack([cells % width, cells // width], axis=1))
    return CellLog(walks, [[] for _ in walks])
