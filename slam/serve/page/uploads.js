// Uploads: files dropped on the page or chosen by hand are sent with progress, and become a run of their own.

const element = (id) => document.getElementById(id);

// sent(number) is called with the run that was begun; refused(reason) where the server said no.
export function setUpUploads(limits, sent, refused) {
  const { veil, files } = { veil: element("veil"), files: element("files") };
  let inside = 0;
  document.addEventListener("dragenter", (event) => { if (carriesFiles(event)) { inside += 1; veil.hidden = false; } });
  document.addEventListener("dragleave", (event) => { if (carriesFiles(event) && --inside <= 0) veil.hidden = true; });
  document.addEventListener("dragover", (event) => { if (carriesFiles(event)) event.preventDefault(); });
  document.addEventListener("drop", async (event) => {
    if (!carriesFiles(event)) return;
    event.preventDefault();
    inside = 0;
    veil.hidden = true;
    send(await dropped(event.dataTransfer), limits, sent, refused);
  });
  files.addEventListener("change", () => { send([...files.files], limits, sent, refused); files.value = ""; });
  const open = () => files.click();
  for (const button of [element("open"), ...document.querySelectorAll("[data-open]")]) button.addEventListener("click", open);
  element("bounds").textContent = `At most ${limits.files} files of ${limits.megabytes} MB together.`;
  return open;
}

function carriesFiles(event) { return [...(event.dataTransfer?.types ?? [])].includes("Files"); }

// The files of a drop; a folder among them gives the files that lie in it.
async function dropped(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter(Boolean);
  if (!entries.some((entry) => entry.isDirectory)) return [...transfer.files];
  const inside = await Promise.all(entries.map((entry) => (entry.isDirectory ? listing(entry) : [entry])));
  const found = inside.flat().filter((entry) => entry.isFile && !entry.name.startsWith("."));
  return Promise.all(found.map((entry) => new Promise((resolve, reject) => entry.file(resolve, reject))));
}

function listing(folder) { return new Promise((resolve, reject) => folder.createReader().readEntries(resolve, reject)); }

function send(files, limits, sent, refused) {
  if (!files.length) return;
  const size = files.reduce((total, file) => total + file.size, 0), name = files.length === 1 ? files[0].name : `${files.length} files`;
  if (size > limits.megabytes * 2 ** 20) { refused(`${name}: ${(size / 2 ** 20).toFixed(1)} MB, but at most ${limits.megabytes} MB may be sent`); return; }
  const form = new FormData(), request = new XMLHttpRequest(), bar = element("sending-progress");
  for (const file of files) form.append("files", file, file.name);
  const over = () => { element("sending").hidden = true; };
  element("sending").hidden = false;
  element("sending-what").textContent = `${name}, ${(size / 2 ** 20).toFixed(1)} MB`;
  element("sending-stop").onclick = () => request.abort();
  bar.value = 0;
  request.upload.onprogress = ({ loaded, total }) => { bar.value = loaded / total; element("sending-what").textContent = `${name}: ${Math.round((100 * loaded) / total)} % of ${(total / 2 ** 20).toFixed(1)} MB`; };
  request.onload = () => { over(); answered(request, sent, refused); };
  request.onerror = () => { over(); refused("the server cannot be reached, or it hung up"); };
  request.onabort = over;
  request.open("POST", "/runs");
  request.send(form);
}

function answered(request, sent, refused) {
  let told;
  try { told = JSON.parse(request.responseText); } catch { told = { reason: request.responseText }; }
  if (request.status === 201) sent(told.number);
  else refused(told.reason || `the server answered ${request.status}`);
}
