"""The scene: all that a picture of a solution shows, with every place and lane worked out.

The page's script and the stills are made from nothing else. Texts are cut to a line that can be shown. Resources and
robots are numbered; those that only a broken solution names come last.
"""

from dataclasses import dataclass

from carp_spec.windows import Occupation
from carproof.viewer.colours import Look


@dataclass(frozen=True, slots=True)
class Place:
    """A resource: where its centre is drawn, if it has a place at all, and its lanes and free windows over time.

    `name` is its label without the `start` of the scene; `lanes_done` are those of the visits that have happened. A
    lane of a plant has a `way`: where it begins and ends, on which robots move along it.
    """

    label: str
    name: str
    capacity: str
    duration: str
    at: tuple[int, int] | None
    lanes: int
    lanes_done: int
    windows: tuple[Occupation, ...]
    way: tuple[tuple[int, int], tuple[int, int]] | None = None


@dataclass(frozen=True, slots=True)
class Stand:
    """Where a robot is drawn: the place, the lane in it, and the circle there, if the place is on the map."""

    place: int
    lane: int
    at: tuple[int, int] | None
    radius: int


@dataclass(frozen=True, slots=True)
class Mark:
    """Where a start or a goal is drawn: its centre, and half its width."""

    x: int
    y: int
    half: int


@dataclass(frozen=True, slots=True)
class Track:
    """A robot with one of its plans, or with none; a stay is (stand, enter, leave), and `note` what is odd.

    `look` is the number of its look; `stays` are planned, and `done` have happened. `stops` are places with the ticks
    of their service, the last of them the goal; `stop_marks` are of those before it. In `services` ticks the plan
    serves.
    """

    label: str
    short: str
    look: int
    start: int | None
    goal: int | None
    start_mark: Mark | None
    goal_mark: Mark | None
    stops: tuple[tuple[int, int], ...]
    stop_marks: tuple[Mark, ...]
    services: tuple[tuple[int, int], ...]
    release: int
    pace: str
    cost: int | None
    note: str
    stays: tuple[tuple[int, int, int | None], ...]
    done: tuple[tuple[int, int, int | None], ...]


@dataclass(frozen=True, slots=True)
class Broken:
    """A violation: its rule, tracks and places by number, and the ticks [start, end).

    An exchange has the places between which robots move, all others at most one.
    """

    rule: int
    tracks: tuple[int, ...]
    places: tuple[int, ...]
    start: int | None
    end: int | None
    message: str


@dataclass(frozen=True, slots=True)
class Outline:
    """A group of resources: its label, and the corners of a line around them."""

    label: str
    corners: tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class BrokenRule:
    """A broken rule, and the number of its violations; not all of them may be listed."""

    id: str
    statement: str
    count: int


@dataclass(frozen=True, slots=True)
class Scene:
    """All that a picture shows; without plans, the instance `alone`.

    `first` and `last` are the ticks between which something happens, and `now` is the tick of the trace, if there is
    one; `gap` is how many ticks a resource is empty before it is entered again; `computed` says that the places are
    not the instance's own positions, and `named` that there are few enough to write their names on the map. `start` is
    what the labels of all resources begin with, if that is left out.
    """

    title: str
    first: int
    last: int
    now: int | None
    gap: int
    cost: str
    unplanned: int
    alone: bool
    computed: bool
    named: bool
    start: str
    width: int
    height: int
    looks: tuple[Look, ...]
    places: tuple[Place, ...]
    stands: tuple[Stand, ...]
    outlines: tuple[Outline, ...]
    tracks: tuple[Track, ...]
    rules: tuple[BrokenRule, ...]
    violations: tuple[Broken, ...]
