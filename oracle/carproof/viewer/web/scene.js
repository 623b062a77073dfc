// The scene as Python wrote it (carproof.viewer.scene), and small helpers. All text goes in as text, never as HTML.

const byId = (id) => document.getElementById(id);
const scene = JSON.parse(byId("scene").textContent);

/** Stays that begin in their order and do not overlap, as all have in sound plans: those are searched by halves. */
const ordered = new WeakSet(
  scene.tracks
    .flatMap(({ stays, done }) => [stays, done])
    .filter((stays) => stays.every(([, enter], at) => !at || (stays[at - 1][2] ?? Infinity) <= enter)),
);

function make(tag, className, text) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
}

/** An entry of a list that can be clicked. */
function entry(text, action) {
  const button = make("button", "", text);
  button.type = "button";
  button.addEventListener("click", action);
  return button;
}

/** An open group of entries below a name and their number. */
function groupOf(name, count, ...content) {
  const group = make("details");
  group.open = true;
  const summary = make("summary", "", `${name} `);
  summary.append(make("span", "count", count));
  group.append(summary, ...content);
  return group;
}

/** Whether the time is in [start, end); an end of null is for ever. */
function holds(start, end, time) {
  return start <= time && (end === null || time < end);
}

/** The index of the stay at the time, or -1: of several in a broken plan the last. */
function stayAt(stays, time) {
  if (!ordered.has(stays)) return stays.findLastIndex(([, enter, leave]) => holds(enter, leave, time));
  let [low, high] = [0, stays.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (stays[middle][1] <= time) low = middle + 1;
    else high = middle;
  }
  return low && holds(stays[low - 1][1], stays[low - 1][2], time) ? low - 1 : -1;
}

/** Whether the violation is to be seen at the time; one that takes no time is seen for one tick, an exchange also during
 * the move before. */
function isBrokenAt(violation, time) {
  const { start, end, places } = violation;
  if (start === null) return false;
  if (places.length > 1 && start - 1 < time && time < start) return true;
  return holds(start, end === null ? null : Math.max(end, start + 1), Math.floor(time));
}

/** Each place's visits of a kind: the robot's number, the visit's, its lane and ticks; what is for ever ends as told. */
function visitsByPlace(visitsOf, end = null) {
  const found = scene.places.map(() => []);
  scene.tracks.forEach((track, number) => {
    visitsOf(track).forEach(([stand, enter, leave], visit) => {
      const { place, lane } = scene.stands[stand];
      found[place].push({ number, visit, lane, enter, leave: leave ?? end });
    });
  });
  return found;
}

function interval(enter, leave) {
  return `[${enter}, ${leave === null ? "for ever" : leave})`;
}

function counted(count, word) {
  return `${count} ${word}${count === 1 ? "" : "s"}`;
}

/** The colours of the style sheets, for canvases. */
function colours() {
  const style = getComputedStyle(document.documentElement);
  const named = (name) => style.getPropertyValue(`--${name}`).trim();
  const plain = ["paper", "panel", "ink", "faint", "line", "window", "wrong", "accent"];
  return Object.fromEntries(plain.map((name) => [name, named(name)]));
}

/** Do something whenever the page turns dark or light. */
function onColours(action) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", action);
}

/** What draws with the next frame, once however often it is asked for. */
function withNextFrame(draw) {
  let waiting;
  return () => {
    waiting ??= requestAnimationFrame(() => {
      waiting = undefined;
      draw();
    });
  };
}

/** Make a canvas as large as its box, if it is not, and clear it; sizes are in the page's pixels from then on. */
function clearedPen(canvas, width, height) {
  const pen = canvas.getContext("2d");
  const [wide, high] = [Math.round(width * devicePixelRatio), Math.round(height * devicePixelRatio)];
  if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
  pen.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return pen;
}

/** Begin a path through the points. */
function trace(pen, points) {
  pen.beginPath();
  for (const [x, y] of points) pen.lineTo(x, y);
}

/** The hatched frame of a violation. */
function drawHatched(pen, colour, left, top, width, height) {
  pen.save();
  pen.strokeStyle = colour;
  pen.lineWidth = 2;
  pen.beginPath();
  pen.rect(left, top, width, height);
  pen.stroke();
  pen.clip();
  pen.beginPath();
  for (let x = left - height; x < left + width; x += 5) {
    pen.moveTo(x, top + height);
    pen.lineTo(x + height, top);
  }
  pen.lineWidth = 1;
  pen.stroke();
  pen.restore();
}
