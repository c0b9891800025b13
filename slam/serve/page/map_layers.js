// What the map itself shows: areas, wall faces, frontiers, obstacles, doors, landmarks, and how far they are off.

import { dot, line, pathOf, rings, toWorld, weight } from "./strokes.js";

const SUPPORT_STEPS = [1, 2, 4, 8]; // views; an edge with more than the last is drawn strongest

export function* fillRings(context, scene, name, ink) {
  if (!scene.book.room) return;
  toWorld(context, scene);
  context.fillStyle = ink;
  context.fill(pathOf(scene.book.room, name, (room) => rings(room[name], room[`${name}Counts`])), "evenodd");
  yield scene.book.room[name].length;
}

export function* paintBodies(context, scene, inferred) {
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

export function* paintFrontiers(context, scene) {
  yield* strokeEdges(context, scene, (room, edge) => room.frontier[edge] === 1, scene.inks.frontier, 1.5, [5, 4]);
}

// The more views measured a face, the heavier and darker it is.
export function* paintWalls(context, scene) {
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

export function* paintDoors(context, scene) {
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

export function* paintLandmarks(context, scene) {
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

export function* paintTruth(context, scene) {
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
