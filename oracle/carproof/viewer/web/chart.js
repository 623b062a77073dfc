// The chart of resources by time, on a canvas as large as its window: only what is in sight is drawn.

const LANE = 13;
const LANE_DONE = 6;
const GAP = 4;
const LABELS = 16 + 7 * Math.max(6, ...scene.places.map(({ name }) => name.length));
const AXIS = 22;
const TEXT_WIDTH = 7;
const LEAST_LABEL_DISTANCE = 46;
const WIDEST_TICK = 80;
const NARROWEST_TICK = 12;
const ROUND_STEPS = [...Array(9).keys()].flatMap((power) => [1, 2, 5].map((digit) => digit * 10 ** power));

class Chart {
  constructor(view, size, canvas, pick) {
    Object.assign(this, { view, size, canvas });
    this.drawSoon = withNextFrame(() => this.draw());
    this.chosen = [];
    this.time = scene.first;
    this.end = scene.last + Math.max(1, (scene.last - scene.first) / 40);
    this.colours = colours();
    this.stays = visitsByPlace((track) => track.stays);
    this.done = visitsByPlace((track) => track.done, scene.now + 1);
    this.violations = scene.places.map(() => []);
    for (const violation of scene.violations) {
      if (violation.start !== null) for (const place of violation.places) this.violations[place].push(violation);
    }
    this.showRows("visited");
    view.addEventListener("scroll", () => this.drawSoon());
    canvas.addEventListener("click", (event) => this.pick(event, pick));
    new ResizeObserver(() => this.resize()).observe(view);
    onColours(() => {
      this.colours = colours();
      this.drawSoon();
    });
  }

  /** Show the rows of all resources, of those visited, or of those that the chosen robots visit, robot by robot. */
  showRows(which) {
    this.which = which;
    const everyPlace = scene.places.map((_, place) => place);
    const visitedBy = ({ stays, done }) => [...stays, ...done].map(([stand]) => scene.stands[stand].place);
    const visited = [...new Set(scene.tracks.flatMap(visitedBy))];
    const selected = [...new Set(this.chosen.flatMap((number) => visitedBy(scene.tracks[number])))];
    const places = { all: everyPlace, visited, selected }[which];
    let top = AXIS;
    this.rows = places.map((place) => {
      const { lanes, lanes_done: done } = scene.places[place];
      const row = { place, top, height: lanes * LANE + done * LANE_DONE };
      top += row.height + GAP;
      return row;
    });
    this.height = top;
    this.resize();
  }

  choose(chosen) {
    this.chosen = chosen;
    if (this.which === "selected") this.showRows("selected");
    this.drawSoon();
  }

  resize() {
    const room = Math.max(1, this.view.clientWidth - LABELS - 4 * GAP);
    this.least = room / (this.end - scene.first);
    this.pixels = Math.max(this.least, Math.min(this.pixels ?? NARROWEST_TICK, WIDEST_TICK));
    this.size.style.width = `${LABELS + this.pixels * (this.end - scene.first)}px`;
    this.size.style.height = `${this.height}px`;
    this.draw();
  }

  zoom(factor) {
    const middle = (this.view.scrollLeft + this.view.clientWidth / 2) / this.pixels;
    this.pixels *= factor;
    this.resize();
    this.view.scrollLeft = middle * this.pixels - this.view.clientWidth / 2;
  }

  x(tick) {
    return LABELS + (tick - scene.first) * this.pixels - this.view.scrollLeft;
  }

  /** Show the time, and keep its line in sight. */
  setTime(time, follow) {
    this.time = time;
    const x = this.x(time);
    if (follow && (x < LABELS || x > this.view.clientWidth - 20)) this.view.scrollLeft += x - LABELS - 40;
    this.drawSoon();
  }

  /** Scroll to the row of a place; if it is not among the rows, show all. */
  reveal(place) {
    if (!this.rows.some((row) => row.place === place)) return false;
    const { top, height } = this.rows.find((row) => row.place === place);
    const { scrollTop, clientHeight } = this.view;
    if (top - AXIS < scrollTop || top + height > scrollTop + clientHeight) this.view.scrollTop = top - clientHeight / 2;
    return true;
  }

  draw() {
    const { clientWidth: width, clientHeight: height, scrollTop } = this.view;
    this.canvas.style.width = `${width}px`;
    this.canvas.style.height = `${height}px`;
    this.pen = clearedPen(this.canvas, width, height);
    this.pen.textBaseline = "middle";
    this.pen.font = "11px system-ui, sans-serif";
    this.fill(this.colours.paper, 0, 0, width, height);
    this.drawGrid(width, height);
    const inSight = this.rows.filter((row) => row.top + row.height > scrollTop && row.top < scrollTop + height);
    for (const row of inSight) this.drawRow(row, row.top - scrollTop, width);
    if (scene.now !== null) this.fill(this.colours.accent, Math.round(this.x(scene.now + 1)), 0, 1, height);
    const now = Math.round(this.x(this.time)) + 0.5;
    this.fill(this.colours.ink, now - 1, 0, 2, height);
    this.drawLabels(inSight, scrollTop, height);
    this.drawAxis(width);
    if (!this.rows.length) this.drawHint();
  }

  drawHint() {
    this.pen.fillStyle = this.colours.faint;
    this.pen.textAlign = "left";
    this.pen.fillText("No row: choose a robot that has a plan, or other rows.", LABELS + 8, 2 * AXIS);
  }

  fill(colour, x, y, width, height) {
    this.pen.fillStyle = colour;
    this.pen.fillRect(x, y, width, height);
  }

  /** The part of an interval that is in sight, as left side and width, or null. */
  span(start, end, width) {
    const left = Math.max(LABELS - 2, this.x(start));
    const right = Math.min(width + 2, end === null ? width + 2 : this.x(end));
    return right < LABELS || left > width ? null : [left, Math.max(2, right - left)];
  }

  /** A row: the visits as planned above the free windows, and below them, thinner, those that have happened. */
  drawRow({ place, height }, top, width) {
    const planned = scene.places[place].lanes * LANE;
    for (const [start, end] of scene.places[place].windows) {
      const part = this.span(start, end, width);
      if (part) this.fill(this.colours.window, part[0], top, part[1], planned);
    }
    for (const stay of this.stays[place]) this.drawStay(stay, top + stay.lane * LANE, LANE, width);
    for (const stay of this.done[place])
      this.drawStay(stay, top + planned + stay.lane * LANE_DONE, LANE_DONE, width);
    for (const { start, end } of this.violations[place]) {
      const part = this.span(start, end, width);
      if (part) drawHatched(this.pen, this.colours.wrong, part[0], top, part[1], height);
    }
  }

  drawStay({ number, enter, leave }, y, high, width) {
    const part = this.span(enter, leave, width);
    if (!part) return;
    const [left, wide] = part;
    const { look: kind, short } = scene.tracks[number];
    const look = scene.looks[kind];
    const isChosen = this.chosen.includes(number);
    this.pen.globalAlpha = this.chosen.length && !isChosen ? 0.35 : 1;
    this.fill(look.edge, left, y + 1, Math.max(1, wide - 1), high - 2);
    if (wide > 4) this.fill(look.fill, left + 1, y + 2, wide - 3, high - 4);
    if (high === LANE) this.drawServices(number, enter, y, high, width);
    if (high === LANE && wide > short.length * TEXT_WIDTH + 2) {
      this.pen.fillStyle = look.text;
      this.pen.textAlign = "center";
      this.pen.fillText(short, left + wide / 2, y + high / 2 + 0.5);
    }
    this.pen.globalAlpha = 1;
    if (isChosen) {
      this.pen.strokeStyle = this.colours.ink;
      this.pen.lineWidth = 2;
      this.pen.strokeRect(left, y + 1, Math.max(1, wide - 1), high - 2);
    }
  }

  /** A line below a bar while the robot serves a stop. */
  drawServices(number, enter, y, high, width) {
    for (const [start, end] of scene.tracks[number].services) {
      const part = start === enter ? this.span(start, end, width) : null;
      if (part) this.fill(this.colours.accent, part[0], y + high - 3, part[1], 2);
    }
  }

  drawLabels(rows, scrollTop, height) {
    this.fill(this.colours.panel, 0, 0, LABELS - 3, height);
    this.pen.textAlign = "right";
    this.pen.fillStyle = this.colours.ink;
    for (const { place, top, height: rowHeight } of rows) {
      this.pen.fillText(scene.places[place].name, LABELS - 8, top - scrollTop + rowHeight / 2, LABELS - 12);
    }
  }

  /** Round ticks in sight, far enough from each other and from the last one, which is among them. */
  roundTicks(width) {
    const step = ROUND_STEPS.find((each) => each * this.pixels >= LEAST_LABEL_DISTANCE);
    const from = scene.first + this.view.scrollLeft / this.pixels;
    const to = Math.min(this.end, from + (width - LABELS) / this.pixels);
    const ticks = [];
    for (let tick = Math.ceil(from / step) * step; tick <= to; tick += step) ticks.push(tick);
    return [...ticks.filter((tick) => (scene.last - tick) * this.pixels >= LEAST_LABEL_DISTANCE), scene.last];
  }

  drawGrid(width, height) {
    for (const tick of this.roundTicks(width)) this.fill(this.colours.line, Math.round(this.x(tick)), 0, 1, height);
  }

  drawAxis(width) {
    this.fill(this.colours.panel, 0, 0, width, AXIS - 3);
    this.pen.fillStyle = this.colours.faint;
    this.pen.textAlign = "center";
    for (const tick of this.roundTicks(width)) this.pen.fillText(tick, Math.round(this.x(tick)), AXIS / 2 - 1);
    this.fill(this.colours.panel, 0, 0, LABELS - 3, AXIS - 3);
    this.pen.fillStyle = this.colours.faint;
    this.pen.textAlign = "right";
    this.pen.fillText("tick", LABELS - 8, AXIS / 2 - 1);
  }

  pick(event, pick) {
    const { offsetX, offsetY } = event;
    const tick = Math.floor(scene.first + (offsetX - LABELS + this.view.scrollLeft) / this.pixels);
    const y = offsetY + this.view.scrollTop;
    const row = this.rows.find(({ top, height }) => top <= y && y < top + height);
    const lane = row && Math.floor((y - row.top) / LANE);
    const stay =
      row && this.stays[row.place].findLast((each) => each.lane === lane && holds(each.enter, each.leave, tick));
    if (offsetX >= LABELS) pick(tick, stay ? [stay.number] : null);
  }
}
