// Wires the parts of the page together.

const clock = new Clock(scene.first, scene.last);
const state = { chosen: [], violation: null };

const map = new MapView(document.querySelector("#map-view svg"), (chosen) => choose(chosen));
const chart = new Chart(byId("chart-view"), byId("chart-size"), byId("chart"), (tick, chosen) => {
  clock.stopAt(tick);
  if (chosen) choose(chosen);
});
const violations = new ViolationList(byId("violations"), jumpToViolation);
const robots = new RobotList(byId("robots"), jumpToRobot);

function choose(chosen, violation = null) {
  Object.assign(state, { chosen, violation });
  map.drawTrail(chosen);
  chart.choose(chosen);
  robots.show(chosen);
  violations.show(violation);
  draw();
}

function jumpToRobot(number) {
  const track = scene.tracks[number];
  choose([number]);
  if (!track.stays.length) return;
  if (stayAt(track, clock.time) < 0) clock.stopAt(track.stays[0][1]);
  const stay = track.stays[Math.max(0, stayAt(track, clock.time))];
  reveal(scene.stands[stay[0]].place);
}

function jumpToViolation(violation) {
  choose(violation.tracks, violation);
  if (violation.start !== null) clock.stopAt(violation.start);
  if (violation.place !== null) reveal(violation.place);
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

function reveal(place) {
  if (scene.places[place].at) map.reveal(scene.places[place].at);
  if (!chart.reveal(place)) {
    byId("rows").value = "all";
    chart.showRows("all");
    chart.reveal(place);
  }
}

function draw() {
  map.draw(clock.time, state.chosen);
  chart.setTime(clock.time, true);
  byId("slider").value = clock.tick;
  byId("tick").value = `tick ${clock.tick} of ${scene.last}`;
  byId("play").textContent = clock.playing ? "Pause" : "Play";
  byId("speed").value = `${counted(clock.speed, "tick")}/s`;
  byId("about").textContent = about();
}

function about() {
  if (state.violation) return `${scene.rules[state.violation.rule].id}: ${state.violation.message}`;
  if (state.chosen.length) return aboutRobot(scene.tracks[state.chosen[0]], clock.tick);
  const moving = scene.tracks.filter((track) => stayAt(track, clock.tick) >= 0).length;
  const places = scene.computed ? " The map's positions are laid out, not given." : "";
  return `${counted(moving, "robot")} on the map. Click one to follow it.${places}`;
}

function counted(count, word) {
  return `${count} ${word}${count === 1 ? "" : "s"}`;
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
  verdict.textContent = broken ? `✗ ${counted(broken, "violation")}` : "✓ no rule is broken";
  verdict.className = broken ? "wrong" : "right";
  const names = new Set(scene.tracks.map((track) => track.label)).size;
  const unplanned = scene.unplanned ? `, ${scene.unplanned} unplanned` : "";
  byId("facts").textContent =
    `${counted(names, "robot")}${unplanned} · total cost ${scene.cost} · ${counted(scene.places.length, "resource")}`;
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

const CLICKS = {
  first: () => clock.stopAt(scene.first),
  back: () => clock.step(-1),
  play: () => clock.toggle(),
  forward: () => clock.step(1),
  last: () => clock.stopAt(scene.last),
  slower: () => clock.changeSpeed(-1),
  faster: () => clock.changeSpeed(1),
  "map-in": () => map.zoom(1.5),
  "map-out": () => map.zoom(1 / 1.5),
  "map-fit": () => map.fit(),
  "chart-in": () => chart.zoom(1.5),
  "chart-out": () => chart.zoom(1 / 1.5),
  help: () => byId("keys").showModal(),
};
for (const [id, action] of Object.entries(CLICKS)) byId(id).addEventListener("click", action);

Object.assign(byId("slider"), { min: scene.first, max: scene.last, step: 1 });
byId("slider").addEventListener("input", (event) => clock.stopAt(Number(event.target.value)));
byId("rows").addEventListener("change", (event) => chart.showRows(event.target.value));
byId("find").addEventListener("input", (event) => robots.find(event.target.value));
new ResizeObserver(drawStrip).observe(byId("strip"));
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", drawStrip);

writeFacts();
clock.listen(draw);
draw();
