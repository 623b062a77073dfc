// Wires the parts of the page together.

const clock = new Clock(scene.first, scene.last);
const STEP = 80;
const WIDE = 1.7;
const state = { chosen: [], violation: null };

/** Panels without content take no room, and a wide map gets most of the width. */
function arrange() {
  byId("chart-panel").hidden = !scene.tracks.some(({ stays, done }) => stays.length || done.length);
  byId("violations-panel").hidden = !scene.rules.length;
  byId("robots-panel").hidden = !scene.tracks.length;
  byId("lists").hidden = !scene.rules.length && !scene.tracks.length;
  byId("map-view").style.setProperty("--aspect", `${scene.width} / ${scene.height}`);
  document.body.classList.toggle("wide", scene.width > WIDE * scene.height);
  document.body.classList.toggle("no-chart", byId("chart-panel").hidden);
  document.body.classList.toggle("no-lists", byId("lists").hidden);
  document.body.classList.toggle("alone", scene.alone);
}

arrange();
const map = new MapView(byId("map-view"), chooseOnMap);
const chart = new Chart(byId("chart-view"), byId("chart-size"), byId("chart"), (tick, chosen) => {
  clock.stopAt(tick);
  if (chosen) choose(chosen);
});
const violations = new ViolationList(byId("violations"), jumpToViolation);
const robots = new RobotList(byId("robots"), jumpToRobot);

function choose(chosen, violation = null) {
  Object.assign(state, { chosen, violation });
  map.choose(chosen);
  chart.choose(chosen);
  robots.show(chosen);
  violations.show(violation);
  draw();
}

function chooseOnMap(chosen) {
  choose(chosen);
  const pose = map.poses[chosen[0]];
  if (pose) map.focus([pose.x, pose.y], true);
}

/** Choose a robot, go to a tick at which it is on the map, and zoom to it, or to its start if it has no plan. */
function jumpToRobot(number) {
  const { stays, start } = scene.tracks[number];
  choose([number]);
  if (stays.length && stayAt(stays, clock.time) < 0) clock.stopAt(stays[0][1]);
  const stay = stays[Math.max(0, stayAt(stays, clock.time))];
  const place = stay ? scene.stands[stay[0]].place : start;
  const { x, y } = map.poses[number] ?? {};
  const at = x === undefined ? scene.places[place]?.at : [x, y];
  if (at) map.focus(at);
  if (stay) revealInChart(place);
}

function jumpToViolation(violation) {
  choose(violation.tracks, violation);
  if (violation.start !== null) clock.stopAt(violation.start);
  const [place] = violation.places;
  if (place === undefined) return;
  if (scene.places[place].at) map.focus(scene.places[place].at);
  revealInChart(place);
}

function nextViolation(step) {
  const count = scene.violations.length;
  const at = scene.violations.indexOf(state.violation);
  if (count) jumpToViolation(scene.violations[at < 0 ? (step > 0 ? 0 : count - 1) : (at + step + count) % count]);
}

function nextRobot(step) {
  const count = scene.tracks.length;
  const at = state.chosen.length ? state.chosen[0] : step > 0 ? -1 : count;
  if (count) jumpToRobot(Math.min(count - 1, Math.max(0, at + step)));
}

function revealInChart(place) {
  if (!chart.reveal(place)) {
    byId("rows").value = "all";
    chart.showRows("all");
    chart.reveal(place);
  }
}

function draw() {
  map.setTime(clock.time);
  chart.setTime(clock.time, true);
  byId("slider").value = clock.tick;
  byId("tick").value = `tick ${clock.tick} of ${scene.last}`;
  byId("play").textContent = clock.playing ? "Pause" : "Play";
  byId("speed").value = `${counted(clock.speed, "tick")}/s`;
  const text = about();
  if (byId("about").textContent !== text) byId("about").textContent = text;
}

function about() {
  if (state.violation) return `${scene.rules[state.violation.rule].id}: ${state.violation.message}`;
  if (state.chosen.length) return aboutRobot(scene.tracks[state.chosen[0]], clock.tick);
  const start = scene.start ? ` Names on the map and in the chart are without “${scene.start}”.` : "";
  const places = (scene.computed ? " The map's positions are laid out, not given." : "") + start;
  if (scene.alone) return `Rings are starts, squares are goals.${places}`;
  const there = counted(map.poses.filter((pose) => pose).length, "robot");
  return `${there} on the map. ${aboutTrace()}${aboutWaits()}${places}`;
}

function aboutTrace() {
  if (scene.now === null) return "";
  return clock.tick > scene.now
    ? `After tick ${scene.now}: as planned. `
    : "Dashed rings are where robots were to be by their plans. ";
}

function aboutWaits() {
  if (!map.shown.waits) return "Click one to follow it.";
  const [waiting, inCircle] = [map.waits, [...map.circle]].map((waits) => new Set(waits.map(([robot]) => robot)).size);
  const round = inCircle ? `, ${inCircle} of them in a circle` : "";
  return `${counted(waiting, "robot")} wait${waiting === 1 ? "s" : ""} for others${round}.`;
}

function drawStrip() {
  const strip = byId("strip");
  strip.width = strip.clientWidth;
  const pen = strip.getContext("2d");
  pen.fillStyle = colours().wrong;
  const x = (tick) => ((tick - scene.first) / (scene.last - scene.first)) * strip.width;
  for (const { start, end } of scene.violations) {
    if (start !== null) pen.fillRect(x(start) - 1, 0, Math.max(3, x(end ?? scene.last) - x(start)), 6);
  }
}

function writeFacts() {
  const broken = scene.rules.reduce((sum, rule) => sum + rule.count, 0);
  const verdict = byId("verdict");
  if (scene.alone) {
    verdict.textContent = "an instance without plans";
    byId("facts").textContent = `${counted(scene.tracks.length, "robot")} · ${counted(scene.places.length, "resource")}`;
    return;
  }
  verdict.textContent = broken ? `✗ ${counted(broken, "violation")}` : "✓ no rule is broken";
  verdict.className = broken ? "wrong" : "right";
  const names = new Set(scene.tracks.map((track) => track.label)).size;
  const unplanned = scene.unplanned ? `, ${scene.unplanned} unplanned` : "";
  byId("facts").textContent =
    `${counted(names, "robot")}${unplanned} · total cost ${scene.cost} · ${counted(scene.places.length, "resource")}`;
}

/** Show or hide a part of the map; the button says which it is. */
function toggle(what) {
  map.show(what, !map.shown[what]);
  byId(what).ariaPressed = String(map.shown[what]);
  draw();
}

function showMapAlone() {
  byId("map-alone").ariaPressed = String(document.body.classList.toggle("map-alone"));
}

const KEYS = {
  " ": () => clock.toggle(),
  ArrowLeft: (event) => clock.step(event.shiftKey ? -10 : -1),
  ArrowRight: (event) => clock.step(event.shiftKey ? 10 : 1),
  ArrowUp: () => nextRobot(-1),
  ArrowDown: () => nextRobot(1),
  Home: () => clock.stopAt(scene.first),
  End: () => clock.stopAt(scene.last),
  "+": () => clock.changeSpeed(1),
  "=": () => clock.changeSpeed(1),
  "-": () => clock.changeSpeed(-1),
  i: () => map.zoom(1.5),
  o: () => map.zoom(1 / 1.5),
  0: () => map.fit(),
  w: () => map.pan(0, -STEP),
  a: () => map.pan(-STEP, 0),
  s: () => map.pan(0, STEP),
  d: () => map.pan(STEP, 0),
  g: () => toggle("goals"),
  l: () => toggle("waits"),
  m: () => showMapAlone(),
  n: () => nextViolation(1),
  p: () => nextViolation(-1),
  Escape: () => choose([]),
};

addEventListener("keydown", (event) => {
  const isText = event.target.matches?.("input[type=search], select") || byId("keys").open;
  const action = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!action || isText || event.ctrlKey || event.altKey || event.metaKey) return;
  event.preventDefault();
  action(event);
});
addEventListener("keyup", (event) => {
  if (event.key === " " && event.target.matches?.("button, summary")) event.preventDefault();
});

/** Buttons do what their key does; these have none. */
const CLICKS = {
  "chart-in": () => chart.zoom(1.5),
  "chart-out": () => chart.zoom(1 / 1.5),
  help: () => byId("keys").showModal(),
};
for (const [id, action] of Object.entries(CLICKS)) byId(id).addEventListener("click", action);
for (const button of document.querySelectorAll("[data-key]"))
  button.addEventListener("click", () => KEYS[button.dataset.key]({}));

byId("from").textContent = scene.first;
byId("to").textContent = scene.last;
Object.assign(byId("slider"), { min: scene.first, max: scene.last, step: 1 });
byId("slider").addEventListener("input", (event) => clock.stopAt(Number(event.target.value)));
byId("rows").addEventListener("change", (event) => chart.showRows(event.target.value));
byId("find").addEventListener("input", (event) => robots.find(event.target.value));
new ResizeObserver(drawStrip).observe(byId("strip"));
onColours(drawStrip);

/** For pages that embed this one, and for its tests. */
globalThis.viewer = { clock, map, chart, choose };

writeFacts();
clock.listen(draw);
draw();
