// The camera: which part of the plane is on the screen. Screen in CSS pixels, world in metres with y up.

const LEAST = 0.5, MOST = 3000; // pixels a metre

export class Camera {
  constructor() { Object.assign(this, { x: 0, y: 0, scale: 60, width: 1, height: 1, moved: false }); }

  toScreen(x, y) { return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale]; }

  toWorld(left, top) { return [this.x + (left - this.width / 2) / this.scale, this.y - (top - this.height / 2) / this.scale]; }

  pan(right, down) { this.x -= right / this.scale; this.y += down / this.scale; this.moved = true; }

  zoom(factor, left = this.width / 2, top = this.height / 2) {
    const [x, y] = this.toWorld(left, top);
    this.scale = Math.min(MOST, Math.max(LEAST, this.scale * factor));
    const [newX, newY] = this.toWorld(left, top);
    this.x += x - newX;
    this.y += y - newY;
    this.moved = true;
  }

  // Show a box whole, with some air around it; from then on it follows the map until somebody moves it.
  fit([left, bottom, right, top]) {
    const air = Math.min(48, 0.08 * Math.min(this.width, this.height));
    const wide = Math.max(right - left, 0.5), high = Math.max(top - bottom, 0.5);
    this.scale = Math.min(MOST, Math.max(LEAST, Math.min((this.width - 2 * air) / wide, (this.height - 2 * air) / high)));
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
    this.moved = false;
  }

  // From world to the pixels of a canvas with `ratio` of them in a CSS pixel and a margin of `margin` CSS pixels.
  matrix(ratio, margin = 0) {
    const scale = this.scale * ratio;
    return [scale, 0, 0, -scale, ratio * (margin + this.width / 2) - this.x * scale, ratio * (margin + this.height / 2) + this.y * scale];
  }
}
