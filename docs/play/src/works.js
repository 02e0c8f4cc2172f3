// What the user had on the page before something else was opened: kept in this browser, to be
// opened again.

export const store = {
  get(key, otherwise) {
    try { return JSON.parse(localStorage.getItem("gapilib-" + key)) ?? otherwise; } catch { return otherwise; }
  },
  /** Whether it is kept: private windows keep nothing, and the room is limited. */
  set(key, value) {
    try { localStorage.setItem("gapilib-" + key, JSON.stringify(value)); return true; } catch { return false; }
  },
};

/** So many are kept. */
const MOST = 20;
/** Binary tables up to this size, in bytes, are kept beside the text. */
const LARGEST_BINARY = 300000;

const base64 = (bytes) => {
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text);
};

/** Files as JSON can hold them; large binary tables are left out. */
function storable(files) {
  const kept = Object.entries(files).filter(([, content]) => typeof content === "string" || content.length <= LARGEST_BINARY);
  return Object.fromEntries(kept.map(([path, content]) => [path, typeof content === "string" ? content : { base64: base64(content) }]));
}
function restored(files) {
  const bytes = ({ base64 }) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  return Object.fromEntries(Object.entries(files).map(([path, content]) => [path, typeof content === "string" ? content : bytes(content)]));
}

/** The work that was on the page when it was closed; `null` where there is none. */
export function lastWork() {
  const work = store.get("work", null);
  return work && { ...work, files: restored(work.files) };
}
/** Keeps the work for the next visit; whether this browser keeps it. */
export const keepWork = (work) => store.set("work", { ...work, files: storable(work.files) });

/** All that were put aside, the latest first. */
export function shelf() {
  return store.get("shelf", []);
}

/** Puts work aside, and returns under which number; `null` where this browser keeps nothing. */
export function putAside(work) {
  const id = Math.max(0, ...shelf().map(({ id }) => id)) + 1;
  const entry = { id, time: new Date().toISOString(), ...work, files: storable(work.files) };
  let entries = [entry, ...shelf()].slice(0, MOST);
  // The oldest go where there is no room.
  while (!store.set("shelf", entries)) {
    if (entries.length === 1) return null;
    entries = entries.slice(0, -1);
  }
  return id;
}

/** Work that was put aside. */
export function fromShelf(id) {
  const found = shelf().find((entry) => entry.id === id);
  if (!found) return null;
  // It is kept already: only what is changed from here on is new.
  const { id: _, time: __, opened: ___, ...work } = found;
  return { ...work, files: restored(work.files) };
}

export function forget(id) {
  store.set("shelf", shelf().filter((entry) => entry.id !== id));
}

/** What is in the files, short: whether something has changed since. */
export function digest(files) {
  let hash = 0;
  for (const [path, content] of Object.entries(files).sort(([a], [b]) => (a < b ? -1 : 1))) {
    const text = path + "\0" + (typeof content === "string" ? content : content.length);
    for (let at = 0; at < text.length; at++) hash = (Math.imul(hash, 31) + text.charCodeAt(at)) | 0;
  }
  return hash;
}
