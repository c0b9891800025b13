// The book of one run: everything the server told of it, ready to be drawn and asked.

export const EDGE = { REAL: 0, OCCLUSION: 1, NO_RETURN: 2, SIDE: 3, DOOR_ARC: 4 };

export class Book {
  constructor() {
    this.total = 0;          // scans there will be
    this.scans = [];         // one message each, in their order
    this.poses = null;       // (n, 3) flat, newest for all; null until the first are told
    this.mapped = [];        // which of them stand in the map; a scan that is not told of yet does
    this.doubts = null;      // (n, 3) flat covariances of places in the robots' axes
    this.room = null;
    this.truth = null;
    this.report = null;
    this.ending = null;      // "done", "failed" or "lost"
    this.stage = "";
    this.firstView = null;   // of every edge of the room, the first scan that measured it
    this.version = 0;        // grows with everything that changes the picture
  }

  take(message) {
    const keep = {
      opening: () => { this.opening = message; this.total = message.scans; },
      scan: () => { this.scans[message.index] = prepared(message); },
      poses: () => { this.poses = message.poses; this.doubts = message.doubts ?? null; this.mapped = message.mapped; },
      room: () => { this.room = message; this.firstView = firstViews(message); },
      truth: () => { this.truth = message; },
      report: () => { this.report = message; },
      stage: () => { this.stage = message.says; },
      note: () => { this.note = message.says; },
      done: () => { this.ending = "done"; },
      failed: () => { this.ending = "failed"; this.reason = message.reason; },
    }[message.kind];
    keep?.();
    this.version += 1;
  }

  // How many scans the time slider spans.
  get count() { return Math.max(this.scans.length, this.room?.views ?? 0); }

  get finished() { return this.room?.final === true; }

  // A scan that is known and not left out of the map, else null.
  scanAt(index) { return this.mapped[index] === 0 ? null : this.scans[index] ?? null; }

  // The pose of a scan: the newest that was told, else where it was believed to be when it was taken.
  poseOf(index) {
    if (this.poses && 3 * index < this.poses.length) return this.poses.subarray(3 * index, 3 * index + 3);
    return this.scans[index]?.pose ?? null;
  }

  // Left, bottom, right, top of all that is known; null as long as nothing is.
  bounds() {
    const box = [Infinity, Infinity, -Infinity, -Infinity];
    const points = this.room ? this.room.lines : [];
    for (let i = 0; i < points.length; i += 2) stretch(box, points[i], points[i + 1]);
    const from = this.room ? this.room.views : 0;
    for (let index = from; index < this.scans.length; index++) {
      if (!this.scanAt(index)) continue;
      const pose = this.poseOf(index);
      const cosine = Math.cos(pose[2]), sine = Math.sin(pose[2]), ring = this.scans[index].ring;
      for (let i = 0; i < ring.length; i += 2) {
        stretch(box, pose[0] + cosine * ring[i] - sine * ring[i + 1], pose[1] + sine * ring[i] + cosine * ring[i + 1]);
      }
    }
    return box[0] < box[2] ? box : null;
  }

  // The views that support edge `number`, and what else is known of it.
  provenance(number) {
    const room = this.room;
    let start = 0;
    for (let i = 0; i < number; i++) start += room.seenCount[i];
    return {
      frontier: room.frontier[number] === 1,
      length: Math.hypot(room.lines[4 * number + 2] - room.lines[4 * number], room.lines[4 * number + 3] - room.lines[4 * number + 1]),
      support: room.support[number],
      contradictions: room.contradictions[number],
      spread: room.spread[number] < 0 ? null : room.spread[number],
      views: room.seenBy.subarray(start, start + room.seenCount[number]),
      error: this.truth?.errors && this.truth.errors[number] >= 0 ? this.truth.errors[number] : null,
    };
  }
}

function prepared(message) {
  message.paths = {}; // by layer, in the robot's frame: poses change, these do not
  return message;
}

function firstViews(room) {
  const first = new Int32Array(room.seenCount.length);
  let at = 0;
  for (let edge = 0; edge < first.length; edge++) {
    let least = room.seenCount[edge] ? Infinity : room.views - 1;
    for (let i = 0; i < room.seenCount[edge]; i++) least = Math.min(least, room.seenBy[at++]);
    first[edge] = least;
  }
  return first;
}

function stretch(box, x, y) {
  if (x < box[0]) box[0] = x;
  if (y < box[1]) box[1] = y;
  if (x > box[2]) box[2] = x;
  if (y > box[3]) box[3] = y;
}
