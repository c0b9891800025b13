// The timeline: how many of the scans are shown, by hand or playing; at its end it keeps up with a growing map.

const element = (id) => document.getElementById(id);
const WHOLE = 12000;           // milliseconds the whole drive takes to play
const FASTEST = 2, SLOWEST = 600; // milliseconds a scan stays, at least and at most

export class Timeline {
  constructor(changed) {
    Object.assign(this, { changed, shown: 0, count: 0, playing: false, last: 0, due: 0, book: null });
    this.slider = element("scan");
    this.slider.addEventListener("input", () => { this.pause(); this.to(Number(this.slider.value)); });
    element("play").addEventListener("click", () => this.toggle());
  }

  restart() { Object.assign(this, { shown: 0, count: 0, book: null }); this.pause(); this.show(); }

  // The book may have grown; whoever looked at its end still does.
  reach(book) {
    const atEnd = this.shown === this.count;
    Object.assign(this, { book, count: book.count });
    this.shown = atEnd ? this.count : Math.min(this.shown, this.count);
    this.show();
  }

  to(shown) {
    this.shown = Math.min(this.count, Math.max(Math.min(1, this.count), shown));
    this.show();
    this.changed();
  }

  step(by) { this.pause(); this.to(this.shown + by); }

  toggle() {
    if (this.playing) { this.pause(); return; }
    if (this.count < 2) return;
    if (this.shown === this.count) this.to(1);
    Object.assign(this, { playing: true, last: performance.now(), due: 0 });
    this.mark();
  }

  pause() { this.playing = false; this.mark(); }

  frame(now) {
    if (!this.playing) return;
    const stay = Math.min(SLOWEST, Math.max(FASTEST, WHOLE / this.count));
    this.due += Math.min(now - this.last, 250) / stay;
    this.last = now;
    const steps = Math.floor(this.due);
    if (!steps) return;
    this.due -= steps;
    this.to(this.shown + steps);
    if (this.shown === this.count && this.book.ending) this.pause();
  }

  mark() {
    element("play").classList.toggle("playing", this.playing);
    element("play").setAttribute("aria-label", this.playing ? "Pause" : "Play");
    element("play").title = this.playing ? "Pause (space)" : "Play (space)";
  }

  show() {
    Object.assign(this.slider, { min: String(Math.min(1, this.count)), max: String(this.count), value: String(this.shown), disabled: this.count < 2 });
    element("play").disabled = this.count < 2;
    const scan = this.book?.scans[this.shown - 1], first = this.book?.scans[0];
    const since = scan && first ? document.createElement("span") : null;
    if (since) since.textContent = ` · ${clock(scan.time - first.time)}`;
    element("moment").replaceChildren(this.count ? `scan ${this.shown} of ${this.count}` : "no scans yet", ...(since ? [since] : []));
    this.slider.setAttribute("aria-valuetext", element("moment").textContent);
  }
}

function clock(seconds) {
  const whole = Math.round(seconds);
  return `${String(Math.floor(whole / 60)).padStart(2, "0")}:${String(whole % 60).padStart(2, "0")} min`;
}
