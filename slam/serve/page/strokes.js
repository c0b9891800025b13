// The strokes that all pictures share: paths, ellipses and colours, in metres or pixels.

export function line(context, x, y, right, down) { context.moveTo(x, y); context.lineTo(x + right, y + down); }

// The ellipse of two standard deviations of a covariance xx, xy, yy.
export function ellipse(path, x, y, xx, xy, yy) {
  const mean = (xx + yy) / 2, reach = Math.hypot((xx - yy) / 2, xy), angle = Math.atan2(2 * xy, xx - yy) / 2;
  const long = 2 * Math.sqrt(Math.max(mean + reach, 0)), short = 2 * Math.sqrt(Math.max(mean - reach, 0));
  path.moveTo(x + long * Math.cos(angle), y + long * Math.sin(angle));
  path.ellipse(x, y, long, short, angle, 0, 2 * Math.PI);
}

// Lines grow thinner where much of the world is on the screen.
export function weight({ scale, ratio }) { return Math.min(1, Math.max(0.5, scale / ratio / 40)); }

export function toWorld(context, scene) { context.setTransform(...scene.matrix); }

export function pathOf(owner, name, make) {
  owner.paths ??= {};
  return (owner.paths[name] ??= make(owner));
}

export function rings(corners, counts) {
  const path = new Path2D();
  let at = 0;
  for (const count of counts) {
    for (let i = 0; i < count; i++, at += 2) (i ? path.lineTo(corners[at], corners[at + 1]) : path.moveTo(corners[at], corners[at + 1]));
    path.closePath();
  }
  return path;
}

export function dot(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

// A CSS colour as the 32 bits of one pixel.
export function packed(ink) {
  const probe = new OffscreenCanvas(1, 1).getContext("2d");
  probe.fillStyle = ink;
  probe.fillRect(0, 0, 1, 1);
  return new Uint32Array(probe.getImageData(0, 0, 1, 1).data.buffer)[0];
}
