// The time that is shown: a real number of ticks while it plays, a whole one when it is set.

const SPEEDS = Array.from({ length: 20 }, (_, power) => 2 ** (power - 2));
const SECONDS_FOR_ALL = 40;

class Clock {
  constructor(first, last) {
    this.first = first;
    this.last = last;
    this.time = first;
    this.playing = false;
    this.speed = SPEEDS.find((speed) => speed >= (last - first) / SECONDS_FOR_ALL && speed >= 1) ?? SPEEDS.at(-1);
    this.listeners = [];
  }

  get tick() {
    return Math.floor(this.time);
  }

  listen(listener) {
    this.listeners.push(listener);
  }

  tell() {
    for (const listener of this.listeners) listener();
  }

  set(time) {
    this.time = Math.min(this.last, Math.max(this.first, time));
    this.tell();
  }

  /** Go a number of ticks on, or back if it is negative, and stand still there. */
  step(ticks) {
    this.playing = false;
    const whole = ticks < 0 ? Math.ceil(this.time) : this.tick;
    this.set(whole + ticks);
  }

  stopAt(tick) {
    this.playing = false;
    this.set(tick);
  }

  toggle() {
    this.playing = !this.playing;
    if (this.playing) {
      if (this.time >= this.last) this.time = this.first;
      this.before = performance.now();
      requestAnimationFrame((now) => this.run(now));
    } else {
      this.time = this.tick;
    }
    this.tell();
  }

  run(now) {
    if (!this.playing) return;
    const passed = Math.max(0, now - this.before) / 1000;
    this.before = now;
    this.set(this.time + passed * this.speed);
    if (this.time >= this.last) this.stopAt(this.last);
    else requestAnimationFrame((later) => this.run(later));
  }

  changeSpeed(steps) {
    const at = SPEEDS.indexOf(this.speed) + steps;
    this.speed = SPEEDS[Math.min(SPEEDS.length - 1, Math.max(0, at))];
    this.tell();
  }
}
