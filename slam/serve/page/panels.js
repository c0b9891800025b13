// The panels beside the map: layers to switch, what is known of the run, and files to take away.

import { LAYERS } from "./layers.js";
import { facts, node } from "./planning.js";
import { asked } from "./wire.js";

const element = (id) => document.getElementById(id);

export function setUpTabs(chosen) {
  const tabs = [...document.querySelectorAll("[role=tab]")];
  const choose = (tab, focus) => {
    for (const one of tabs) {
      one.setAttribute("aria-selected", one === tab);
      one.tabIndex = one === tab ? 0 : -1;
      element(one.getAttribute("aria-controls")).hidden = one !== tab;
    }
    if (focus) tab.focus();
    chosen(tab.getAttribute("aria-controls"));
  };
  for (const [number, tab] of tabs.entries()) {
    tab.addEventListener("click", () => choose(tab));
    tab.addEventListener("keydown", ({ key }) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[key];
      if (step) choose(tabs[(number + step + tabs.length) % tabs.length], true);
    });
  }
  return (name, focus) => choose(element(`tab-${name}`), focus);
}

// The layers' switches; `on` is kept up to date, and `changed` called after every switch.
export class LayerList {
  constructor(on, changed) {
    this.rows = LAYERS.map((layer) => {
      on[layer.id] = layer.on;
      const label = document.createElement("label"), box = document.createElement("input"), swatch = document.createElement("canvas"), count = document.createElement("output");
      Object.assign(box, { type: "checkbox", checked: layer.on, id: `layer-${layer.id}` });
      box.addEventListener("change", () => { on[layer.id] = box.checked; changed(); });
      [swatch.width, swatch.height] = [60, 32];
      swatch.setAttribute("aria-hidden", "true");
      label.append(box, swatch, node("span", layer.name), count);
      const item = document.createElement("li");
      item.append(label);
      element("layer-list").append(item);
      return { layer, label, box, swatch, count };
    });
  }

  show(book, inks) {
    for (const { layer, label, box, swatch, count } of this.rows) {
      const ready = layer.ready?.(book) ?? true;
      label.classList.toggle("off", !ready);
      box.disabled = !ready;
      count.textContent = layer.count(book);
      paintSwatch(swatch.getContext("2d"), layer.id, inks);
    }
  }
}

// A small sample of how a layer looks, thirty by sixteen pixels drawn twice as large.
function paintSwatch(context, id, inks) {
  context.setTransform(2, 0, 0, 2, 0, 0);
  context.clearRect(0, 0, 30, 16);
  context.strokeStyle = context.fillStyle = inks[id];
  context.globalAlpha = 1;
  context.lineWidth = 1.5;
  context.setLineDash([]);
  context.beginPath();
  const draw = {
    free: () => context.fillRect(0, 1, 30, 14),
    safety: () => context.fillRect(0, 1, 30, 14),
    raw: () => scatter(context),
    filler: () => scatter(context),
    redrawn: () => stroke(context, [[1, 13], [10, 4], [20, 4], [29, 10]]),
    inferred: () => bodySample(context, 0.16, [3, 2]),
    body: () => bodySample(context, 0.3, []),
    frontier: () => { context.setLineDash([5, 4]); stroke(context, [[1, 8], [29, 8]]); },
    wall: () => wallSample(context),
    door: () => { context.lineWidth = 3; stroke(context, [[4, 8], [26, 8]]); for (const x of [4, 26]) context.fillRect(x - 3, 5, 6, 6); },
    knot: () => { context.ellipse(15, 8, 10, 5, -0.3, 0, 7); context.stroke(); context.fillRect(14, 7, 2, 2); },
    landmark: () => { stroke(context, [[10, 8], [20, 8]]); stroke(context, [[15, 3], [15, 13]]); },
    drive: () => { stroke(context, [[1, 12], [12, 6], [29, 5]]); for (const [x, y] of [[1, 12], [12, 6], [28, 5]]) context.fillRect(x - 1.5, y - 1.5, 3, 3); },
    truth: () => { context.strokeStyle = inks.error; context.lineWidth = 4; context.globalAlpha = 0.6; stroke(context, [[1, 11], [29, 11]]); context.globalAlpha = 1; context.lineWidth = 1.5; context.strokeStyle = inks.truth; stroke(context, [[1, 6], [29, 6]]); },
  };
  draw[id]();
}

function stroke(context, corners) {
  context.beginPath();
  for (const [x, y] of corners) context.lineTo(x, y);
  context.stroke();
}

function scatter(context) { for (const [x, y] of [[3, 12], [8, 9], [13, 6], [18, 5], [23, 5], [27, 7]]) context.fillRect(x, y, 2, 2); }

function bodySample(context, alpha, dashes) {
  context.globalAlpha = alpha;
  context.fillRect(5, 2, 20, 12);
  context.globalAlpha = 1;
  context.setLineDash(dashes);
  context.strokeRect(5, 2, 20, 12);
}

function wallSample(context) {
  for (const [step, x] of [1, 11, 21].entries()) {
    context.globalAlpha = 0.5 + 0.25 * step;
    context.lineWidth = 1.1 + 0.9 * step;
    stroke(context, [[x, 8], [x + 8, 8]]);
  }
}

export function showRun(book, run) {
  const parts = [];
  if (book.opening) parts.push(facts([["recording", book.opening.name], ["sensor", book.opening.sensor.replaceAll("_", " ")], ["reach", `${book.opening.reach.toFixed(1)} m`], ["scans", book.opening.scans]]));
  if (book.report) parts.push(...reported(book.report));
  if (book.truth) parts.push(...scored("Against the truth", book.truth.scores));
  else if (book.report && Object.keys(book.report.scores).length) parts.push(...scored("Scores", book.report.scores));
  if (!parts.length) parts.push(node("p", run ? "Counts, timings and whatever was refused stand here once the map is whole." : "No run is shown yet.", "small"));
  element("run-facts").replaceChildren(...parts);
}

function reported(report) {
  const counts = Object.entries(report.counts).filter(([name]) => name !== "scans").map(([name, value]) => [name, figure(value)]);
  return [
    node("h3", "Counts"), facts(counts),
    node("h3", "Time spent"), ...shares(report.timings),
    ...folded(`${report.rejectedCount} refused, with reasons`, report.rejected.map((made) => [`${made.what} ${made.scans.map((scan) => scan + 1).join(", ")}`, made.reason]), report.rejectedCount),
    ...folded(`${report.damagedCount} damaged lines`, report.damaged.map((line) => ["", line]), report.damagedCount),
  ];
}

function scored(title, scores) {
  return [node("h3", title), ...Object.entries(scores).flatMap(([name, values]) => folded(name, flat(values).map(([what, value]) => [what, figure(value)]), 1))];
}

function flat(values, prefix = "") {
  return Object.entries(values ?? {}).flatMap(([name, value]) => (value !== null && typeof value === "object" ? flat(value, `${prefix}${name}: `) : [[`${prefix}${name}`.replaceAll("_", " "), value]]));
}

function shares(timings) {
  const most = Math.max(...Object.values(timings), 1e-9);
  return Object.entries(timings).map(([stage, seconds]) => {
    const row = document.createElement("div"), bar = document.createElement("i"), lane = document.createElement("span");
    row.className = "share";
    bar.style.width = `${(100 * seconds) / most}%`;
    bar.style.display = "block";
    lane.append(bar);
    row.append(node("span", stage), lane, node("span", `${seconds.toFixed(2)} s`));
    return row;
  });
}

function folded(title, rows, count) {
  if (!count) return [];
  const details = document.createElement("details"), list = document.createElement("ul");
  for (const [what, reason] of rows) {
    const item = document.createElement("li");
    if (what) item.append(node("b", `${what}: `));
    item.append(reason);
    list.append(item);
  }
  details.append(node("summary", title), list);
  return [details];
}

function figure(value) {
  if (value === null) return "–";
  return typeof value === "number" && !Number.isInteger(value) ? value.toPrecision(3) : String(value);
}

// Every format as a row with a button; `run()` is the number of the run whose map is whole, else null.
export function setUpFiles(files, run) {
  for (const { name, file, says } of files) {
    const item = document.createElement("li"), button = node("button", "Save");
    button.type = "button";
    button.setAttribute("aria-label", `Save ${file}`);
    button.addEventListener("click", () => save(button, run(), name, file));
    item.append(node("b", file), node("span", says), button);
    element("file-list").append(item);
  }
}

export function showFiles(ready) {
  for (const button of document.querySelectorAll("#file-list button")) button.disabled = !ready;
  if (!element("save-hint").classList.contains("wrong")) element("save-hint").textContent = ready ? "" : "There are files to save as soon as the map is whole.";
}

async function save(button, run, name, file) {
  const hint = element("save-hint");
  hint.className = "small";
  hint.textContent = `writing ${file}…`;
  button.disabled = true;
  try {
    const content = URL.createObjectURL(await (await asked(`/runs/${run}/files/${name}`)).blob());
    Object.assign(document.createElement("a"), { href: content, download: file }).click();
    setTimeout(() => URL.revokeObjectURL(content), 10000);
    hint.textContent = `${file} is saved.`;
  } catch (trouble) {
    hint.classList.add("wrong");
    hint.textContent = `${file} cannot be saved: ${trouble.message}`;
  }
  button.disabled = false;
}
