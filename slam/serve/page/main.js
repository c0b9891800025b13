// The page: puts book, camera, painter, hands and panels together.

import { Book } from "./book.js";
import { Camera } from "./camera.js";
import { listen, listenToKeys } from "./hands.js";
import { paintScene } from "./layers.js";
import { paintOverlay } from "./overlay.js";
import { Painter } from "./painter.js";
import { LayerList, setUpFiles, setUpTabs, showFiles, showRun } from "./panels.js";
import { Planning } from "./planning.js";
import { middleOf, spoken, thingAt, told } from "./pointing.js";
import { say, showRuler, showState } from "./status.js";
import { Timeline } from "./timeline.js";
import { setUpUploads } from "./uploads.js";
import { asked, follow } from "./wire.js";

const element = (id) => document.getElementById(id);
const GRAB = 16; // CSS pixels around start and goal

class Page {
  constructor({ planners, files, limits }) {
    Object.assign(this, { book: new Book(), camera: new Camera(), on: {}, run: null, thing: null, pinned: false, cursor: null, tab: "layers", version: -1, overlayOld: true });
    this.inks = readInks();
    this.painter = new Painter(element("scene"), this.camera, (context, view) => paintScene(context, view, { book: this.book, shown: this.time.shown, inks: this.inks, on: this.on }));
    this.time = new Timeline(() => this.repaint());
    this.layers = new LayerList(this.on, () => this.repaint());
    this.planning = new Planning(planners, () => { this.overlayOld = true; }, say);
    this.chooseTab = setUpTabs((name) => { this.tab = name; element("map").classList.toggle("placing", name === "plan"); });
    setUpFiles(files, () => this.run);
    this.open = setUpUploads(limits, (number) => this.began(number), (reason) => this.failed(reason, "That cannot be merged"));
    this.listen();
    this.watch();
  }

  listen() {
    listen(element("map"), this.camera, {
      moved: () => this.moved(),
      hovered: (place, spot) => this.hovered(place, spot),
      clicked: (place, spot) => this.clicked(place, spot),
      grabbed: (place) => this.grabbed(place),
    });
    const pan = (right, down) => () => { this.camera.pan(right, down); this.moved(); };
    const zoom = (factor) => () => { this.camera.zoom(factor); this.moved(); };
    const put = (end) => () => { this.chooseTab("plan"); this.planning.put(end, this.cursor ?? [this.camera.x, this.camera.y]); };
    const actions = {
      ArrowLeft: pan(60, 0), ArrowRight: pan(-60, 0), ArrowUp: pan(0, 60), ArrowDown: pan(0, -60),
      "+": zoom(1.25), "=": zoom(1.25), "-": zoom(0.8), f: () => this.fit(), s: put("start"), g: put("goal"),
      n: () => this.step(1), p: () => this.step(-1), " ": () => this.time.toggle(), "[": () => this.time.step(-1), "]": () => this.time.step(1),
      l: () => { this.chooseTab("layers"); document.querySelector("#layer-list input").focus(); }, o: () => this.open(),
      "?": () => element("keys").showModal(), Escape: () => this.letGo(),
    };
    listenToKeys(actions);
    element("nearer").onclick = actions["+"];
    element("farther").onclick = actions["-"];
    element("fit").onclick = actions.f;
    element("help").onclick = actions["?"];
    element("stop").onclick = () => asked(`/runs/${this.run}/stop`, { method: "POST" }).catch((trouble) => this.failed(trouble.message));
    element("failure-close").onclick = () => { element("failure").hidden = true; };
    element("runs").onchange = () => this.show(Number(element("runs").value));
  }

  // Sizes, themes and frames.
  watch() {
    const stage = element("map").parentElement;
    new ResizeObserver(() => {
      this.painter.resize(stage.clientWidth, stage.clientHeight);
      Object.assign(element("map"), { width: element("scene").width, height: element("scene").height });
      if (!this.camera.moved) this.fit();
      this.moved();
    }).observe(stage);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => { this.inks = readInks(); this.version = -1; this.repaint(); });
    element("map").addEventListener("focus", () => { this.overlayOld = true; });
    element("map").addEventListener("blur", () => { this.overlayOld = true; });
    const frame = (now) => { this.frame(now); requestAnimationFrame(frame); };
    requestAnimationFrame(frame);
  }

  frame(now) {
    if (this.version !== this.book.version) this.update();
    this.time.frame(now);
    this.painter.frame(now);
    if (this.overlayOld) this.paintOverlay();
  }

  // The book has grown: words and numbers first, the picture follows.
  update() {
    const { book } = this;
    this.version = book.version;
    this.time.reach(book);
    if (!this.camera.moved) this.fit();
    this.layers.show(book, this.inks);
    showRun(book, this.run);
    showFiles(book.ending === "done");
    showState(book, this.run);
    this.repaint();
  }

  repaint() {
    this.painter.ask();
    this.overlayOld = true;
  }

  paintOverlay() {
    this.overlayOld = false;
    const map = element("map"), thing = this.thing, views = thing ? told(this.book, thing).views : [];
    const cross = map.matches(":focus-visible") && !this.cursor;
    paintOverlay(map, this.camera, { book: this.book, shown: this.time.shown, inks: this.inks, thing, views, ends: this.planning.ends, answers: this.planning.answers, cross, ratio: this.painter.ratio });
    showRuler(this.camera, this.cursor);
  }

  moved() {
    this.overlayOld = true;
    if (this.thing) this.placeTip();
    if (!this.cursor) this.point(this.pinned ? this.thing : null);
  }

  fit() {
    const box = this.book.bounds();
    if (box) this.camera.fit(box);
    this.moved();
  }

  hovered(place, spot) {
    this.cursor = place;
    this.overlayOld = true;
    if (!this.pinned) this.point(place && thingAt(this.book, this.camera, place, this.time.shown), spot);
  }

  clicked(place, spot) {
    if (this.tab === "plan" && this.book.room) { this.planning.put(this.planning.armed, place); return; }
    this.pinned = false;
    this.point(thingAt(this.book, this.camera, place, this.time.shown), spot);
    this.pinned = this.thing !== null;
    if (this.thing) say(spoken(told(this.book, this.thing)));
  }

  // A press on start or goal takes hold of it.
  grabbed(place) {
    const near = (end) => end && Math.hypot(end[0] - place[0], end[1] - place[1]) * this.camera.scale < GRAB;
    const end = ["goal", "start"].find((name) => near(this.planning.ends[name]));
    return end && this.tab === "plan" ? (now) => this.planning.put(end, now) : null;
  }

  // Next or previous edge of the map, brought to the middle and told.
  step(by) {
    const { room, firstView } = this.book;
    if (!room) return;
    const seen = [...room.support.keys()].filter((edge) => firstView[edge] < this.time.shown);
    if (!seen.length) return;
    const now = this.thing?.kind === "edge" ? seen.indexOf(this.thing.number) : by > 0 ? -1 : 0;
    this.pinned = false;
    this.cursor = null;
    const thing = { kind: "edge", number: seen[(now + by + seen.length) % seen.length] };
    [this.camera.x, this.camera.y] = middleOf(this.book, thing);
    this.camera.moved = true;
    this.point(thing);
    this.pinned = true;
    say(spoken(told(this.book, thing)));
  }

  point(thing, spot) {
    this.thing = thing ?? null;
    this.spot = spot ?? null;
    this.overlayOld = true;
    element("tip").hidden = !thing;
    if (!thing) return;
    const { title, rows } = told(this.book, thing), list = document.createElement("dl"), head = document.createElement("b");
    head.textContent = title;
    for (const [what, value] of rows) list.append(Object.assign(document.createElement("dt"), { textContent: what }), Object.assign(document.createElement("dd"), { textContent: value }));
    element("tip").replaceChildren(head, list);
    this.placeTip();
  }

  // Beside the cursor, or beside the thing where there is none; never outside the stage.
  placeTip() {
    const tip = element("tip"), middle = this.thing && middleOf(this.book, this.thing);
    const [left, top] = this.spot ?? (middle ? this.camera.toScreen(...middle) : [this.camera.width / 2, this.camera.height / 2]);
    const right = left + 18 + tip.offsetWidth < this.camera.width;
    tip.style.left = `${Math.max(6, Math.min(right ? left + 16 : left - 16 - tip.offsetWidth, this.camera.width - tip.offsetWidth - 6))}px`;
    tip.style.top = `${Math.max(6, Math.min(top + 14, this.camera.height - tip.offsetHeight - 6))}px`;
  }

  letGo() {
    this.pinned = false;
    this.point(null);
    element("failure").hidden = true;
  }

  // Runs.
  async began(number) {
    await listRuns();
    this.show(number);
  }

  show(number) {
    this.leave?.();
    this.book = new Book();
    this.run = number;
    this.time.restart();
    this.camera.moved = false;
    this.letGo();
    this.planning.forget();
    element("runs").value = String(number);
    element("empty").hidden = true;
    this.leave = follow(number, (message) => this.take(message), () => { this.book.ending = "lost"; this.book.version += 1; });
    this.update();
  }

  take(message) {
    if (message.kind === "room" && this.thing) this.letGo(); // edges have new numbers
    this.book.take(message);
    if (message.kind === "opening") say(`merging ${message.name}, ${message.scans} scans`);
    if (message.kind === "done") { this.planning.follow(this.run); say(`the map is whole: ${element("state").textContent}`); }
    if (message.kind === "failed") this.failed(message.reason);
  }

  failed(reason, title = "The merge failed") {
    element("failure-title").textContent = title;
    element("failure-reason").textContent = reason;
    element("empty").hidden = true;
    element("failure").hidden = false;
  }
}

// Every custom property of the sheet that names a colour, as the canvas needs it.
function readInks() {
  const style = getComputedStyle(document.documentElement), names = "ink muted surface accent sans free safety wall frontier raw filler redrawn knot door body inferred drive landmark truth error cones configuration-space grid";
  return Object.fromEntries(names.split(" ").map((name) => [name, style.getPropertyValue(`--${name}`).trim()]));
}

async function listRuns() {
  const known = await (await asked("/runs")).json();
  element("runs").replaceChildren(...known.runs.map(({ number, name }) => new Option(name, String(number))));
  element("runs").parentElement.hidden = known.runs.length === 0;
  return known;
}

const known = await listRuns();
const page = new Page(known);
window.roomsketch = page; // for whoever looks into it from the console
if (known.runs.length) page.show(known.runs.at(-1).number);
else {
  element("empty").hidden = false;
  page.update();
}
