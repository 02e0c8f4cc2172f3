// All of the work as a link, and as files.

const stream = async (bytes, through) => new Uint8Array(await new Response(new Blob([bytes]).stream().pipeThrough(through)).arrayBuffer());

function base64url(bytes) {
  let text = "";
  for (let at = 0; at < bytes.length; at += 8192) text += String.fromCharCode(...bytes.subarray(at, at + 8192));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The work in the fragment of a link: JSON, compressed, in base64 for addresses. */
export async function packed(work) {
  return base64url(await stream(new TextEncoder().encode(JSON.stringify(work)), new CompressionStream("deflate-raw")));
}

/** What `packed` has made; `null` where the text is no such thing. */
export async function unpacked(text) {
  try {
    const bytes = Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
    const work = JSON.parse(new TextDecoder().decode(await stream(bytes, new DecompressionStream("deflate-raw"))));
    return work && typeof work.files === "object" && typeof work.main === "string" ? work : null;
  } catch {
    return null;
  }
}

/** Statements that write a table where it does not exist yet: the script runs any number of times, and does
 * not replace a file that the user has put there. */
function tableOnce(path, content, name) {
  return [
    `// The data of ${path}: written beside the script, unless there is a file of this name.`,
    `${name} := ${content};`,
    `if not Modelica.Utilities.Files.exist("${path}") then`,
    `  Is_Written := writeFile("${path}", ${name});`,
    `elseif OpenModelica.Scripting.readFile("${path}") <> ${name} then`,
    `  print("${path} is used as it is: it differs from the table in this script");`,
    "end if",
  ].join("\n");
}

/**
 * The problem as one script for `gapi run`: the scripts that the main one runs are put in their
 * places, the model in front of them, and tables are written before they are read. `null` where this
 * cannot be done without changing what the scripts mean: then it takes an archive.
 */
export function oneScript(files, main) {
  const beside = (from, name) => (from.includes("/") ? from.slice(0, from.lastIndexOf("/") + 1) : "") + name;
  const models = Object.keys(files).filter((path) => path.endsWith(".mo"));
  const tables = Object.keys(files).filter((path) => /\.(csv|txt)$/.test(path));
  const rest = Object.keys(files).filter((path) => !/\.(mos|mo|csv|txt)$/.test(path));
  const isPackage = models.some((path) => /(^|\/)package\.mo$/.test(path) || /^\s*within\s+\w/m.test(files[path]));
  if (rest.length || isPackage || [...models, ...tables].some((path) => path.includes("/"))) return null;
  let whole = true;
  const inlined = (path, depth) => {
    if (files[path] === undefined || depth > 20) { whole = false; return ""; }
    return files[path].replace(/^([ \t]*)RunScript\("([^"]+)"\)[ \t]*;?[ \t]*$/gm, (_, indent, name) => {
      const file = beside(path, name.endsWith(".mos") ? name : name + ".mos");
      return inlined(file, depth + 1).trimEnd().split("\n").map((line) => line && indent + line).join("\n");
    });
  };
  let script = inlined(main, 0);
  if (/\bRunScript\s*\(/.test(script)) whole = false;
  for (const path of models) {
    const named = new RegExp(`^(\\s*SimuPath\\s*:?=\\s*)"${path.replaceAll(".", "\\.")}"`, "m");
    if (!named.test(script)) whole = false;
    script = script.replace(named, '$1""');
  }
  const text = (content) => JSON.stringify(content);
  const used = tables.filter((path) => script.includes(`"${path}"`));
  const written = used.map((path, k) => tableOnce(path, text(files[path]), `Table_${k + 1}`));
  if (!whole || tables.some((path) => /[^\x20-\x7e\r\n\t]/.test(files[path]))) return null;
  return [...models.map((path) => files[path].trimEnd()), ...written, script].join("\n\n");
}

const CRC = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; k++) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c >>> 0;
});
function crc32(bytes) {
  let c = 0xffffffff;
  for (const byte of bytes) c = CRC[(c ^ byte) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

/** An archive (ZIP, APPNOTE 6.3.3, without compression) of files: strings or bytes by their paths. */
export function archive(files) {
  const parts = [], central = [];
  let offset = 0;
  const numbers = (...pairs) => {
    const bytes = new Uint8Array(pairs.reduce((sum, [size]) => sum + size, 0)), view = new DataView(bytes.buffer);
    let at = 0;
    for (const [size, value] of pairs) {
      if (size === 2) view.setUint16(at, value, true); else view.setUint32(at, value, true);
      at += size;
    }
    return bytes;
  };
  for (const [path, content] of Object.entries(files)) {
    const name = new TextEncoder().encode(path);
    const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content;
    // Version 2.0, names in UTF-8, stored, 1980-01-01.
    const common = [[2, 20], [2, 0x800], [2, 0], [2, 0], [2, 33], [4, crc32(bytes)], [4, bytes.length], [4, bytes.length], [2, name.length], [2, 0]];
    parts.push(numbers([4, 0x04034b50], ...common), name, bytes);
    central.push(numbers([4, 0x02014b50], [2, 20], ...common, [2, 0], [2, 0], [2, 0], [4, 0], [4, offset]), name);
    offset += 30 + name.length + bytes.length;
  }
  const size = central.reduce((sum, part) => sum + part.length, 0), count = Object.keys(files).length;
  const end = numbers([4, 0x06054b50], [2, 0], [2, 0], [2, count], [2, count], [4, size], [4, offset], [2, 0]);
  return new Blob([...parts, ...central, end], { type: "application/zip" });
}

/** Gives the reader a file. */
export function download(name, content) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content instanceof Blob ? content : new Blob([content]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
