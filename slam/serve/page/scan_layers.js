// What single scans show: echoes, redrawn boundaries, fillers, knots, and the drive that ties them together.

import { EDGE } from "./book.js";
import { ellipse, packed, pathOf, rings, toWorld, weight } from "./strokes.js";

const BATCH = 24; // scans drawn before the painter is asked whether to pause

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

export function* paintRaw(context, scene) {
  yield* paintPoints(context, scene, scene.inks.raw, 0.85, (scan) => (scan.paths.heard ??= heard(scan)));
}

export function* paintFillers(context, scene) {
  yield* paintPoints(context, scene, scene.inks.filler, 0.4, (scan) => scan.fillers);
}

// Readings with an echo, two numbers each.
function heard(scan) {
  return scan.raw.filter((_, i) => scan.lost[i >> 1] === 0);
}

export function* paintRedrawn(context, scene) {
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

export function* paintKnots(context, scene) {
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

export function* paintDrive(context, scene) {
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

// Draw each scan from `first` in its own frame; `draw` returns how many points it took.
export function* eachScan(context, scene, first, draw) {
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

export function closedRing({ ring }) { return rings(ring, [ring.length / 2]); }
