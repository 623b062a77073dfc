// The map: moves the robots that Python drew, marks what is broken, shows the trail of the chosen robots.

const ROBOT_RADIUS = 10;
const HALF_SIDE = 16;
const SMALLEST_TEXT = 5;
const CLICK_DISTANCE = 4;
const glides = !matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Where a robot is drawn: it stays in the middle and moves on during the last tick of a stay. */
function poseAt(track, time) {
  const at = stayAt(track, time);
  if (at < 0) return null;
  const [stand, enter, leave] = track.stays[at];
  const here = scene.stands[stand];
  const next = track.stays[at + 1];
  const there = next && next[1] === leave ? scene.stands[next[0]] : null;
  if (!here.at || !there?.at || !glides) return here.at && { x: here.at[0], y: here.at[1], radius: here.radius };
  const begin = Math.max(enter, leave - 1);
  const part = Math.max(0, (time - begin) / (leave - begin));
  const between = (from, to) => from + (to - from) * part;
  return {
    x: between(here.at[0], there.at[0]),
    y: between(here.at[1], there.at[1]),
    radius: between(here.radius, there.radius),
  };
}

class MapView {
  constructor(svg, choose) {
    this.svg = svg;
    this.whole = { x: 0, y: 0, width: scene.width, height: scene.height };
    this.shown = { ...this.whole };
    [this.marks, this.trail, this.robotLayer] = ["marks", "trail", "robots"].map((kind) =>
      svg.querySelector(`.${kind}`),
    );
    this.robots = [...this.robotLayer.children];
    this.robots.forEach((robot, number) => (robot.dataset.number = number));
    this.listenToPointer(choose);
    new ResizeObserver(() => this.showPart()).observe(svg);
  }

  draw(time, chosen) {
    this.robots.forEach((robot, number) => {
      const pose = poseAt(scene.tracks[number], time);
      robot.style.display = pose ? "" : "none";
      if (!pose) return;
      robot.setAttribute("transform", `translate(${pose.x} ${pose.y}) scale(${pose.radius / ROBOT_RADIUS})`);
      robot.classList.toggle("chosen", chosen.includes(number));
    });
    this.robotLayer.classList.toggle("dimmed", chosen.length > 0);
    this.drawMarks(Math.floor(time));
  }

  drawMarks(tick) {
    if (tick === this.markedTick) return;
    this.markedTick = tick;
    const broken = scene.violations.filter((violation) => isBrokenAt(violation, tick));
    const places = new Set(broken.map((violation) => violation.place));
    const blamed = new Set(broken.flatMap((violation) => violation.tracks));
    const boxes = [...places].filter((place) => place !== null && scene.places[place].at);
    this.marks.replaceChildren(...boxes.map((place) => this.box(place, "violation")));
    this.robots.forEach((robot, number) => robot.classList.toggle("blamed", blamed.has(number)));
  }

  box(place, kind) {
    const [x, y] = scene.places[place].at;
    const size = 2 * HALF_SIDE;
    return makeDrawn("rect", { class: kind, x: x - HALF_SIDE, y: y - HALF_SIDE, width: size, height: size });
  }

  drawTrail(chosen) {
    this.trail.replaceChildren();
    for (const number of chosen) {
      const { stays, goal } = scene.tracks[number];
      const points = stays.map(([stand]) => scene.stands[stand].at).filter((at) => at);
      if (points.length) this.trail.append(makeDrawn("path", { d: `M${points.map((at) => at.join(" ")).join("L")}` }));
      if (goal !== null && scene.places[goal].at) {
        const [x, y] = scene.places[goal].at;
        const size = 2 * HALF_SIDE;
        const corner = `M${x - HALF_SIDE} ${y - HALF_SIDE}`;
        this.trail.append(makeDrawn("path", { class: "goal", d: `${corner}h${size}v${size}h${-size}z` }));
      }
    }
  }

  /** Move the part that is shown so that the point is in it. */
  reveal([x, y]) {
    const { x: left, y: top, width, height } = this.shown;
    if (x < left || x > left + width || y < top || y > top + height) {
      this.shown = { ...this.shown, x: x - width / 2, y: y - height / 2 };
      this.showPart();
    }
  }

  zoom(factor, x = this.shown.x + this.shown.width / 2, y = this.shown.y + this.shown.height / 2) {
    const { shown, whole } = this;
    const width = Math.min(whole.width, Math.max(4 * HALF_SIDE, shown.width / factor));
    const scale = width / shown.width;
    const moved = { x: x - (x - shown.x) * scale, y: y - (y - shown.y) * scale, width, height: shown.height * scale };
    this.shown = width === whole.width ? { ...whole } : moved;
    this.showPart();
  }

  fit() {
    this.shown = { ...this.whole };
    this.showPart();
  }

  showPart() {
    const { x, y, width, height } = this.shown;
    this.svg.setAttribute("viewBox", `${x} ${y} ${width} ${height}`);
    this.robotLayer.classList.toggle("tiny", ROBOT_RADIUS * this.pixelsPerUnit() < SMALLEST_TEXT);
  }

  pixelsPerUnit() {
    const { width, height } = this.svg.getBoundingClientRect();
    return Math.min(width / this.shown.width, height / this.shown.height);
  }

  listenToPointer(choose) {
    let from = null;
    this.svg.addEventListener("pointerdown", (event) => {
      from = { x: event.clientX, y: event.clientY, shown: { ...this.shown }, moved: false };
    });
    this.svg.addEventListener("pointermove", (event) => {
      if (!from || event.pointerType === "touch") return;
      const [dx, dy] = [event.clientX - from.x, event.clientY - from.y];
      from.moved ||= Math.hypot(dx, dy) > CLICK_DISTANCE;
      const scale = this.pixelsPerUnit();
      if (from.moved) this.shown = { ...from.shown, x: from.shown.x - dx / scale, y: from.shown.y - dy / scale };
      if (from.moved) this.showPart();
    });
    addEventListener("pointerup", () => setTimeout(() => (from = null)));
    this.svg.addEventListener("click", (event) => {
      if (from?.moved) return;
      const robot = event.target.closest(".robot");
      choose(robot ? [Number(robot.dataset.number)] : []);
    });
    this.svg.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        const point = new DOMPoint(event.clientX, event.clientY).matrixTransform(this.svg.getScreenCTM().inverse());
        this.zoom(event.deltaY < 0 ? 1.25 : 0.8, point.x, point.y);
      },
      { passive: false },
    );
  }
}
