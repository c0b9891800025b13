// The painter: paints the scene in slices, so that the page never waits for it, and shows the last picture meanwhile.
//
// A picture belongs to a camera. While the camera moves, the newest whole picture is shown moved and scaled; a sharp one
// is painted behind it. `paint(context, view)` is a generator that yields the work it just did, in points drawn.

const MARGIN = 80;              // CSS pixels around the screen, so that a short pan shows no blank edge
const CALM = 20, SLOW = 34;     // milliseconds between frames under which a slice may grow, and over which it shrinks
const LEAST_SLICE = 2000, MOST_SLICE = 400000;

export class Painter {
  constructor(canvas, camera, paint) {
    Object.assign(this, { canvas, camera, paint, slice: 20000, asked: true, work: null, lastFrame: 0, shown: null });
    this.front = { canvas: document.createElement("canvas"), camera: null };
    this.back = { canvas: document.createElement("canvas"), camera: null };
  }

  // The scene changed: paint it anew as soon as possible.
  ask() { this.asked = true; }

  get busy() { return this.asked || this.work !== null; }

  resize(width, height) {
    this.ratio = Math.min(window.devicePixelRatio || 1, 2);
    Object.assign(this.camera, { width, height });
    this.canvas.width = Math.round(width * this.ratio);
    this.canvas.height = Math.round(height * this.ratio);
    this.work = null;
    this.ask();
  }

  // One frame: go on painting, then show the newest picture where the camera is now.
  frame(now) {
    if (!this.ratio) return; // nobody has told the size yet
    const gap = now - this.lastFrame;
    this.lastFrame = now;
    const moved = !this.front.camera || !alike(this.front.camera, this.camera);
    if (!this.work && (this.asked || moved)) this.begin();
    if (this.work) this.goOn(gap);
    if (this.fresh || !alike(this.shown, this.camera)) this.show();
  }

  begin() {
    this.asked = false;
    const { canvas } = this.back;
    const width = Math.round((this.camera.width + 2 * MARGIN) * this.ratio), height = Math.round((this.camera.height + 2 * MARGIN) * this.ratio);
    const context = canvas.getContext("2d");
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height }); // which clears it
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, width, height);
    this.back.camera = { ...this.camera };
    const view = { matrix: this.camera.matrix(this.ratio, MARGIN), scale: this.camera.scale * this.ratio, ratio: this.ratio };
    this.work = this.paint(context, view);
  }

  goOn(gap) {
    if (gap < CALM) this.slice = Math.min(MOST_SLICE, this.slice * 1.3);
    else if (gap > SLOW) this.slice = Math.max(LEAST_SLICE, this.slice * 0.6);
    for (let done = 0; done < this.slice;) {
      const step = this.work.next();
      if (step.done) {
        [this.front, this.back, this.work, this.fresh] = [this.back, this.front, null, true];
        return;
      }
      done += step.value;
    }
  }

  show() {
    const context = this.canvas.getContext("2d"), then = this.front.camera, now = this.camera;
    this.fresh = false;
    this.shown = { ...now };
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.canvas.width, this.canvas.height);
    if (!then) return;
    const zoom = now.scale / then.scale;
    const left = now.width / 2 + (then.x - now.x) * now.scale - (then.width / 2 + MARGIN) * zoom;
    const top = now.height / 2 - (then.y - now.y) * now.scale - (then.height / 2 + MARGIN) * zoom;
    context.setTransform(zoom, 0, 0, zoom, left * this.ratio, top * this.ratio);
    context.drawImage(this.front.canvas, 0, 0);
  }
}

function alike(one, other) {
  return one && one.x === other.x && one.y === other.y && one.scale === other.scale && one.width === other.width && one.height === other.height;
}
