"""Deadlines of groups of robots in the search for prices, and all of them as arrays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from carp_optimized.jit.kinds import Longs
from carp_spec.documents.bounds import DeadlinesDocument


class Member(NamedTuple):
    """A robot, by position, of a group with deadlines.

    It keeps its own if it enters its goal for the last time by tick `arrival`, or if at tick `seen` it is in one
    of the places, on its way.
    """

    robot: int
    arrival: int
    seen: int
    places: Sequence[int]


@dataclass(frozen=True, slots=True)
class Deadlines:
    """Deadlines that their members cannot all keep, and the certificate of that, without price."""

    members: Sequence[Member]
    document: DeadlinesDocument


class Flat(NamedTuple):
    """All members of all deadlines, one after the other, and their places, each with the number of its deadlines.

    `inside[member]` has the places of the member, as `carp_optimum.lagrangian.state` numbers them, `NONE` as the last.
    A place has the row of its robot and tick.
    """

    sizes: Longs
    group: Longs
    robot: Longs
    arrival: Longs
    seen: Longs
    inside: npt.NDArray[np.bool_]
    place: Longs
    row: Longs
    group_of_place: Longs


def flattened(deadlines: Sequence[Deadlines], resources: int) -> tuple[Flat, Mapping[tuple[int, int], int]]:
    """The members of all deadlines, and the rows of robots that are seen at a tick, from 1 on."""
    members = [(number, member) for number, each in enumerate(deadlines) for member in each.members]
    rows: dict[tuple[int, int], int] = {}
    inside = np.zeros((len(members), resources + 2), np.bool_)
    places: list[tuple[int, int, int]] = []
    for position, (number, member) in enumerate(members):
        inside[position, list(member.places)] = True
        if member.places:
            row = rows.setdefault((member.robot, member.seen), len(rows) + 1)
            places += [(place, row, number) for place in member.places]
    flat = Flat(
        sizes=np.array([len(each.members) for each in deadlines], np.int64),
        group=np.array([number for number, _ in members], np.int64),
        robot=np.array([member.robot for _, member in members], np.int64),
        arrival=np.array([member.arrival for _, member in members], np.int64),
        seen=np.array([member.seen for _, member in members], np.int64),
        inside=inside,
        place=np.array([place for place, _, _ in places], np.int64),
        row=np.array([row for _, row, _ in places], np.int64),
        group_of_place=np.array([number for _, _, number in places], np.int64),
    )
    return flat, rows
