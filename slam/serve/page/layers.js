// The layers of the scene, from the ground up: what each is called, whether there is any of it, and how it is drawn.
//
// A layer's `paint(context, scene)` is a generator; it yields how many points it drew, so that the painter can pause.
// scene: { book, shown, inks, matrix, scale, ratio }; lengths in metres are divided by scale to become pixels.

import { bodies, fillRings, paintBodies, paintDoors, paintFrontiers, paintLandmarks, paintTruth, paintWalls } from "./map_layers.js";
import { closedRing, eachScan, paintDrive, paintFillers, paintKnots, paintRaw, paintRedrawn } from "./scan_layers.js";
import { line, pathOf } from "./strokes.js";

export const LAYERS = [
  { id: "free", name: "Free space", on: true, count: (book) => (book.room?.final ? `${book.room.area.toFixed(1)} m²` : ""), paint: paintFree },
  { id: "safety", name: "Safe to plan on", on: false, count: () => "", paint: (context, scene) => fillRings(context, scene, "safety", scene.inks.safety) },
  { id: "raw", name: "Raw scans", on: false, count: (book) => book.scans.length || "", paint: paintRaw },
  { id: "redrawn", name: "Redrawn boundaries", on: false, count: (book) => book.scans.length || "", paint: paintRedrawn },
  { id: "filler", name: "Fillers", on: false, count: (book) => sum(book, "fillers", 2) || "", paint: paintFillers },
  { id: "inferred", name: "Inferred obstacles", on: true, count: (book) => known(book, bodies(book, true).length), paint: (context, scene) => paintBodies(context, scene, true) },
  { id: "body", name: "Measured obstacles", on: true, count: (book) => known(book, bodies(book, false).length), paint: (context, scene) => paintBodies(context, scene, false) },
  { id: "frontier", name: "Frontiers", on: true, count: (book) => metres(book, 1), paint: paintFrontiers },
  { id: "wall", name: "Wall faces, by support", on: true, count: (book) => metres(book, 0), paint: paintWalls },
  { id: "door", name: "Doors", on: true, count: (book) => known(book, book.room?.doors.length), paint: paintDoors },
  { id: "knot", name: "Knots, 2σ ellipses", on: false, count: (book) => sum(book, "knots", 2) || "", paint: paintKnots },
  { id: "landmark", name: "Landmarks", on: false, count: (book) => known(book, book.room?.landmarks.length / 2), paint: paintLandmarks },
  { id: "drive", name: "Drive, 2σ ellipses", on: true, count: (book) => book.count || "", paint: paintDrive },
  { id: "truth", name: "Truth and error", on: false, count: (book) => (book.truth ? worst(book) : "unknown"), ready: (book) => book.truth !== null, paint: paintTruth },
];

export function* paintScene(context, view, { book, shown, inks, on }) {
  const scene = { book, shown, inks, ...view };
  yield* paintGrid(context, scene);
  for (const layer of LAYERS) {
    if (!on[layer.id]) continue;
    context.save();
    yield* layer.paint(context, scene);
    context.restore();
  }
}

// Metres, tens of them, or decimetres, whichever makes squares of a sensible size; painted, so that it moves along.
function* paintGrid(context, scene) {
  const step = [0.1, 1, 10, 100].find((metres) => metres * scene.scale > 34 * scene.ratio) ?? 1000;
  const [scale, , , , right, down] = scene.matrix, { width, height } = context.canvas;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.strokeStyle = scene.inks.grid;
  context.lineWidth = 1;
  context.beginPath();
  for (let x = Math.ceil(-right / scale / step) * step; x * scale + right < width; x += step) line(context, Math.round(x * scale + right) + 0.5, 0, 0, height);
  for (let y = Math.ceil((down - height) / scale / step) * step; down - y * scale > 0; y += step) line(context, 0, Math.round(down - y * scale) + 0.5, width, 0);
  context.stroke();
  yield 100;
}

// At the end the map's own free space; before it, the union of what the views so far call free.
function* paintFree(context, scene) {
  const { book, shown } = scene, whole = book.room && shown >= book.room.views;
  if (whole) yield* fillRings(context, scene, "free", scene.inks.free);
  context.fillStyle = scene.inks.free;
  yield* eachScan(context, scene, whole ? book.room.views : 0, (scan) => {
    context.fill(pathOf(scan, "ring", closedRing));
    return scan.ring.length;
  });
}

// A number of things on the map, or that there are none; nothing while there is no map.
function known(book, number) { return book.room ? number || "none" : ""; }

function sum(book, name, size) {
  return book.scans.reduce((total, scan) => total + (scan ? scan[name].length / size : 0), 0);
}

function metres(book, frontier) {
  if (!book.room) return "";
  let total = 0;
  for (let edge = 0; edge < book.room.frontier.length; edge++) {
    if (book.room.frontier[edge] === frontier) total += Math.hypot(book.room.lines[4 * edge + 2] - book.room.lines[4 * edge], book.room.lines[4 * edge + 3] - book.room.lines[4 * edge + 1]);
  }
  return `${total.toFixed(1)} m`;
}

function worst(book) {
  return book.truth.errors ? `≤ ${(100 * Math.max(0, ...book.truth.errors)).toFixed(0)} cm` : "";
}
