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

/** So many are kept, if there is room. */
const MOST = 100;
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

/** What this window keeps for itself; `null` where the browser keeps nothing. */
const ofWindow = (act) => { try { return act(sessionStorage); } catch { return null; } };
const WINDOW = ofWindow((session) => {
  const id = session.getItem("gapilib-window") ?? Math.random().toString(36).slice(2);
  session.setItem("gapilib-window", id);
  return id;
});

/** The work that was in this window, or else on the page when it was closed; `null` where there is none. */
export function lastWork() {
  const work = ofWindow((session) => JSON.parse(session.getItem("gapilib-work"))) ?? store.get("work", null);
  return work && { ...work, files: restored(work.files) };
}
/** Keeps the work for the next visit; whether this browser keeps it. */
export function keepWork(work) {
  const entry = { ...work, window: WINDOW, files: storable(work.files) };
  rescue();
  ofWindow((session) => session.setItem("gapilib-work", JSON.stringify(entry)));
  return store.set("work", entry);
}
/** Puts aside what another window has kept, before it is replaced; lessons are kept by their number. */
function rescue() {
  const other = store.get("work", null);
  const isOther = other?.window && other.window !== WINDOW && !other.lesson;
  if (!isOther || digest(restored(other.files)) === other.opened) return;
  const others = shelf().filter((entry) => entry.window !== other.window);
  store.set("shelf", [{ ...other, id: nextId(), time: new Date().toISOString() }, ...others]);
}

/** All that were put aside, the latest first. */
export function shelf() {
  return store.get("shelf", []);
}

const nextId = () => Math.max(0, ...shelf().map(({ id }) => id)) + 1;

/** Puts work aside, and returns under which number; `null` where this browser keeps nothing. */
export function putAside(work) {
  const id = nextId();
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
  const { id: _, time: __, opened: ___, window: ____, ...work } = found;
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
