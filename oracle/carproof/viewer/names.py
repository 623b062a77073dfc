"""Names that can be shown: one line, not too long, without what all of them begin with."""

from collections import Counter
from collections.abc import Sequence
from os.path import commonprefix

from carproof.command_line.tables import printable

LONGEST_LABEL = 60
LONGEST_SHORT = 4
LONGEST_WHOLE = 7
"""Names of up to this length are shown whole, beside a robot or in a small cell."""
FEWEST_CUT = 3
SEPARATORS = "/\\._-:, "
DIGITS = "0123456789"


def label(value: object) -> str:
    """A value as one short line that can be shown."""
    return cut(printable(value), LONGEST_LABEL)


def cut(text: str, longest: int) -> str:
    """The text, without its middle if it is too long."""
    half = longest // 2
    return text if len(text) <= longest else f"{text[:half]}…{text[-half:]}"


def common_start(names: Sequence[str]) -> str:
    """The beginning of all names, if some are long: it is left out where there is little room. No number is divided."""
    if len(names) <= 1 or max(map(len, names)) <= LONGEST_WHOLE:
        return ""
    start = commonprefix(names).rstrip(DIGITS)  # noqa: RUF071 - names are no paths
    if start in names:
        start = start[: 1 + max(start.rfind(separator, 0, -1) for separator in SEPARATORS)]
    return start if len(start) >= FEWEST_CUT else ""


def fitted(names: Sequence[str], longest: int) -> list[str]:
    """The names with the beginning of long ones cut off, or their end where that leaves more of them different."""
    ends = [each if len(each) <= longest else f"…{each[1 - longest :]}" for each in names]
    beginnings = [each if len(each) <= longest else f"{each[: longest - 1]}…" for each in names]
    return max((ends, beginnings), key=lambda each: len(set(each)))


def short_labels(labels: Sequence[str]) -> list[str]:
    """Labels that fit on a robot: the number at the end of one, if no other has it, or the end of a long one."""
    numbers = [each[len(each.rstrip(DIGITS)) :][-LONGEST_SHORT:] for each in labels]
    count = Counter(numbers)
    tails = [each if len(each) <= LONGEST_SHORT else f"…{each[-LONGEST_SHORT + 1 :]}" for each in labels]
    return [number if number and count[number] == 1 else tails[at] for at, number in enumerate(numbers)]
