// Planning: start, goal and robot go to both planners at once; their answers stand side by side.

import { length, several } from "./pointing.js";
import { asked } from "./wire.js";

const element = (id) => document.getElementById(id);
const VERDICTS = { path: "path found", "not found": "none found", "no path": "proved: no path", undecided: "undecided", refused: "cannot be planned" };

export class Planning {
  // changed() is called when something on the map has to be drawn anew; say(text) speaks to screen readers.
  constructor(planners, changed, say) {
    Object.assign(this, { planners, changed, say, ends: { start: null, goal: null }, answers: [], run: null, round: 0 });
    element("question").addEventListener("submit", (event) => event.preventDefault());
    element("shape").addEventListener("change", () => this.shapeChanged());
    for (const id of ["radius", "long", "wide"]) element(id).addEventListener("change", () => this.ask());
    this.show();
  }

  get armed() { return document.querySelector("input[name=end]:checked").value; }

  get robot() {
    return element("shape").value === "disc" ? `disc:${element("radius").value}` : `rectangle:${element("long").value}x${element("wide").value}`;
  }

  // A run whose map is there can be planned on; null where there is none.
  follow(run) {
    this.run = run;
    this.ask();
  }

  forget() {
    this.ends = { start: null, goal: null };
    this.run = null;
    this.ask();
  }

  put(end, place) {
    this.ends[end] = place.map((metres) => Math.round(1000 * metres) / 1000 + 0); // + 0: no minus before a zero
    if (end === "start" && !this.ends.goal) document.querySelector("input[name=end][value=goal]").checked = true;
    this.say(`${end} at ${spot(place)}`);
    this.ask();
  }

  shapeChanged() {
    for (const label of document.querySelectorAll("[data-for]")) label.hidden = label.dataset.for !== element("shape").value;
    this.ask();
  }

  ask() {
    const round = ++this.round, { start, goal } = this.ends;
    this.answers = [];
    this.waiting = start && goal && this.run !== null ? new Set(this.planners) : new Set();
    for (const planner of this.waiting) this.askOne(planner, round, { planner, robot: this.robot, start, goal });
    this.show();
    this.changed();
  }

  async askOne(planner, round, question) {
    let answer;
    try {
      answer = await (await asked(`/runs/${this.run}/route`, { method: "POST", body: JSON.stringify(question) })).json();
    } catch (trouble) {
      answer = { answer: "refused", reason: trouble.message };
    }
    if (round !== this.round) return; // start, goal or robot changed meanwhile
    this.waiting.delete(planner);
    this.answers.push({ poses: [], planner, ...answer });
    this.show();
    this.changed();
  }

  show() {
    for (const end of ["start", "goal"]) element(`${end}-at`).textContent = this.ends[end] ? spot(this.ends[end]) : "not yet";
    const cards = this.ends.start && this.ends.goal && this.run !== null ? this.planners.map((planner) => this.card(planner)) : [];
    element("answers").replaceChildren(...cards);
    element("plan-hint").textContent = this.hint();
  }

  hint() {
    if (this.run === null) return "Planning begins as soon as the map is whole.";
    if (!this.ends.start || !this.ends.goal) return "Click on the map, or press S and G, to put start and goal. Both planners keep to the part of the map that is safe to plan on.";
    return "Drag start or goal to ask again.";
  }

  card(planner) {
    const card = document.createElement("article"), answer = this.answers.find((one) => one.planner === planner);
    card.className = "answer";
    card.dataset.planner = planner;
    card.style.setProperty("--hue", `var(--${planner})`);
    card.append(node("h4", NAMES[planner] ?? planner));
    if (!answer) {
      card.append(node("p", "planning…", "verdict"));
      card.setAttribute("aria-busy", "true");
      return card;
    }
    const found = answer.answer === "path";
    card.append(node("p", VERDICTS[answer.answer] ?? answer.answer, found ? "verdict" : "verdict no"));
    card.append(facts(found ? figures(answer) : timed(answer)));
    card.append(node("p", answer.reason, found ? "" : "no"));
    return card;
  }
}

const NAMES = { cones: "Generalized cones", "configuration-space": "Configuration space" };

function figures(answer) {
  return [["length", length(answer.length)], ["clearance", length(answer.clearance)], ...timed(answer), ["path", several(answer.poses.length, "pose")]];
}

function timed({ seconds }) {
  return seconds === undefined ? [] : [["time", seconds < 1 ? `${(1000 * seconds).toFixed(seconds < 0.01 ? 1 : 0)} ms` : `${seconds.toFixed(2)} s`]];
}

export function facts(rows) {
  const list = document.createElement("dl");
  list.className = "facts";
  for (const [what, value] of rows) list.append(node("dt", what), node("dd", value));
  return list;
}

export function node(tag, text, name = "") {
  const made = document.createElement(tag);
  made.textContent = text;
  if (name) made.className = name;
  return made;
}

function spot([x, y]) { return `${x.toFixed(2)}, ${y.toFixed(2)} m`; }
