// Hands: pointer, wheel, pinch and keys on the map become camera moves and places in the world.

const CLICK = 6; // CSS pixels a press may wander and still be a click

// heard: { moved(), hovered(place|null, [left, top]), clicked(place, [left, top]), grabbed(place) → drag|null }
export function listen(map, camera, heard) {
  const held = new Map();
  let wandered = 0, drag = null;
  const at = (event) => { const box = map.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };

  map.addEventListener("pointerdown", (event) => {
    map.setPointerCapture(event.pointerId);
    held.set(event.pointerId, at(event));
    wandered = held.size > 1 ? Infinity : 0;
    drag = held.size === 1 ? heard.grabbed(camera.toWorld(...at(event))) : null;
  });

  map.addEventListener("pointermove", (event) => {
    const now = at(event), before = held.get(event.pointerId);
    if (!before) { heard.hovered(camera.toWorld(...now), now); return; }
    if (held.size === 2) pinch(held, event.pointerId, now, camera);
    else if (drag) drag(camera.toWorld(...now));
    else if (wandered > CLICK) camera.pan(now[0] - before[0], now[1] - before[1]);
    const step = Math.hypot(now[0] - before[0], now[1] - before[1]);
    if (wandered <= CLICK && wandered + step > CLICK) map.classList.add("dragging");
    wandered += step;
    held.set(event.pointerId, now);
    if (wandered > CLICK && !drag) heard.moved();
  });

  const release = (event) => {
    if (!held.delete(event.pointerId)) return;
    map.classList.remove("dragging");
    if (event.type === "pointerup" && wandered <= CLICK && !held.size) heard.clicked(camera.toWorld(...at(event)), at(event));
    if (!held.size) drag = null;
  };
  map.addEventListener("pointerup", release);
  map.addEventListener("pointercancel", release);
  map.addEventListener("pointerleave", () => { if (!held.size) heard.hovered(null); });

  map.addEventListener("wheel", (event) => {
    event.preventDefault();
    const pixels = event.deltaMode === 1 ? 33 * event.deltaY : event.deltaY;
    camera.zoom(Math.exp(-pixels * (event.ctrlKey ? 0.01 : 0.0016)), ...at(event));
    heard.moved();
  }, { passive: false });
}

// Two fingers: what lies under them stays under them.
function pinch(held, moving, now, camera) {
  const still = [...held].find(([id]) => id !== moving)[1], before = held.get(moving);
  const was = Math.hypot(before[0] - still[0], before[1] - still[1]), is = Math.hypot(now[0] - still[0], now[1] - still[1]);
  const middle = [(now[0] + still[0]) / 2, (now[1] + still[1]) / 2];
  camera.pan(middle[0] - (before[0] + still[0]) / 2, middle[1] - (before[1] + still[1]) / 2);
  if (was > 1) camera.zoom(is / was, ...middle);
}

// Keys that work anywhere on the page, unless something there has a better use for them.
export function listenToKeys(actions) {
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const inField = event.target.matches("select, input[type=number]");
    const onControl = event.target.matches("button, input, summary, [role=tab]");
    if (!actions[key] || (inField && key !== "Escape") || (onControl && (key === " " || key.startsWith("Arrow")))) return;
    event.preventDefault();
    actions[key]();
  });
}
