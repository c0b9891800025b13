// The layers of the scene, from the ground up: what each is called, whether there is any of it, and how it is drawn.
//
// A layer's `paint(context, scene)` is a generator; it yields how many points it drew, so that the painter can pause.
// scene: { book, shown, inks, matrix, scale, ratio }; lengths in metres are divided by scale to become pixels.

import { EDGE } from "./book.js";

const SUPPORT_STEPS = [1, 2, 4, 8]; // views; an edge with more than the last is drawn strongest
const BATCH = 24;                   // scans drawn before the painter is asked whether to pause

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

function line(context, x, y, right, down) { context.moveTo(x, y); context.lineTo(x + right, y + down); }

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

function* fillRings(context, scene, name, ink) {
  if (!scene.book.room) return;
  toWorld(context, scene);
  context.fillStyle = ink;
  context.fill(pathOf(scene.book.room, name, (room) => rings(room[name], room[`${name}Counts`])), "evenodd");
  yield scene.book.room[name].length;
}

// Points straight into pixels: a hundred thousand of them cost no more than a few strokes.
function* paintPoints(context, scene, ink, strength, pointsOf) {
  const { width, height } = context.canvas, size = Math.max(1, Math.round(1.5 * scene.ratio));
  const sheet = new ImageData(width, height), pixels = new Uint32Array(sheet.data.buffer), colour = packed(ink);
  const [scale, , , , right, down] = scene.matrix;
  for (let index = 0; index < scene.shown; index++) {
    const scan = scene.book.scanAt(index);
    if (!scan) continue;
    const points = pointsOf(scan), [x, y, heading] = scene.book.poseOf(index);
    const cosine = Math.cos(heading), sine = Math.sin(heading);
    for (let i = 0; i < points.length; i += 2) {
      const column = Math.round((x + cosine * points[i] - sine * points[i + 1]) * scale + right);
      const row = Math.round(down - (y + sine * points[i] + cosine * points[i + 1]) * scale);
      if (column < 0 || row < 0 || column + size > width || row + size > height) continue;
      for (let v = 0; v < size; v++) pixels.fill(colour, (row + v) * width + column, (row + v) * width + column + size);
    }
    yield points.length / 8;
  }
  const carrier = new OffscreenCanvas(width, height);
  carrier.getContext("2d").putImageData(sheet, 0, 0);
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.globalAlpha = strength;
  context.drawImage(carrier, 0, 0);
  yield 2000;
}

function* paintRaw(context, scene) {
  yield* paintPoints(context, scene, scene.inks.raw, 0.85, (scan) => (scan.paths.heard ??= heard(scan)));
}

function* paintFillers(context, scene) {
  yield* paintPoints(context, scene, scene.inks.filler, 0.4, (scan) => scan.fillers);
}

// Readings with an echo, two numbers each.
function heard(scan) {
  return scan.raw.filter((_, i) => scan.lost[i >> 1] === 0);
}

function* paintRedrawn(context, scene) {
  const looks = [[EDGE.REAL, scene.inks.redrawn, 1.1, []], [EDGE.OCCLUSION, scene.inks.filler, 0.8, [2, 2]], [EDGE.NO_RETURN, scene.inks.muted, 0.7, [1, 3]], [EDGE.DOOR_ARC, scene.inks.door, 1.3, []]];
  for (const [kind, ink, width, dashes] of looks) {
    context.strokeStyle = ink;
    yield* eachScan(context, scene, 0, (scan) => {
      context.lineWidth = (width * scene.ratio) / scene.scale;
      context.setLineDash(dashes.map((dash) => (dash * scene.ratio) / scene.scale));
      const path = pathOf(scan, `edges${kind}`, () => edgesOfKind(scan, kind));
      context.stroke(path);
      return path.points;
    });
  }
}

function edgesOfKind({ ring, edges }, kind) {
  const path = new Path2D();
  let joined = false;
  path.points = 0;
  for (let i = 0; i < edges.length; i++) {
    const next = (i + 1) % edges.length;
    if (edges[i] === kind) {
      if (!joined) path.moveTo(ring[2 * i], ring[2 * i + 1]);
      path.lineTo(ring[2 * next], ring[2 * next + 1]);
      path.points += 4;
    }
    joined = edges[i] === kind && next !== 0;
  }
  return path;
}

function* paintBodies(context, scene, inferred) {
  const { room } = scene.book;
  if (!room) return;
  toWorld(context, scene);
  const ink = inferred ? scene.inks.inferred : scene.inks.body;
  for (const body of bodies(scene.book, inferred)) {
    if (Math.min(...body.views, room.views - 1) >= scene.shown) continue;
    context.globalAlpha = inferred ? 0.16 : 0.3;
    context.fillStyle = context.strokeStyle = ink;
    context.fill(body.path, "evenodd");
    context.globalAlpha = 1;
    context.lineWidth = (1.3 * scene.ratio) / scene.scale;
    context.setLineDash(inferred ? [(4 * scene.ratio) / scene.scale, (3 * scene.ratio) / scene.scale] : []);
    context.stroke(body.path);
  }
  yield 500;
}

function* paintFrontiers(context, scene) {
  yield* strokeEdges(context, scene, (room, edge) => room.frontier[edge] === 1, scene.inks.frontier, 1.5, [5, 4]);
}

// The more views measured a face, the heavier and darker it is.
function* paintWalls(context, scene) {
  for (let step = 0; step <= SUPPORT_STEPS.length; step++) {
    const least = step ? SUPPORT_STEPS[step - 1] : -1, most = SUPPORT_STEPS[step] ?? Infinity;
    const chosen = (room, edge) => !room.frontier[edge] && room.support[edge] > least && room.support[edge] <= most;
    context.globalAlpha = 0.45 + 0.55 * (step / SUPPORT_STEPS.length);
    yield* strokeEdges(context, scene, chosen, scene.inks.wall, 1.1 + 0.45 * step, []);
  }
}

function* strokeEdges(context, scene, chosen, ink, width, dashes) {
  const { room, firstView } = scene.book;
  if (!room) return;
  toWorld(context, scene);
  context.strokeStyle = ink;
  context.lineCap = dashes.length ? "butt" : "round";
  context.lineWidth = (width * weight(scene) * scene.ratio) / scene.scale;
  context.setLineDash(dashes.map((dash) => (dash * scene.ratio) / scene.scale));
  context.beginPath();
  for (let edge = 0; edge < room.support.length; edge++) {
    if (!chosen(room, edge) || firstView[edge] >= scene.shown) continue;
    context.moveTo(room.lines[4 * edge], room.lines[4 * edge + 1]);
    context.lineTo(room.lines[4 * edge + 2], room.lines[4 * edge + 3]);
  }
  context.stroke();
  yield room.lines.length / 2;
}

function* paintDoors(context, scene) {
  const { room } = scene.book;
  if (!room) return;
  toWorld(context, scene);
  context.strokeStyle = context.fillStyle = scene.inks.door;
  context.lineWidth = (3 * scene.ratio) / scene.scale;
  for (const [number, door] of room.doors.entries()) {
    if (Math.min(...door.views, room.views - 1) >= scene.shown) continue;
    const [x, y, endX, endY] = room.jambs.subarray(4 * number, 4 * number + 4);
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(endX, endY);
    context.stroke();
    for (const [left, up] of [[x, y], [endX, endY]]) dot(context, left, up, (3.4 * scene.ratio) / scene.scale);
  }
  yield 100;
}

function* paintKnots(context, scene) {
  context.strokeStyle = context.fillStyle = scene.inks.knot;
  context.globalAlpha = 0.75;
  yield* eachScan(context, scene, 0, (scan) => {
    context.lineWidth = scene.ratio / scene.scale;
    context.stroke(pathOf(scan, "knots", () => ellipses(scan.knots, scan.doubts)));
    context.beginPath();
    const half = scene.ratio / scene.scale;
    for (let i = 0; i < scan.knots.length; i += 2) context.rect(scan.knots[i] - half, scan.knots[i + 1] - half, 2 * half, 2 * half);
    context.fill();
    return scan.knots.length * 20;
  });
}

function ellipses(places, doubts) {
  const path = new Path2D();
  for (let i = 0; 2 * i < places.length; i++) ellipse(path, places[2 * i], places[2 * i + 1], ...doubts.subarray(3 * i, 3 * i + 3));
  return path;
}

// The ellipse of two standard deviations of a covariance xx, xy, yy.
export function ellipse(path, x, y, xx, xy, yy) {
  const mean = (xx + yy) / 2, reach = Math.hypot((xx - yy) / 2, xy), angle = Math.atan2(2 * xy, xx - yy) / 2;
  const long = 2 * Math.sqrt(Math.max(mean + reach, 0)), short = 2 * Math.sqrt(Math.max(mean - reach, 0));
  path.moveTo(x + long * Math.cos(angle), y + long * Math.sin(angle));
  path.ellipse(x, y, long, short, angle, 0, 2 * Math.PI);
}

function* paintLandmarks(context, scene) {
  const places = scene.book.room?.landmarks ?? [];
  toWorld(context, scene);
  context.strokeStyle = scene.inks.landmark;
  context.lineWidth = (1.4 * scene.ratio) / scene.scale;
  const arm = (5 * scene.ratio) / scene.scale;
  context.beginPath();
  for (let i = 0; i < places.length; i += 2) {
    line(context, places[i] - arm, places[i + 1], 2 * arm, 0);
    line(context, places[i], places[i + 1] - arm, 0, 2 * arm);
  }
  context.stroke();
  yield places.length;
}

function* paintDrive(context, scene) {
  const { book, shown } = scene, dotted = new Path2D(), path = new Path2D(), size = (1.8 * weight(scene) * scene.ratio) / scene.scale;
  toWorld(context, scene);
  context.strokeStyle = context.fillStyle = scene.inks.drive;
  context.lineWidth = (1.1 * weight(scene) * scene.ratio) / scene.scale;
  for (let index = 0; index < shown; index++) {
    const pose = book.poseOf(index);
    if (!pose || book.mapped[index] === 0) continue;
    path.lineTo(pose[0], pose[1]);
    dotted.rect(pose[0] - size, pose[1] - size, 2 * size, 2 * size);
    const doubt = book.doubts?.subarray(3 * index, 3 * index + 3);
    if (doubt && 2 * Math.sqrt(doubt[0] + doubt[2]) > 2 * size) turnedEllipse(path, pose, doubt); // else the dot hides it
  }
  context.globalAlpha = 0.8;
  context.stroke(path);
  context.fill(dotted);
  yield shown * 12;
}

// A covariance in the robot's axes, drawn in the room's.
function turnedEllipse(path, [x, y, heading], [xx, xy, yy]) {
  const c = Math.cos(heading), s = Math.sin(heading);
  ellipse(path, x, y, c * c * xx - 2 * c * s * xy + s * s * yy, c * s * (xx - yy) + (c * c - s * s) * xy, s * s * xx + 2 * c * s * xy + c * c * yy);
  path.moveTo(x, y);
}

function* paintTruth(context, scene) {
  const { truth, room } = scene.book;
  if (!truth) return;
  toWorld(context, scene);
  context.lineCap = "round";
  if (truth.errors && room.final) yield* paintErrors(context, scene);
  context.strokeStyle = scene.inks.truth;
  context.lineWidth = (1.4 * scene.ratio) / scene.scale;
  if (truth.true) context.stroke(pathOf(truth, "true", () => rings(truth.true, truth.trueCounts)));
  context.strokeStyle = scene.inks.error;
  context.beginPath();
  for (let index = 0; index < Math.min(scene.shown, (truth.places?.length ?? 0) / 2); index++) {
    const pose = scene.book.poseOf(index);
    if (scene.book.mapped[index] === 0) continue;
    context.moveTo(truth.places[2 * index], truth.places[2 * index + 1]);
    context.lineTo(pose[0], pose[1]);
  }
  context.stroke();
  yield 1000;
}

// A wall that is off by ten centimetres or more is as red as can be.
function* paintErrors(context, scene) {
  const { room, truth } = scene.book;
  context.strokeStyle = scene.inks.error;
  context.lineWidth = (5 * scene.ratio) / scene.scale;
  for (let edge = 0; edge < truth.errors.length; edge++) {
    if (truth.errors[edge] < 0) continue;
    context.globalAlpha = Math.min(1, truth.errors[edge] / 0.1);
    context.beginPath();
    context.moveTo(room.lines[4 * edge], room.lines[4 * edge + 1]);
    context.lineTo(room.lines[4 * edge + 2], room.lines[4 * edge + 3]);
    context.stroke();
  }
  context.globalAlpha = 1;
  yield room.lines.length * 2;
}

// Draw each scan from `first` in its own frame; `draw` returns how many points it took.
function* eachScan(context, scene, first, draw) {
  const [a, b, c, d, e, f] = scene.matrix;
  let drawn = 0;
  for (let index = first; index < scene.shown; index++) {
    const scan = scene.book.scanAt(index);
    if (!scan) continue;
    const [x, y, heading] = scene.book.poseOf(index), cosine = Math.cos(heading), sine = Math.sin(heading);
    context.setTransform(a, b, c, d, e, f);
    context.transform(cosine, sine, -sine, cosine, x, y);
    drawn += draw(scan);
    if (index % BATCH === 0) { yield drawn; drawn = 0; }
  }
  yield drawn;
}

// Lines grow thinner where much of the world is on the screen.
function weight({ scale, ratio }) { return Math.min(1, Math.max(0.5, scale / ratio / 40)); }

function toWorld(context, scene) { context.setTransform(...scene.matrix); }

function pathOf(owner, name, make) {
  owner.paths ??= {};
  return (owner.paths[name] ??= make(owner));
}

function closedRing({ ring }) { return rings(ring, [ring.length / 2]); }

export function rings(corners, counts) {
  const path = new Path2D();
  let at = 0;
  for (const count of counts) {
    for (let i = 0; i < count; i++, at += 2) (i ? path.lineTo(corners[at], corners[at + 1]) : path.moveTo(corners[at], corners[at + 1]));
    path.closePath();
  }
  return path;
}

// The obstacles of the map with their outlines, measured or inferred ones.
export function bodies(book, inferred) {
  const { room } = book;
  if (!room) return [];
  room.outlined ??= room.obstacles.map((body, number) => {
    const chosen = [];
    let at = 0;
    for (const [ring, count] of room.bodiesCounts.entries()) {
      if (room.bodiesOwners[ring] === number) chosen.push([at, count]);
      at += 2 * count;
    }
    const path = new Path2D();
    for (const [start, count] of chosen) path.addPath(rings(room.bodies.subarray(start, start + 2 * count), [count]));
    return { ...body, path };
  });
  return room.outlined.filter((body) => body.inferred === inferred);
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

export function dot(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

// A CSS colour as the 32 bits of one pixel.
function packed(ink) {
  const probe = new OffscreenCanvas(1, 1).getContext("2d");
  probe.fillStyle = ink;
  probe.fillRect(0, 0, 1, 1);
  return new Uint32Array(probe.getImageData(0, 0, 1, 1).data.buffer)[0];
}
