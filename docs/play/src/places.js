// Places in messages: links into the editor.

const PLACES = [
  // A diagnostic: `script.mos:3:17`.
  { pattern: /([\w.\-/]+\.(?:mos?|toml)):(\d+):(\d+)/g, isCell: false },
  // A table: "`data.csv`: line 2, column 2".
  { pattern: /`([^`\n]+\.(?:csv|txt))`: line (\d+)(?:, column (\d+))?/g, isCell: true },
];

/** The places in a text, in order: `{ from, to, name, line, column, isCell }`. */
export function places(text) {
  const found = PLACES.flatMap(({ pattern, isCell }) => [...text.matchAll(pattern)].map((match) => ({
    from: match.index, to: match.index + match[0].length, name: match[1], line: Number(match[2]), column: Number(match[3] ?? 1), isCell,
  })));
  return found.sort((a, b) => a.from - b.from);
}

/** Appends a text to an element; its places in files are links. `go(place)` returns a function that goes
 * there, or nothing where the file is not on the page. */
export function appendLinked(element, text, go) {
  let from = 0;
  for (const place of places(text)) {
    const follow = place.from >= from && go(place);
    if (!follow) continue;
    const link = document.createElement("a");
    link.href = "#";
    link.textContent = text.slice(place.from, place.to);
    link.addEventListener("click", (event) => { event.preventDefault(); follow(); });
    element.append(text.slice(from, place.from), link);
    from = place.to;
  }
  element.append(text.slice(from));
}
