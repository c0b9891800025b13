// Pointing: what lies under the cursor, and the words that tell where it comes from.

import { bodies } from "./map_layers.js";

const REACH = 9; // CSS pixels

// The nearest door or edge in reach of a place in the world, else the obstacle around it, else null.
export function thingAt(book, camera, [x, y], shown) {
  const { room } = book;
  if (!room) return null;
  let best = null, least = REACH / camera.scale;
  for (let edge = 0; edge < room.support.length; edge++) {
    if (book.firstView[edge] >= shown) continue;
    const distance = fromSegment(x, y, room.lines, 4 * edge);
    if (distance < least) [best, least] = [{ kind: "edge", number: edge }, distance];
  }
  least = Math.min(least, 0.6 * REACH / camera.scale);
  for (let door = 0; door < room.doors.length; door++) {
    const distance = fromSegment(x, y, room.jambs, 4 * door);
    if (distance < least) [best, least] = [{ kind: "door", number: door }, distance];
  }
  return best ?? bodyAt(book, x, y);
}

export function middleOf(book, thing) {
  if (thing.kind === "body") return null;
  const ends = thing.kind === "edge" ? book.room.lines : book.room.jambs, at = 4 * thing.number;
  return [(ends[at] + ends[at + 2]) / 2, (ends[at + 1] + ends[at + 3]) / 2];
}

// { title, rows: [[what, value]], views } of a thing; views are counted from 0.
export function told(book, thing) {
  if (thing.kind === "edge") return edgeTold(book, thing.number);
  if (thing.kind === "door") return doorTold(book.room.doors[thing.number], book.room.jambs.subarray(4 * thing.number, 4 * thing.number + 4));
  const { inferred, support, views } = thing.body;
  return { title: inferred ? "Obstacle, inferred: nobody saw it whole" : "Obstacle, measured", rows: [["seen by", several(support, "view")], ["views", listed(views)]], views };
}

export function spoken({ title, rows }) { return `${title}; ${rows.map(([what, value]) => `${what} ${value}`).join("; ")}`; }

function edgeTold(book, number) {
  const known = book.provenance(number);
  const rows = [
    [known.frontier ? "bounded by" : "measured by", `${known.views.length} of ${several(book.room.views, "view")}`],
    ["views", listed(known.views)],
    ["contradicted", known.contradictions ? `${several(known.contradictions, "time")}: seen through` : "never"],
  ];
  if (known.spread !== null) rows.push(["spread", `± ${length(known.spread)}`]);
  if (known.error !== null) rows.push(["off the truth by", length(known.error)]);
  return { title: `${known.frontier ? "Frontier, where knowledge ends" : "Wall face"}, ${length(known.length)}`, rows, views: known.views };
}

function doorTold({ name, confidence, views }, [x, y, endX, endY]) {
  const rows = [["width", length(Math.hypot(endX - x, endY - y))], ["confidence", `${Math.round(100 * confidence)} %`], ["seen by", several(views.length, "view")], ["views", listed(views)]];
  return { title: `Door “${name}”`, rows, views };
}

export function length(metres) { return metres < 1 ? `${(100 * metres).toFixed(1)} cm` : `${metres.toFixed(2)} m`; }

export function several(count, noun) { return `${count} ${noun}${count === 1 ? "" : "s"}`; }

// Numbers counted from 1, runs of them drawn together: 1–4, 7, 9–12.
export function listed(views, most = 9) {
  const runs = [];
  for (const view of views) {
    const last = runs.at(-1);
    if (last && last[1] === view - 1) last[1] = view;
    else runs.push([view, view]);
  }
  const words = runs.slice(0, most).map(([first, last]) => (first === last ? `${first + 1}` : `${first + 1}–${last + 1}`));
  return words.length ? words.join(", ") + (runs.length > most ? ", …" : "") : "none";
}

function bodyAt(book, x, y) {
  const probe = (bodyAt.probe ??= new OffscreenCanvas(1, 1).getContext("2d"));
  const body = [...bodies(book, true), ...bodies(book, false)].find(({ path }) => probe.isPointInPath(path, x, y, "evenodd"));
  return body ? { kind: "body", body } : null;
}

function fromSegment(x, y, ends, at) {
  const alongX = ends[at + 2] - ends[at], alongY = ends[at + 3] - ends[at + 1];
  const span = alongX * alongX + alongY * alongY;
  const share = span ? Math.min(1, Math.max(0, ((x - ends[at]) * alongX + (y - ends[at + 1]) * alongY) / span)) : 0;
  return Math.hypot(x - ends[at] - share * alongX, y - ends[at + 1] - share * alongY);
}
