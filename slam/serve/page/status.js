// What the page says in words beside its picture: how far a run is, how long a metre is, and what a listener should hear.

const element = (id) => document.getElementById(id);

export function showState(book, run) {
  const { opening, scans, count, room } = book;
  const counted = `scan ${scans.length} of ${book.total}`;
  const words = {
    done: () => `${count} scans · ${room ? `${room.area.toFixed(1)} m² free` : "no map"}`,
    failed: () => (scans.length ? `failed after ${counted}` : "failed before the first scan"),
    lost: () => "the server is gone: start it again and reload",
  }[book.ending] ?? (() => (opening ? `${book.stage || "merging"} · ${counted}` : run === null ? "nothing to show yet" : "reading the recording…"));
  element("state").textContent = words();
  element("stop").hidden = run === null || book.ending !== null;
  element("progress").hidden = run === null || book.ending !== null;
  if (opening) element("progress").value = scans.length / book.total;
  else element("progress").removeAttribute("value");
  element("note").hidden = !book.note;
  element("note").textContent = book.note ?? "";
  element("map").setAttribute("aria-label", room ? `Room map of ${opening.name}: ${room.area.toFixed(1)} square metres free, ${room.support.length} edges, ${room.doors.length} doors, ${room.obstacles.length} obstacles` : "Room map, empty so far");
}

export function showRuler(camera, cursor) {
  const metres = [0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200].find((step) => step * camera.scale >= 60) ?? 500;
  element("rule").style.width = `${metres * camera.scale}px`;
  element("length").textContent = metres < 1 ? `${100 * metres} cm` : `${metres} m`;
  element("where").textContent = cursor ? `${cursor[0].toFixed(2)}, ${cursor[1].toFixed(2)} m` : "";
}

export function say(words) { element("voice").textContent = words; }
