"""Turns: robots that cross one resource are planned in the order in which they cross it, changed a little by draws.

So on a tree one direction can go before the other. Of 16 robots in a drawn order hardly any could be planned as well as
before.
"""

from carp_optimized.draws import choice
from carp_optimized.jit.compiling import compiled
from carp_optimized.jit.kinds import Ints, Longs, Numbers
from carp_optimized.neighbourhood.candidates import crossing
from carp_optimized.state.arrays import NONE, Polish, State

PIVOTS_WAY, OTHER_WAYS, DRAWN = range(3)  # the robots that go first, of four choices; else none does
NOISE = 16  # ticks by which robots may change places
AFTER = 1 << 40  # more than any tick


@compiled
def draw_turns(state: State, polish: Polish, size: int, chosen: int) -> None:
    """Order the members by their crossings: those of one direction first, or a drawn half, or with drawn delays."""
    own = way_after(state, int(polish.plans[polish.members[0]]), chosen)
    leaders = choice(polish.stream, 4)
    noise = 1 + choice(polish.stream, 2) * (NOISE - 1)
    for k in range(size):
        record = int(polish.plans[polish.members[k]])
        visit = crossing(state, record, chosen)
        enter = int(state.records.enter[visit])
        is_own = way_after(state, record, visit) == own
        put_in_turn(polish.stream, polish.members, polish.whole, k, enter, is_own, leaders, noise)


@compiled
def put_in_turn(
    stream: Numbers, members: Ints, keys: Longs, k: int, tick: int, is_own: bool, leaders: int, noise: int
) -> None:
    """Put member k, which crosses at the tick, among those before it: those that lead first, each with a drawn delay.

    Its way is the pivot's own, or not.
    """
    robot = int(members[k])
    key = tick + choice(stream, noise)
    if (
        (leaders == PIVOTS_WAY and not is_own)
        or (leaders == OTHER_WAYS and is_own)
        or (leaders == DRAWN and choice(stream, 2) == 0)
    ):
        key += AFTER
    place = k
    while place > 0 and keys[place - 1] > key:
        keys[place] = keys[place - 1]
        members[place] = members[place - 1]
        place -= 1
    keys[place] = key
    members[place] = robot


@compiled
def way_after(state: State, record: int, visit: int) -> int:
    """The resource that the plan goes to after the visit; `NONE` after its last."""
    records = state.records
    last = int(records.visits_at[record]) + int(records.visits[record]) - 1
    return int(records.resource[visit + 1]) if visit < last else NONE
