// The lists: broken rules with their violations, and robots.

class ViolationList {
  constructor(list, jump) {
    this.buttons = scene.violations.map((violation) => entry(violation.message, () => jump(violation)));
    scene.rules.forEach(({ id, statement, count }, rule) => {
      const ofRule = this.buttons.filter((_, at) => scene.violations[at].rule === rule);
      const group = groupOf(id, count, make("p", "", statement), ...ofRule);
      if (ofRule.length < count)
        group.append(make("p", "", `and ${count - ofRule.length} more, which carproof check lists`));
      list.append(group);
    });
    if (!scene.rules.length) list.append(make("p", "", "No rule is broken."));
  }

  show(violation) {
    this.buttons.forEach((button, at) => button.classList.toggle("chosen", scene.violations[at] === violation));
    this.buttons[scene.violations.indexOf(violation)]?.scrollIntoView({ block: "nearest" });
  }
}

class RobotList {
  constructor(list, jump) {
    this.buttons = scene.tracks.map((track, number) => {
      const button = entry("", () => jump(number));
      const name = (place) => (place === null ? "?" : scene.places[place].label);
      const swatch = make("span", "swatch");
      const { fill, edge, width } = scene.looks[track.look];
      Object.assign(swatch.style, { background: fill, border: `${width}px solid ${edge}` });
      button.append(swatch, make("strong", "", track.label));
      const served = (ticks) => (ticks ? ` (${ticks}t)` : "");
      const stops = track.stops.map(([place, ticks]) => `${name(place)}${served(ticks)}`);
      button.append(make("small", "", ` ${[name(track.start), ...(stops.length ? stops : ["?"])].join(" → ")}`));
      const notes = [track.note, track.cost === null ? "" : `cost ${track.cost}`].filter((each) => each);
      button.append(make("small", "", notes.length ? ` · ${notes.join(" · ")}` : ""));
      return button;
    });
    const unplanned = this.buttons.filter((_, number) => !scene.alone && !scene.tracks[number].stays.length);
    if (unplanned.length) list.append(groupOf("without a plan", unplanned.length, ...unplanned));
    list.append(...this.buttons.filter((button) => !unplanned.includes(button)));
  }

  find(part) {
    this.buttons.forEach((button, at) => {
      const { label, note } = scene.tracks[at];
      button.hidden = !`${label} ${note}`.includes(part);
    });
  }

  show(chosen) {
    this.buttons.forEach((button, number) => button.classList.toggle("chosen", chosen.includes(number)));
    this.buttons[chosen[0]]?.scrollIntoView({ block: "nearest" });
  }
}

/** One line about a robot at the time. */
function aboutRobot(track, time) {
  const at = stayAt(track.stays, time);
  const [stand, enter, leave] = at < 0 ? [] : track.stays[at];
  const now =
    at < 0 ? "on no resource now" : `now in ${scene.places[scene.stands[stand].place].label} ${interval(enter, leave)}`;
  const serves = track.services.some(([start, end]) => holds(start, end, time)) ? ", serves a stop" : "";
  const arrival = track.cost === null ? track.note : `arrives at ${track.release + track.cost}, cost ${track.cost}`;
  const pace = track.pace === "1" || !track.pace ? "" : `, pace ${track.pace}`;
  return `robot ${track.label}: released at ${track.release}${pace}, ${arrival}, ${now}${serves}`;
}
