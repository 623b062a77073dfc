"""Deadlines of groups of robots in the search for prices, and all of them as arrays."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from carp_optimized.jit.kinds import Flags, Longs
from carp_spec import Instance
from carp_spec.documents.bounds import DeadlinesDocument
from carp_verify.bound.cuts import formula_of_deadlines
from carp_verify.optimum.clauses import Formula
from carp_verify.optimum.rules import LARGEST_FORMULA


class Member(NamedTuple):
    """A robot, by position, of a group with deadlines.

    It keeps its own if it enters its goal for the last time by tick `arrival`, or if at tick `seen` it is in one
    of the places, on its way. It is not seen if that is 0.
    """

    robot: int
    arrival: int
    seen: int
    places: Sequence[int]


@dataclass(frozen=True, slots=True)
class Deadlines:
    """Deadlines that their members cannot all keep, and the refutation of the contrary; none if it is not proved."""

    members: Sequence[Member]
    refutation: str = ""

    def document(self, instance: Instance, price: int = 0) -> DeadlinesDocument:
        """The deadlines as a certificate has them."""
        resources = instance.graph.resources
        robots = tuple(instance.robots[each.robot].id for each in self.members)
        ticks = tuple(max(each.arrival, 0) for each in self.members)
        seen = tuple((each.seen, tuple(resources[at].id for at in each.places)) for each in self.members if each.seen)
        return DeadlinesDocument(robots, ticks, price, self.refutation, seen)

    def formula(self, instance: Instance) -> Formula:
        """The formula that shows them when it is refuted; raises `Refusal` if it would be too large."""
        return formula_of_deadlines(instance, self.document(instance), LARGEST_FORMULA)


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
    inside: Flags
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
    columns = [(number, member.robot, member.arrival, member.seen) for number, member in members]
    group, robot, arrival, seen = np.array(columns, np.int64).reshape(-1, 4).T
    place, row_of_place, group_of_place = np.array(places, np.int64).reshape(-1, 3).T
    sizes = np.array([len(each.members) for each in deadlines], np.int64)
    return Flat(sizes, group, robot, arrival, seen, inside, place, row_of_place, group_of_place), rows
