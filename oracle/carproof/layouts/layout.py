"""A layout: points, lanes between them, blocks, vehicles, and notes of what an instance cannot express.

Lengths and positions are whole millimetres, speeds are millimetres a second.
"""

from collections.abc import Callable, Mapping, Sequence
from collections.abc import Set as AbstractSet
from dataclasses import dataclass, field, replace
from fractions import Fraction
from math import isqrt

from carproof.layouts.located import LARGEST, Tree
from carproof.layouts.strips import Spot, Strip, Track, strip_of

SILENT = frozenset(("<>", "text", "xmlns", "xmlns:xsi", "xsi:schemaLocation"))
"""Of XML, what says nothing of a layout."""

PLANE = "check --footprint takes the positions of all as one plane"
"""Of points on several levels, which an instance does not tell apart."""


@dataclass(frozen=True, slots=True)
class Point:
    """A place at which a vehicle can be; `stands` is whether it may stay there for long.

    Vehicles on two different levels are above each other; without a level a point may be on any.
    """

    id: str
    x: int | None
    y: int | None
    stands: bool
    level: str | None = None

    @property
    def spot(self) -> Spot | None:
        """Where it is, if that is known."""
        return None if self.x is None or self.y is None else (self.x, self.y)


@dataclass(frozen=True, slots=True)
class Lane:
    """A way from one point to another; `None` is no length, which takes a tick, or no limit of the speed.

    `share` is the part of its speed that a vehicle may use; `backwards` is whether it looks back. `strips` are the
    pieces of the floor that vehicles take; those of several types may take several.
    """

    id: str
    source: str
    target: str
    length: int | None
    speed: Fraction | None
    strips: tuple[Strip, ...]
    share: Fraction = Fraction(1)
    backwards: bool = False


@dataclass(frozen=True, slots=True)
class Block:
    """Points and lanes in which one vehicle may be at a time."""

    id: str
    members: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Vehicle:
    """A vehicle of the file, with its place and perhaps where it goes."""

    id: str
    start: str
    goal: str | None


@dataclass(frozen=True, slots=True)
class Note:
    """A feature that the instance does not express, with the lines of the file that have it."""

    feature: str
    lines: tuple[int, ...]


def spot(at: Tree, place: tuple[Fraction, Fraction]) -> Spot:
    """A place in mm as whole mm."""
    if max(map(abs, place)) > LARGEST:
        raise at.refuse(f"a position must be between -{LARGEST} and {LARGEST} mm")
    return round(place[0]), round(place[1])


@dataclass(slots=True)
class Layout:
    """What a reader has found so far.

    `holds_ends`: who is on a lane holds both its ends too. `places` has, of points that are one place on the floor, the
    first. `unshaped` has the lanes whose course is not known. `passed` has the values noted whole.
    """

    tree: Tree
    holds_ends: bool = False
    points: dict[str, Point] = field(default_factory=dict)
    lanes: dict[str, Lane] = field(default_factory=dict)
    blocks: dict[str, Block] = field(default_factory=dict)
    vehicles: dict[str, Vehicle] = field(default_factory=dict)
    left_out: dict[str, list[int]] = field(default_factory=dict)
    places: dict[str, str] = field(default_factory=dict)
    unshaped: dict[str, Tree] = field(default_factory=dict)
    passed: set[int] = field(default_factory=set)

    @property
    def notes(self) -> tuple[Note, ...]:
        """What is not expressed, in the order in which it was found."""
        return tuple(Note(feature, tuple(dict.fromkeys(lines))) for feature, lines in self.left_out.items())

    def note(self, feature: str, at: Tree | None, *, usual: str | None = None) -> None:
        """Note a feature that is not expressed, if it is there and not the usual value, which says nothing."""
        if at is not None and at.value not in ([], {}, "", None, usual):
            self.left_out.setdefault(feature, []).append(at.line)
            self.passed.add(id(at))

    def note_unread(self, thing: Tree, features: Mapping[str, str], silent: AbstractSet[str]) -> None:
        """Note all fields that the reader did not ask for, by their features or, where there are none, by their names.

        Those that are silent say nothing of routes. What is noted, and was not asked for a field, is passed over whole.
        """
        if id(thing) in self.passed and not thing.asked:
            return
        if isinstance(thing.value, list):
            for each in thing.value:
                self.note_unread(each, features, silent)
        elif isinstance(thing.value, dict):
            for name, each in thing.value.items():
                if not thing.is_unread(name):
                    self.note_unread(each, features, silent)
                elif name not in silent | SILENT:
                    kind = "element" if name.startswith("<") else "field"
                    self.note(features.get(name, f"the {kind} {name}"), each)

    def note_lanes_apart(self) -> None:
        """Note lanes of which it is not known whether they are one strip with a lane that leads the other way.

        Who is on a lane and holds its ends meets nobody.
        """
        ways: dict[tuple[str, str], dict[tuple[Strip, ...], None]] = {}
        for lane in self.lanes.values():
            ways.setdefault(self._places(lane.source, lane.target), {})[lane.strips] = None
        for name, at in self.unshaped.items():
            lane = self.lanes[name]
            source, target = self._places(lane.source, lane.target)
            apart = any(set(lane.strips).isdisjoint(each) for each in ways.get((target, source), {}))
            if apart and source != target and not self.holds_ends:
                self.note("lanes of another length than the way back; robots may meet on the two", at)

    def _places(self, source: str, target: str) -> tuple[str, str]:
        return self.places.get(source, source), self.places.get(target, target)

    def require_points(self, at: Tree, *ids: str) -> None:
        """Raise `Refusal` where one of the points is not of the layout."""
        for id in ids:
            if id not in self.points:
                raise at.refuse(f"the point {id!r} must be one of the layout")

    def point(
        self,
        at: Tree,
        id: str,
        place: tuple[Fraction, Fraction] | None,
        *,
        stands: bool = True,
        level: str | None = None,
    ) -> None:
        """Add a point, at a place in mm."""
        if id in self.points:
            raise at.refuse(f"the point {id!r} must be given once")
        x, y = (None, None) if place is None else spot(at, place)
        self.points[id] = Point(id, x, y, stands, level)

    def lane(  # noqa: PLR0913 - one for each fact of a lane
        self,
        at: Tree,
        id: str | None,
        ends: tuple[str, str],
        *,
        speed: Fraction | None = None,
        length: Fraction | int | None = None,
        back: bool = False,
        back_speed: Fraction | None = None,
        share: Fraction | None = None,
        backwards: bool = False,
        level: bool = True,
        tracks: Sequence[Track] = (),
    ) -> tuple[str, ...]:
        """Add a lane, and with `back` a second one the other way; without a name it is called by its ends.

        `back_speed` is that of the second if it differs. `backwards` is whether vehicles drive backwards on the second,
        or on the one. The positions of ends that are not on one `level` do not tell the length. `tracks` are those of
        each type of vehicle, if the lane is not straight for all or its length is not all that is known.
        """
        self.require_points(at, *ends)
        name = f"{ends[0]} -> {ends[1]}" if id is None else id
        while id is None and self._is_taken(name):
            name += "'"
        self._require_new(at, name)
        distance = self.distance(*ends) if level else None
        if distance == 0 and length is None:
            raise at.refuse(f"the length of a lane must be above 0, and {ends[0]!r} and {ends[1]!r} are at one place")
        millimetres = distance if length is None else -(-length // 1)
        tracks = tracks or (Track(None if length is None else millimetres),)
        strips = self._strips(ends, tracks, distance)
        lane = Lane(name, *ends, millimetres, speed, strips, share or Fraction(1), backwards and not back)
        self.lanes[name] = lane
        if not all(each.course or each.length == distance for each in tracks):
            self.unshaped[name] = at
        if not back:
            return (name,)
        other = f"{name} (reverse)"
        self._require_new(at, other)
        self.lanes[other] = replace(
            lane, id=other, source=ends[1], target=ends[0], speed=back_speed or speed, backwards=backwards
        )
        return name, other

    def _strips(self, ends: tuple[str, str], tracks: Sequence[Track], distance: int | None) -> tuple[Strip, ...]:
        """The strips along the tracks, each once."""
        spots = [each for end in ends if (each := self.points[end].spot) is not None]
        floor = frozenset(self._places(*ends))
        return tuple(dict.fromkeys(strip_of(each, floor, spots, distance) for each in tracks))

    def _is_taken(self, name: str) -> bool:
        return name in self.lanes or name in self.points

    def _require_new(self, at: Tree, name: str) -> None:
        if self._is_taken(name):
            raise at.refuse(f"the name {name!r} must be given once")

    def block(self, at: Tree, id: str, members: Sequence[tuple[Tree, str]]) -> None:
        """Add a block of points and lanes; a member is each lane of its strip."""
        if id in self.blocks:
            raise at.refuse(f"the block {id!r} must be given once")
        named: dict[str, None] = {}
        for place, member in members:
            if member in named:
                raise place.refuse(f"the member {member!r} must be named once in a block")
            if not self._is_taken(member):
                raise place.refuse(f"the member {member!r} must be a point or a lane of the layout")
            named[member] = None
        self.blocks[id] = Block(id, tuple(named))

    def vehicle(self, at: Tree, id: str, start: str, goal: str | None = None) -> None:
        """Add a vehicle at a point."""
        if id in self.vehicles:
            raise at.refuse(f"the vehicle {id!r} must be given once")
        self.require_points(at, start, *([] if goal is None else [goal]))
        self.vehicles[id] = Vehicle(id, start, goal)

    def distance(self, source: str, target: str) -> int | None:
        """The distance of two points in mm, rounded up; `None` where they have no positions."""
        one, two = self.points[source].spot, self.points[target].spot
        if one is None or two is None:
            return None
        square = (one[0] - two[0]) ** 2 + (one[1] - two[1]) ** 2
        return 1 + isqrt(square - 1) if square else 0


@dataclass(frozen=True, slots=True)
class Reader:
    """A format of layouts: how it is recognised, and how it is read.

    Fields that `read` does not ask for are noted by their `features`, or else by their names, but for `silent` ones.
    """

    name: str
    description: str
    looks_like: Callable[[Tree], bool]
    read: Callable[[Tree], Layout]
    features: Mapping[str, str] = field(default_factory=dict)
    silent: AbstractSet[str] = frozenset()
