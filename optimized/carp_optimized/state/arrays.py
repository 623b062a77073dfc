"""The state of a fleet as flat arrays of ints: what the compiled functions read and write.

Resources and robots are their indices in the instance, plans are the numbers of their records. Ticks are 32-bit;
every sum of them is made in 64 bits, and none that is stored exceeds `NEVER`.
"""

from typing import NamedTuple

from carp_optimized.jit.kinds import Ints, IntTable, Longs, LongTable, Numbers

NEVER = 2**31 - 1  # the end of what lasts for ever
LARGEST = 2**30 - 1  # of ticks and durations: the sum of two is still below NEVER
TICK_BITS = 30  # of a tick up to LARGEST
LOW = 2**32 - 1  # the lower half of a key
FIRST = -(2**62)  # the least key: those of windows that come first fill what is below 0
NONE = -1  # no resource, no record, no slot
GROUPED = 0  # the capacity of a resource of groups: those of its constraints are elsewhere
UNKNOWN = -1  # the number of expansions of a plan that no query of the fleet has made

SEVERAL = -2  # the source of stays that came from several resources

UNREACHABLE = -1  # a guide: the goal cannot be reached from the resource
TOO_FAR = -2  # a guide: it can, in more than LARGEST ticks
FURTHER = -3  # a guide: the resource is further from the goal than any that the guide has reached

ASKED, KEPT, UNCHANGED, PREFIX, SHARED, BOUND = range(6)  # the counters, in the order of `Queries`
COUNTERS = 6
QUEUED, TURN, MARKS, CHANCE, MARKED, NOW, FORGOTTEN = range(7)  # the counts of a polish

PLANS = 62  # plans that a set of plans in 64 bits can hold; the bit PLANS stands for all others
ANSWERS = 512  # of queries, that a round keeps
NO_LIMIT = 1 << 62  # of a cost
NOTED, ALONE, WHOLE, SOON, GREEDY = range(5)  # what a query is asked for: see `find_any_plan`
UNASKED = -2  # no record yet
LATE = -2  # the plan of an answer is not below the limit

MOST_MEMBERS = 10  # of a neighbourhood that is polished
MOST_TURNS = 16  # members of a round in which robots take turns at a resource


class Graph(NamedTuple):
    """The resource graph: moves lead from r to `target[first[r]:first[r + 1]]`, and come to it from `source[...]`.

    `region[r]` is a number with one bit set, the same for resources that are near one another.

    The resources of groups are `GROUPED` in `capacity`. Of these, r is in the groups `group[groups_first[r]:...]`, and
    the resources of the group g are `member[members_first[g]:...]`. A constraint is the resource's own capacity, of
    its number, or a group, of its number above all resources: `room` is how many robots it has room for.
    """

    first: Ints
    target: Ints
    backward_first: Ints
    source: Ints
    duration: Ints
    capacity: Ints
    x: Longs
    y: Longs
    region: Longs
    groups_first: Ints
    group: Ints
    members_first: Ints
    member: Ints
    room: Ints


class Rows(NamedTuple):
    """For each resource a row of intervals [start, end), in order of time, in a pool that all rows share.

    The row of r has `size[r]` intervals in the slots from `offset[r]` on and room for `room[r]`, blocks of `BLOCK`
    whose other slots start and end at `NEVER`. A full row moves to the end of the pool, at `used[0]`, with twice the
    room. `resource` says whose row a slot is in.

    Of windows, where the capacity is 1, `robot` is the robot that ends the window, `rank` its rank, and `source` the
    resource from which it came (`NONE`: from none).
    Of stays, `source` goes with `start`, and `end` is in order by itself. Those have rows by constraint, but for
    resources of capacity 1 in no group. A robot that moves within a group stays in it.
    """

    offset: Ints
    room: Ints
    size: Ints
    start: Ints
    end: Ints
    source: Ints
    robot: Ints
    rank: Ints
    resource: Ints
    used: Longs


class Sweep(NamedTuple):
    """The scratch of making windows again: the places in the rows of each constraint, and which windows have been made.

    Those of r have if `mark[r]` is `now[0]`.
    """

    into: Ints
    out: Ints
    mark: Longs
    now: Longs


class Robots(NamedTuple):
    """The robots; those with the same goal and pace share a `destination`, which has a guide."""

    start: Ints
    goal: Ints
    release: Ints
    pace: Ints
    destination: Ints


class Stops(NamedTuple):
    """The stops of robots with more than a goal alone: those of robot r from `first[r]` up to `first[r + 1]`.

    A stop has a place, ticks of service, and a destination, whose guide no robot with a goal alone uses; `stay[robot]`
    is what the last visit takes. The rest is scratch (`carp_optimized.queries.over_stops`): by number of stops served,
    the `slot` of the guide to the next, and the ticks from there to the goal, the `rest`; by label, of which a window
    has `stride`, `reached` and `parent` as in `Search`; by expansion, the label `expanded`, the tick at which it was
    `entered`, and the expansion from which it `came`; and the heap.
    """

    first: Ints
    place: Ints
    service: Ints
    destination: Ints
    stay: Ints
    stride: int
    slot: Ints
    rest: Longs
    reached: Longs
    parent: Ints
    expanded: Ints
    entered: Ints
    came: Ints
    keys: Longs
    ties: Longs
    labels: Ints


class Guides(NamedTuple):
    """The h of A*, made when first asked for: `ticks[slot]` is the guide of the destination `holds[slot]`.

    A guide holds, for each resource, its ticks to the goal. Until more of it is asked for, it ends `detour` of the
    longest durations behind the start of the robot that asked first; what it does not reach is `FURTHER`. The toll of
    a resource is its ticks times 2^32 plus its place in the order of (ticks to the goal, index). With t * 2^32 added it
    is the key of `query/ties` of a window entered at t: f first, then the largest g, which is the smallest h, then the
    smallest index. Where ticks times a power of two plus the index fit into 32 bits, they are the place; elsewhere it
    is kept in `rank`. The last slots to be used are the first to be given away.
    """

    ticks: IntTable
    rank: IntTable
    slot: Ints
    holds: Ints
    next: Longs
    goal: Ints
    pace: Ints
    detour: int


class WaysBack(NamedTuple):
    """The scratch of looks at ways back from a goal (`carp_optimized.queries.ways_back`).

    `looks[0]` is their number; `until` of a window is that of the look that met it last, times 2^32, plus the tick by
    which it must be entered. `keys` and `nodes` are a heap.
    """

    looks: Longs
    until: Longs
    keys: Longs
    nodes: Ints


class Search(NamedTuple):
    """The scratch of a query, never cleared: what an earlier query wrote has an earlier generation.

    `reached[slot]` is the generation times 2^32 minus the tick at which the window is entered, so that a larger
    label is an earlier entry or a newer query; `parent[slot]` is the expansion it is entered from. `keys` and `nodes`
    are the heap. `expanded`, `entered`, `ready`, `came` and `popped` list the resources that were expanded, the ticks
    at which each was entered and from which on it was left, the expansion before it on the way, and its key;
    `expansions[0]` is their number, or `UNKNOWN`. Where the robot parks, `opens[0]` is the tick at which the last
    window of its goal opens, and no expansion has an f below `least[0]`.
    """

    generation: Longs
    opens: Longs
    least: Longs
    reached: Longs
    parent: Ints
    keys: Longs
    nodes: Ints
    expanded: Ints
    entered: Ints
    ready: Ints
    came: Ints
    popped: Longs
    expansions: Longs
    back: WaysBack


class Records(NamedTuple):
    """Plans, each with its robot, its visits and what its query read.

    The visits of a record are `visits[record]` entries of `resource` and `enter` from `visits_at[record]` on; each
    ends where the next begins, the last at `leave[record]`; that begins at `arrival[record]`. `spots[record]` holds
    what bounds distances: the first tick and the arrival; what to add, for x and for y, to (goal * t - start * s) to
    have the sum of the places at all ticks from s, by the first, to t, after the arrival; x and y of the start and of
    the goal.
    The expansions are entries of `expanded`, `ready`, `until` and
    `largest` from `expansions_at[record]` on: a resource, the first and last tick at which leaving it could matter, and
    the largest key popped after it; `regions[record]` has the bits of their regions. `opens` and `least` are those of
    the search. `used` counts records, visits and expansions.
    """

    robot: Ints
    visits_at: Longs
    visits: Ints
    leave: Ints
    arrival: Ints
    expansions_at: Longs
    expansions: Ints
    regions: Longs
    opens: Ints
    least: Ints
    spots: LongTable
    resource: Ints
    enter: Ints
    expanded: Ints
    ready: Ints
    until: Ints
    largest: Longs
    used: Longs


class Freed(NamedTuple):
    """The stays taken back since a mark was set: their hull in each resource, and the resources where it can be read.

    `source` is the resource from which the robot came, `SEVERAL` if several stays were taken back.
    These entries of a resource count only where `mark` is `now[0]`. Such resources, and those that lead to one, have
    the hull of all those stays from `near_earliest` to `near_latest`, others that from `NEVER` to 0; `regions[0]` has
    the bits of their regions.
    """

    now: Longs
    mark: Longs
    earliest: Ints
    latest: Ints
    source: Ints
    near_earliest: Ints
    near_latest: Ints
    regions: Longs


class State(NamedTuple):
    """All that a compiled function may need; `reserved[robot]` is the record that the windows hold of it.

    `rank` grows in planning order when a robot is added. A query for a robot `behind` a rank takes no account of those
    of a larger rank.
    No duration is above `longest`, and none below, if they `last_alike`. The toll of a resource is its ticks to the
    goal times `scale` plus its index, if `scale` is not 0. `roots` are the terms of `neighbourhood/distance` of small
    squares; all are split after `split` bits. A place is free for `gap` ticks before another robot enters it: then
    windows begin and end so much later and earlier, and may be of negative length.
    """

    graph: Graph
    robots: Robots
    stops: Stops
    windows: Rows
    stays: Rows
    sweep: Sweep
    guides: Guides
    search: Search
    records: Records
    freed: Freed
    reserved: Ints
    rank: Ints
    counters: Longs
    longest: int
    last_alike: bool
    scale: int
    roots: Longs
    split: int
    parks: bool
    gap: int


class Work(NamedTuple):
    """The arrays for adding a robot, made once for a fleet and a size of neighbourhood.

    `queue` holds the robots in planning order, the new one last. `stream[0]` is the state of the random numbers.
    By robot: `before`, the plans followed until now; `ended`, whether they have ended by now; `held`, the plans of the
    robots outside the neighbourhood; `trajectories`, the plans by which distances are measured, and in the columns of
    `spots` what their records have under that name, so that several are compared at once; the scratch `away` and
    `near`. By position: `outside`, the robots outside the neighbourhood in planning order; the order and the plans of
    the best candidate. By place in the neighbourhood: the members, their plans `alone` against the robots outside, the
    best order of the round and its plans, and the scratch of the search for it. `rows[row_index[k]]` are the orders
    drawn, `row_key` their first places.
    """

    queue: Ints
    stream: Numbers
    before: Ints
    ended: Ints
    held: Ints
    trajectories: Ints
    spots: LongTable
    away: Longs
    near: Longs
    outside: Ints
    best_order: Ints
    best_plans: Ints
    members: Ints
    alone: Ints
    found_order: Ints
    found_plans: Ints
    order: Ints
    chosen: Ints
    least: Longs
    given: Longs
    cost: Longs
    rows: IntTable
    row_key: Longs
    row_index: Ints
    row_spare: Ints


class Polish(NamedTuple):
    """The arrays for polishing.

    `queue` holds the robots that have a plan in planning order, and `plans` the plans by robot; `counts` how many
    robots are in the queue, how many rounds are done, the generation of the marks, the chance that a round may
    raise the total, how many resources are marked, the tick by which what robots have done is kept, and how often
    records had been forgotten when `alone` was filled. `stream[0]` is the state of the random numbers. `alone[robot]`
    is the record of the plan that the robot has alone, `UNASKED` at first, `NONE` if it has no path, and `least[robot]`
    is its cost. `has_path` says how many have one, and `past[robot]` how many visits it had entered at first.
    By resource: the span of a plan, `first` to `last`, where `mark` is the generation of the marks; `marked` lists
    these resources. The candidates are in order; those that are ranked have the rank whole + rest / ticks. By place in
    the neighbourhood: the members, their plans before and their new ones. `others` is scratch by robot.
    """

    queue: Ints
    plans: Ints
    counts: Longs
    stream: Numbers
    alone: Ints
    least: Longs
    has_path: int
    past: Ints
    mark: Longs
    first: Ints
    last: Ints
    marked: Ints
    candidates: Ints
    whole: Longs
    rest: Longs
    ticks: Longs
    members: Ints
    before: Ints
    chosen: Ints
    others: Ints


class Answers(NamedTuple):
    """The answers known in a round: of a member against the set `given`, the plan `plan` (`NONE`: none exists).

    `found` is the plan's record as the query for just this answer made it: its readings depend on the set. Its cost is
    at least `least`, which is all that is known where the plan is `LATE`. Plans are numbered; `record[plan]` is the
    plan's record, `clashes[plan]` the set of plans that it clashes with, of those with which it has been `compared`.
    The answers of a member are chained from `oldest[member]` to `newest[member]` by `newer`. `read[resource]` is what
    the query summed up last read there (`carp_optimized.queries.relevant_plans`). `used` counts plans, answers, and
    queries summed up. Answers that do not fit are forgotten, which costs time alone.
    """

    record: Ints
    owner: Ints
    clashes: Longs
    compared: Longs
    given: Longs
    plan: Ints
    found: Ints
    least: Longs
    newer: Ints
    oldest: Ints
    newest: Ints
    read: LongTable
    used: Longs


class Options(NamedTuple):
    """The options of `Neighbourhood`, `sample` 0 for all orders, and the kinds of reuse that are on."""

    m: int
    sample: int
    baseline: bool
    kept: bool
    unchanged: bool
    prefixes: bool
    shared: bool
    bounds: bool


class Adding(NamedTuple):
    """All that adding a robot takes: the state, the same on the empty graph, the options, and scratch.

    One tuple in place of five has Python do less than half as much for a call.
    """

    state: State
    empty: State
    options: Options
    work: Work
    answers: Answers
