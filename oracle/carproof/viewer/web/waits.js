// Who waits for whom, if robots keep the order of the plans: the dependencies between robots that hold at a tick.

/** The visits of each place by the plans. */
const visitsOf = visitsByPlace((track) => track.stays, Infinity);

/** The stays that robots make: what has happened, or without a trace what is planned. */
function madeBy({ stays, done }) {
  return scene.now === null ? stays : done;
}

/** Pairs of robots: the first enters its next place only when the second has left the place. */
function waitsAt(time) {
  const hasLeft = ({ number, visit }) => (madeBy(scene.tracks[number])[visit]?.[2] ?? Infinity) <= time;
  return scene.tracks.flatMap((track, number) => {
    const at = stayAt(madeBy(track), time);
    const next = track.stays[at + 1];
    if (at < 0 || !next) return [];
    const before = visitsOf[scene.stands[next[0]].place].filter(
      (other) => other.number !== number && other.leave + scene.gap <= next[1] && !hasLeft(other),
    );
    const latest = Math.max(...before.map((other) => other.enter));
    return before.filter((other) => other.leave > latest).map((other) => [number, other.number]);
  });
}

/** The pairs that are in a circle or between two. */
function circular(waits) {
  for (;;) {
    const [waiting, awaited] = [0, 1].map((side) => new Set(waits.map((wait) => wait[side])));
    const left = waits.filter(([one, other]) => awaited.has(one) && waiting.has(other));
    if (left.length === waits.length) return new Set(waits);
    waits = left;
  }
}
