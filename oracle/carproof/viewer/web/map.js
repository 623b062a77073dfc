// The map: a still picture of the resources, above it a canvas with starts and goals, and one with all that moves.

const UNIT = 40;
const HALF_SIDE = 16;
const SMALLEST_RADIUS = [2, 3.5];
const SMALLEST_MARK = 5;
const SMALLEST_GOAL = 2;
const SMALLEST_WITH_NAME = 6;
const SIZE_OF_LENGTH = [0, 1.3, 1.1, 0.8, 0.6];
const READABLE = 0.75;
const NAME_SIZE = 9;
const WIDTH_OF_LETTER = 0.6;
const LARGEST = 4;
const LARGEST_WHOLE = 2.5;
const CLICK_DISTANCE = 4;
const glides = !matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Where a robot is drawn: it stays in the middle and moves on during the last tick of a stay; on a lane it moves along
 * it all the time, and looks ahead. */
function poseAt(stays, time) {
  const at = stayAt(stays, time);
  if (at < 0) return null;
  const [stand, enter, leave] = stays[at];
  const here = scene.stands[stand];
  const way = wayOf(stand);
  if (way) {
    const part = leave === null || !glides ? 0.5 : (time - enter) / (leave - enter);
    return { ...pointOn(way[0], way[1], part), radius: here.radius, heading: heading(way) };
  }
  const look = at ? heading(wayOf(stays[at - 1][0])) : null;
  const next = stays[at + 1];
  const there = next && next[1] === leave && !wayOf(next[0]) ? scene.stands[next[0]] : null;
  if (!here.at || !there?.at || !glides)
    return here.at && { x: here.at[0], y: here.at[1], radius: here.radius, heading: look };
  const begin = Math.max(enter, leave - 1);
  const part = Math.max(0, (time - begin) / (leave - begin));
  return { ...pointOn(here.at, there.at, part), radius: here.radius + (there.radius - here.radius) * part, heading: look };
}

/** The way of the lane in which a stand is, or null. */
function wayOf(stand) {
  return scene.places[scene.stands[stand].place].way;
}

function heading(way) {
  return way && Math.atan2(way[1][1] - way[0][1], way[1][0] - way[0][0]);
}

function pointOn(from, to, part) {
  return { x: from[0] + (to[0] - from[0]) * part, y: from[1] + (to[1] - from[1]) * part };
}

/** Where a plant is drawn small, its points have larger names, but none over another: note how large each may be. */
function giveRoom(names) {
  const found = names.map((name) => {
    const [x, y, length] = [+name.getAttribute("x"), +name.getAttribute("y"), name.textContent.length];
    const inside = (2 * Math.min(x, scene.width - x)) / (length * WIDTH_OF_LETTER);
    return { x, y, length, name, most: Math.min(4 * NAME_SIZE, inside) };
  });
  for (const one of found)
    for (const other of found)
      if (one !== other) {
        const letters = (one.length + other.length) / 2 + 1;
        const beside = Math.abs(one.x - other.x) / (letters * WIDTH_OF_LETTER);
        one.most = Math.min(one.most, Math.max(beside, Math.abs(one.y - other.y)));
      }
  for (const each of found) each.name.style.setProperty("--most-size", `${Math.floor(each.most)}px`);
}

class MapView {
  constructor(view, choose) {
    this.view = view;
    this.svg = view.querySelector("svg");
    [this.back, this.canvas] = view.querySelectorAll("canvas");
    this.dots = new Map();
    this.drawSoon = withNextFrame(() => this.draw());
    giveRoom([...this.svg.querySelectorAll(".point-name")]);
    this.colours = colours();
    this.shown = { goals: true, waits: false };
    this.chosen = [];
    this.isWhole = true;
    this.setTime(scene.first);
    new MapPointers(this, choose);
    new ResizeObserver(() => this.resize()).observe(view);
    onColours(() => {
      this.colours = colours();
      this.dots.clear();
      this.hasGoals = false;
      this.drawSoon();
    });
    this.resize();
  }

  setTime(time) {
    this.time = time;
    const isKnown = scene.now !== null && time < scene.now + 1;
    this.poses = scene.tracks.map(({ stays, done }) => poseAt(isKnown ? done : stays, time));
    this.ghosts = isKnown ? scene.tracks.map(({ stays }) => poseAt(stays, time)) : [];
    const tick = Math.floor(time);
    const half = Math.ceil(time) + tick;
    if (half !== this.half) {
      Object.assign(this, { tick, half });
      this.broken = scene.violations.filter((violation) => isBrokenAt(violation, time));
      this.blamed = new Set(this.broken.flatMap((violation) => violation.tracks));
      this.waits = null;
    }
    if (this.shown.waits) this.findWaits();
    this.follow();
    this.drawSoon();
  }

  /** Find once for each tick who waits for whom, and who does in a circle. */
  findWaits() {
    if (this.waits) return;
    this.waits = waitsAt(this.tick);
    this.circle = circular(this.waits);
  }

  choose(chosen) {
    this.chosen = chosen;
    this.hasGoals = false;
    this.drawSoon();
  }

  show(what, isShown) {
    this.shown[what] = isShown;
    this.hasGoals = false;
    this.setTime(this.time);
  }

  /** Zoom to a place so far that robots are legible there; the place comes to the middle, or stays where it was clicked. */
  focus([x, y], isKept = false) {
    const factor = Math.max(1, READABLE / this.scale);
    if (isKept) this.zoom(factor, this.px(x), this.py(y));
    else this.look(x, y, Math.max(this.scale, factor * this.scale));
  }

  /** Keep the robot that is chosen in sight, if only a part of the map is shown. */
  follow() {
    const pose = this.chosen.length === 1 && !this.isWhole ? this.poses[this.chosen[0]] : null;
    if (pose) this.reveal([pose.x, pose.y]);
  }

  /** Move the part that is shown so that the point is in it. */
  reveal([x, y]) {
    const { width, height } = this.size;
    const isSeen = this.px(x) >= 0 && this.px(x) <= width && this.py(y) >= 0 && this.py(y) <= height;
    if (!isSeen) this.look(x, y, this.scale);
  }

  zoom(factor, px = this.size.width / 2, py = this.size.height / 2) {
    const [x, y] = [this.x + px / this.scale, this.y + py / this.scale];
    const scale = this.limited(this.scale * factor);
    this.look(x + (this.size.width / 2 - px) / scale, y + (this.size.height / 2 - py) / scale, scale);
  }

  pan(dx, dy) {
    const { width, height } = this.size;
    this.look(this.x + (width / 2 + dx) / this.scale, this.y + (height / 2 + dy) / this.scale, this.scale);
  }

  fit() {
    this.look(scene.width / 2, scene.height / 2, this.leastScale());
  }

  leastScale() {
    return Math.min(LARGEST_WHOLE, this.size.width / scene.width, this.size.height / scene.height);
  }

  limited(scale) {
    return Math.min(LARGEST, Math.max(this.leastScale(), scale));
  }

  /** Show the part around a point; the map never leaves the view. */
  look(x, y, scale) {
    this.scale = this.limited(scale);
    this.isWhole = this.scale === this.leastScale();
    const [width, height] = [this.size.width / this.scale, this.size.height / this.scale];
    const within = (middle, part, all) => (part >= all ? all / 2 : Math.min(all - part / 2, Math.max(part / 2, middle)));
    this.x = within(x, width, scene.width) - width / 2;
    this.y = within(y, height, scene.height) - height / 2;
    this.svg.setAttribute("viewBox", `${this.x} ${this.y} ${width} ${height}`);
    this.svg.style.setProperty("--name-size", `${Math.round(NAME_SIZE / this.scale)}px`);
    this.view.classList.toggle("whole", this.isWhole);
    this.hasGoals = false;
    this.drawSoon();
  }

  resize() {
    const before = this.size;
    this.size = { width: Math.max(1, this.view.clientWidth), height: Math.max(1, this.view.clientHeight) };
    if (this.isWhole) this.fit();
    else this.look(this.x + before.width / 2 / this.scale, this.y + before.height / 2 / this.scale, this.scale);
    this.draw();
  }

  px(x) {
    return (x - this.x) * this.scale;
  }

  py(y) {
    return (y - this.y) * this.scale;
  }

  radius(pose) {
    const [least, enough] = SMALLEST_RADIUS;
    return Math.max(least, Math.min(enough, HALF_SIDE * 1.5 * this.scale), pose.radius * this.scale);
  }

  /** The robot that is drawn at a point of the view, or -1. */
  robotAt(px, py) {
    const distance = (pose) => Math.hypot(this.px(pose.x) - px, this.py(pose.y) - py);
    let [found, nearest] = [-1, Infinity];
    this.poses.forEach((pose, number) => {
      if (pose && distance(pose) <= Math.min(nearest, this.radius(pose) + 3))
        [found, nearest] = [number, distance(pose)];
    });
    return found;
  }

  draw() {
    if (!this.hasGoals) this.drawGoals();
    this.pen = clearedPen(this.canvas, this.size.width, this.size.height);
    this.drawViolations();
    for (const number of this.chosen) this.drawTrail(scene.tracks[number]);
    if (this.shown.waits) this.drawWaits();
    this.drawGhosts();
    this.drawRobots();
  }

  drawViolations() {
    const places = new Set(this.broken.flatMap((violation) => violation.places));
    const half = Math.max(SMALLEST_MARK, HALF_SIDE * this.scale);
    for (const place of places) {
      const { at } = scene.places[place];
      if (at)
        drawHatched(this.pen, this.colours.wrong, this.px(at[0]) - half, this.py(at[1]) - half, 2 * half, 2 * half);
    }
  }

  /** Starts as rings and goals as squares, those of chosen robots stronger; drawn only where that changes. */
  drawGoals() {
    this.hasGoals = true;
    this.pen = clearedPen(this.back, this.size.width, this.size.height);
    if (!this.shown.goals) return;
    const { pen } = this;
    Object.assign(pen, { textAlign: "center", textBaseline: "middle" });
    scene.tracks.forEach((track, number) => {
      const isChosen = this.chosen.includes(number);
      pen.globalAlpha = isChosen ? 1 : this.chosen.length ? 0.2 : this.scale < READABLE / 2 ? 0.5 : 0.85;
      pen.strokeStyle = scene.looks[track.look].hue;
      pen.fillStyle = this.colours.faint;
      pen.lineWidth = isChosen ? 3 : this.scale < READABLE ? 1.25 : 2;
      if (track.start_mark) this.drawMark(track.start_mark, track.short, (x, y, half) => this.ring(x, y, half));
      if (track.goal_mark)
        this.drawMark(track.goal_mark, track.short, (x, y, half) => pen.strokeRect(x - half, y - half, 2 * half, 2 * half));
      for (const mark of track.stop_marks) this.drawMark(mark, track.short, (x, y, half) => this.diamond(x, y, half));
    });
    pen.globalAlpha = 1;
  }

  /** The mark of a start or a goal, with the robot's name where there is room for it. */
  drawMark(mark, short, outline) {
    const [x, y, half] = [this.px(mark.x), this.py(mark.y), Math.max(SMALLEST_GOAL, mark.half * this.scale)];
    outline(x, y, half);
    if (half <= SMALLEST_WITH_NAME) return;
    this.pen.font = `${Math.round(0.8 * half * SIZE_OF_LENGTH[Math.min(short.length, 4)])}px system-ui, sans-serif`;
    this.pen.fillText(short, x, y + 0.5);
  }

  diamond(x, y, half) {
    trace(this.pen, [[x, y - half], [x + half, y], [x, y + half], [x - half, y]]);
    this.pen.closePath();
    this.pen.stroke();
  }

  ring(x, y, radius) {
    this.pen.beginPath();
    this.pen.arc(x, y, radius, 0, 2 * Math.PI);
    this.pen.stroke();
  }

  drawTrail({ stays }) {
    const points = stays.map(([stand]) => scene.stands[stand].at).filter((at) => at);
    trace(this.pen, points.map(([x, y]) => [this.px(x), this.py(y)]));
    Object.assign(this.pen, { strokeStyle: this.colours.ink, lineWidth: 2.5, lineJoin: "round", globalAlpha: 0.7 });
    this.pen.stroke();
    this.pen.globalAlpha = 1;
  }

  /** Arrows from robots that wait to those that they wait for; those of a circle are red. */
  drawWaits() {
    for (const wait of this.waits) {
      const [from, to] = wait.map((number) => this.poses[number]);
      const isOfChosen = !this.chosen.length || wait.some((number) => this.chosen.includes(number));
      this.pen.globalAlpha = isOfChosen ? 0.9 : 0.2;
      if (from && to) this.arrow(from, to, this.circle.has(wait) ? this.colours.wrong : this.colours.ink);
    }
    this.pen.globalAlpha = 1;
  }

  arrow(from, to, colour) {
    const { pen } = this;
    const angle = Math.atan2(to.y - from.y, to.x - from.x);
    const [x, y, gap] = [this.px(to.x), this.py(to.y), this.radius(to)];
    const at = (distance, side) => [
      x - distance * Math.cos(angle) - side * Math.sin(angle),
      y - distance * Math.sin(angle) + side * Math.cos(angle),
    ];
    Object.assign(pen, { strokeStyle: colour, fillStyle: colour, lineWidth: 2 });
    trace(pen, [[this.px(from.x), this.py(from.y)], at(gap + 4, 0)]);
    pen.stroke();
    trace(pen, [at(gap, 0), at(gap + 8, 4), at(gap + 8, -4)]);
    pen.fill();
  }

  /** Where robots would be by their plans, where that is not where they are. */
  drawGhosts() {
    const { pen } = this;
    pen.setLineDash([3, 3]);
    this.ghosts.forEach((ghost, number) => {
      const pose = this.poses[number];
      if (!ghost || (pose && pose.x === ghost.x && pose.y === ghost.y)) return;
      pen.globalAlpha = this.chosen.length && !this.chosen.includes(number) ? 0.2 : 1;
      Object.assign(pen, { strokeStyle: scene.looks[scene.tracks[number].look].hue, lineWidth: 2 });
      this.ring(this.px(ghost.x), this.py(ghost.y), this.radius(ghost));
      if (!pose) return;
      trace(pen, [pose, ghost].map(({ x, y }) => [this.px(x), this.py(y)]));
      pen.stroke();
    });
    pen.setLineDash([]);
    pen.globalAlpha = 1;
  }

  /** The picture of a robot that is too small for a name, drawn once for each size. */
  dot(number, half) {
    const key = `${number} ${half.toFixed(1)}`;
    const look = scene.looks[number];
    if (!this.dots.has(key)) {
      const canvas = make("canvas");
      const pen = clearedPen(canvas, 2 * half, 2 * half);
      Object.assign(pen, { fillStyle: look.fill, strokeStyle: look.edge });
      pen.arc(half, half, half - 1, 0, 2 * Math.PI);
      pen.fill();
      pen.stroke();
      this.dots.set(key, canvas);
    }
    return this.dots.get(key);
  }

  /** The tip that shows where a robot is heading. */
  drawNose(x, y, radius, angle, colour) {
    const { pen } = this;
    const at = (distance, turn) => [x + distance * Math.cos(angle + turn), y + distance * Math.sin(angle + turn)];
    pen.fillStyle = colour;
    trace(pen, [at(1.5 * radius, 0), at(radius, 0.5), at(radius, -0.5)]);
    pen.fill();
  }

  drawRobots() {
    const { pen } = this;
    const { width, height } = this.size;
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    this.poses.forEach((pose, number) => {
      if (!pose) return;
      const [x, y, radius] = [this.px(pose.x), this.py(pose.y), this.radius(pose)];
      if (x < -radius || y < -radius || x > width + radius || y > height + radius) return;
      const { look: kind, short } = scene.tracks[number];
      const look = scene.looks[kind];
      const isChosen = this.chosen.includes(number);
      const isBlamed = this.blamed.has(number);
      pen.globalAlpha = this.chosen.length && !isChosen ? 0.45 : 1;
      if (radius < SMALLEST_WITH_NAME && !isChosen && !isBlamed) {
        const half = radius + 1;
        pen.drawImage(this.dot(kind, half), x - half, y - half, 2 * half, 2 * half);
        return;
      }
      if (typeof pose.heading === "number") this.drawNose(x, y, radius, pose.heading, look.edge);
      if (scene.tracks[number].services.some(([start, end]) => holds(start, end, this.time))) {
        Object.assign(pen, { strokeStyle: this.colours.accent, lineWidth: 2 });
        this.ring(x, y, 1.4 * radius);
      }
      pen.fillStyle = look.fill;
      pen.beginPath();
      pen.arc(x, y, radius, 0, 2 * Math.PI);
      pen.fill();
      pen.strokeStyle = isChosen ? this.colours.ink : isBlamed ? this.colours.wrong : look.edge;
      pen.lineWidth = isChosen || isBlamed ? 3 : look.width;
      pen.stroke();
      if (radius < SMALLEST_WITH_NAME) return;
      pen.font = `600 ${Math.round(radius * SIZE_OF_LENGTH[Math.min(short.length, 4)])}px system-ui, sans-serif`;
      pen.fillStyle = look.text;
      pen.fillText(short, x, y + 0.5);
    });
    pen.globalAlpha = 1;
  }
}

/** The pointers on the map: one moves it or chooses a robot, two enlarge it, and so does the wheel. */
class MapPointers {
  constructor(map, choose) {
    Object.assign(this, { map, choose, down: new Map(), isMoved: false });
    const { view } = map;
    view.addEventListener("pointerdown", (event) => this.press(event));
    view.addEventListener("pointermove", (event) => this.move(event));
    for (const kind of ["pointerup", "pointercancel"]) view.addEventListener(kind, (event) => this.lift(event, kind));
    view.addEventListener("wheel", (event) => this.turn(event), { passive: false });
  }

  point({ clientX, clientY }) {
    const { left, top } = this.map.view.getBoundingClientRect();
    return { x: clientX - left, y: clientY - top };
  }

  press(event) {
    if (!this.down.size) this.isMoved = false;
    this.down.set(event.pointerId, { ...this.point(event), from: this.point(event) });
    if (event.isTrusted) this.map.view.setPointerCapture(event.pointerId);
  }

  move(event) {
    const before = this.down.get(event.pointerId);
    if (!before) return;
    const now = this.point(event);
    const other = [...this.down].find(([id]) => id !== event.pointerId)?.[1];
    this.isMoved ||= Boolean(other) || Math.hypot(now.x - before.from.x, now.y - before.from.y) > CLICK_DISTANCE;
    if (!this.isMoved) return;
    this.down.set(event.pointerId, { ...before, ...now });
    if (other) this.pinch(before, now, other);
    else this.map.pan(before.x - now.x, before.y - now.y);
  }

  /** One of two pointers moved: their middle stays above the same point of the map. */
  pinch(before, now, other) {
    const apart = (one) => Math.max(1, Math.hypot(one.x - other.x, one.y - other.y));
    this.map.pan((before.x - now.x) / 2, (before.y - now.y) / 2);
    this.map.zoom(apart(now) / apart(before), (now.x + other.x) / 2, (now.y + other.y) / 2);
  }

  lift(event, kind) {
    const isClick = this.down.delete(event.pointerId) && kind === "pointerup" && !this.isMoved;
    if (!isClick) return;
    const { x, y } = this.point(event);
    const robot = this.map.robotAt(x, y);
    this.choose(robot < 0 ? [] : [robot]);
  }

  turn(event) {
    event.preventDefault();
    const { x, y } = this.point(event);
    this.map.zoom(Math.exp(-Math.sign(event.deltaY) * Math.min(0.25, Math.abs(event.deltaY) / 400)), x, y);
  }
}
