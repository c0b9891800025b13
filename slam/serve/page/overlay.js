// The overlay: what changes with every move of the pointer, drawn over the scene each frame it changes.

import { dot, rings } from "./strokes.js";
import { length, middleOf } from "./pointing.js";

export function paintOverlay(canvas, camera, { book, shown, inks, thing, views, ends, answers, cross, ratio }) {
  const context = canvas.getContext("2d"), pixel = 1 / camera.scale;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.setTransform(...camera.matrix(ratio));
  context.lineJoin = context.lineCap = "round";
  for (const answer of answers) paintAnswer(context, answer, inks, pixel);
  paintNewest(context, book, shown, inks, pixel);
  if (thing) paintThing(context, book, thing, views, inks, pixel);
  if (ends.start) paintEnd(context, ends.start, "S", inks, pixel);
  if (ends.goal) paintEnd(context, ends.goal, "G", inks, pixel);
  if (cross) paintCross(context, camera, inks, pixel);
}

// The robot at the newest scan shown; while time is not at its end, also what that scan read.
function paintNewest(context, book, shown, inks, pixel) {
  const scan = book.scans[shown - 1], pose = book.poseOf(shown - 1);
  if (!pose) return;
  context.save();
  context.translate(pose[0], pose[1]);
  context.rotate(pose[2]);
  if (scan && (shown < book.count || !book.finished)) {
    context.strokeStyle = context.fillStyle = inks.accent;
    context.lineWidth = 1.2 * pixel;
    context.stroke(rings(scan.ring, [scan.ring.length / 2]));
    for (let i = 0; i < scan.raw.length; i += 2) if (!scan.lost[i >> 1]) context.fillRect(scan.raw[i] - pixel, scan.raw[i + 1] - pixel, 2 * pixel, 2 * pixel);
  }
  context.beginPath();
  context.moveTo(9 * pixel, 0);
  for (const [x, y] of [[-6, 5.5], [-3, 0], [-6, -5.5]]) context.lineTo(x * pixel, y * pixel);
  context.closePath();
  context.fillStyle = inks.accent;
  context.strokeStyle = inks.surface;
  context.lineWidth = 1.5 * pixel;
  context.stroke();
  context.fill();
  context.restore();
}

// The thing pointed at, and a line from it to every place it was seen from.
function paintThing(context, book, thing, views, inks, pixel) {
  const middle = middleOf(book, thing);
  context.strokeStyle = context.fillStyle = inks.accent;
  if (middle) {
    context.globalAlpha = Math.max(0.12, Math.min(0.6, 8 / views.length));
    context.lineWidth = pixel;
    context.beginPath();
    for (const view of views) {
      const pose = book.poseOf(view);
      if (!pose) continue;
      context.moveTo(...middle);
      context.lineTo(pose[0], pose[1]);
    }
    context.stroke();
    context.globalAlpha = 1;
    for (const view of views) if (book.poseOf(view)) dot(context, ...book.poseOf(view).subarray(0, 2), 3 * pixel);
  }
  context.lineWidth = 4 * pixel;
  if (thing.kind === "body") { context.stroke(thing.body.path); return; }
  const ends = thing.kind === "edge" ? book.room.lines : book.room.jambs, at = 4 * thing.number;
  context.beginPath();
  context.moveTo(ends[at], ends[at + 1]);
  context.lineTo(ends[at + 2], ends[at + 3]);
  context.stroke();
}

// A planner's path with the ground its robot covers; the gap that is too narrow where there is none.
function paintAnswer(context, { planner, poses, outline, gap, spines }, inks, pixel) {
  const ink = inks[planner] ?? inks.accent;
  context.strokeStyle = context.fillStyle = ink;
  if (spines?.length && poses.length) {
    context.globalAlpha = 0.13;
    context.lineWidth = pixel;
    context.beginPath();
    for (const [[x, y], [endX, endY]] of spines) { context.moveTo(x, y); context.lineTo(endX, endY); }
    context.stroke();
  }
  if (poses.length) {
    paintSwept(context, poses, outline);
    context.globalAlpha = 1;
    context.lineWidth = (planner === "cones" ? 4 : 2) * pixel;
    context.beginPath();
    for (const [x, y] of poses) context.lineTo(x, y);
    context.stroke();
  }
  context.globalAlpha = 1;
  if (gap) paintGap(context, gap, inks, pixel);
}

function paintSwept(context, poses, { parts, radius }) {
  context.globalAlpha = 0.12;
  if (radius) {
    context.lineWidth = 2 * radius;
    context.beginPath();
    for (const [x, y] of poses) context.lineTo(x, y);
    context.stroke();
    return;
  }
  for (const [x, y, heading] of between(poses)) {
    const cosine = Math.cos(heading), sine = Math.sin(heading);
    for (const part of parts) {
      context.beginPath();
      for (const [a, b] of part) context.lineTo(x + cosine * a - sine * b, y + sine * a + cosine * b);
      context.closePath();
      context.globalAlpha = 0.05;
      context.fill();
      context.globalAlpha = 0.35;
      context.lineWidth = 0.004;
      context.stroke();
    }
  }
}

// Poses along a path, a quarter of a metre or a fifth of a radian apart at most.
function* between(poses) {
  yield poses[0];
  for (let i = 1; i < poses.length; i++) {
    const [from, to] = [poses[i - 1], poses[i]];
    const steps = Math.ceil(Math.max(Math.hypot(to[0] - from[0], to[1] - from[1]) / 0.25, Math.abs(to[2] - from[2]) / 0.2, 1));
    for (let step = 1; step <= steps; step++) yield from.map((value, axis) => value + ((to[axis] - value) * step) / steps);
  }
}

// The two walls that leave too little room, and how much there is between them.
function paintGap(context, { edges, narrowest: [here, there], width, needed }, inks, pixel) {
  context.strokeStyle = inks.error;
  context.lineWidth = 4 * pixel;
  for (const [[x, y], [endX, endY]] of edges) {
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(endX, endY);
    context.stroke();
  }
  context.setLineDash([5 * pixel, 5 * pixel]);
  context.lineWidth = 2 * pixel;
  context.beginPath();
  context.moveTo(...here);
  context.lineTo(...there);
  context.stroke();
  context.setLineDash([]);
  context.save();
  context.translate((here[0] + there[0]) / 2, (here[1] + there[1]) / 2);
  context.scale(pixel, -pixel);
  context.font = `600 12px ${inks.sans}`;
  context.textAlign = "center";
  context.lineWidth = 4;
  context.strokeStyle = inks.surface;
  context.fillStyle = inks.error;
  const says = `${length(width)}, needs ${length(needed)}`;
  context.strokeText(says, 0, -16);
  context.fillText(says, 0, -16);
  context.restore();
}

function paintEnd(context, [x, y], letter, inks, pixel) {
  context.save();
  context.translate(x, y);
  context.scale(pixel, -pixel);
  context.fillStyle = inks.surface;
  dot(context, 0, 0, 12);
  context.fillStyle = inks.ink;
  dot(context, 0, 0, 10.5);
  context.fillStyle = inks.surface;
  context.font = `600 12px ${inks.sans}`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  context.fillText(letter, 0, 0.5);
  context.restore();
}

function paintCross(context, camera, inks, pixel) {
  context.strokeStyle = inks.accent;
  context.lineWidth = 1.5 * pixel;
  context.beginPath();
  for (const [right, up] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
    context.moveTo(camera.x + 4 * right * pixel, camera.y + 4 * up * pixel);
    context.lineTo(camera.x + 13 * right * pixel, camera.y + 13 * up * pixel);
  }
  context.stroke();
}
