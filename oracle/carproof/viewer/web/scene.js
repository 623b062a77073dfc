// The scene as Python wrote it (carproof.viewer.scene), and small helpers. All text goes in as text, never as HTML.

const byId = (id) => document.getElementById(id);
const scene = JSON.parse(byId("scene").textContent);

function make(tag, className, text) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
}

function makeDrawn(tag, attributes) {
  const made = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

/** Whether the time is in [start, end); an end of null is for ever. */
function holds(start, end, time) {
  return start <= time && (end === null || time < end);
}

/** The index of the robot's stay at the time, or -1: of several in a broken plan the last. */
function stayAt(track, time) {
  return track.stays.findLastIndex(([, enter, leave]) => holds(enter, leave, time));
}

/** Whether the violation is to be seen at the time; one that takes no time is seen for one tick. */
function isBrokenAt(violation, time) {
  const { start, end } = violation;
  return start !== null && holds(start, end === null ? null : Math.max(end, start + 1), time);
}

function interval(enter, leave) {
  return `[${enter}, ${leave === null ? "for ever" : leave})`;
}
