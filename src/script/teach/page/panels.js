// The panels: what each step looks like.

function showScript(step) {
  const place = step.place && DATA.scripts[step.place[0]];
  at("script-name").textContent = place ? place.name + ", line " + step.place[1] : "no line is known";
  once("script", place && step.place[0], () => at("script").replaceChildren(...(place ? place.lines : []).map((line, k) => {
    const row = document.createElement("span");
    row.textContent = String(k + 1).padStart(3) + "  " + line;
    return row;
  })));
  const before = at("script").querySelector(".now");
  if (before) { before.className = ""; before.removeAttribute("aria-current"); }
  const now = place && at("script").children[step.place[1] - 1];
  if (!now) return;
  now.className = "now";
  now.setAttribute("aria-current", "step");
  at("script").scrollTop = now.offsetTop - at("script").offsetTop - at("script").clientHeight / 2;
}

// What is known at a step: nothing about the fitness before it was computed.
const ORDER = ["initial population", "simulation", "fitness", "selection", "elite", "crossover", "mutation", "random completion", "next generation", "stop"];
const known = (step, what) => ORDER.indexOf(step.title) >= ORDER.indexOf(what);

function describe(generation, k, step) {
  const genes = genome(generation.genes, generation.n, k).map((v, j) => name(j) + " = " + short(v) + unit(j));
  const why = generation.failures.find(failure => failure[0] === k);
  let judged = "";
  if (known(step, "simulation") && why) judged = ", failed: " + why[1];
  else if (known(step, "fitness") && generation.fitness.length) judged = ", fitness " + short(generation.fitness[k]);
  return "Individual " + (k + 1) + ", " + cameAs(generation.origins[k]) + judged + ": " + genes.join(", ");
}
function cameAs(origin) {
  if (!origin || origin.script) return "set by the script";
  if (origin.random) return "drawn at random";
  if (origin.elite !== undefined) return "elite, was " + (origin.elite + 1);
  const changed = origin.mutated.length ? ", mutated in " + origin.mutated.map(name).join(", ") : "";
  if (origin.was !== undefined) return "was " + (origin.was + 1) + changed;
  return "child of " + [...new Set(origin.of)].map(k => k + 1).join(" and ") + changed;
}

// Units of a drawing across: about as many as it has pixels, so that its text stays readable; pixels
// for the rows of the population, and how many there are without folding. The columns are those of the
// style sheet.
let WIDE, TALL, ROOM;
function measure() {
  const { innerWidth, innerHeight } = window;
  const columns = innerWidth < 760 ? 1 : innerWidth < 1180 ? 2 : 3;
  WIDE = Math.round(Math.max(330, Math.min(560, (Math.min(innerWidth, 1600) - 32) / columns - 38)));
  const isPhone = columns === 1;
  TALL = isPhone ? Math.max(130, Math.min(300, innerHeight - 540)) : Math.max(240, Math.min(520, innerHeight - 380));
  ROOM = isPhone ? 12 : Math.max(12, Math.min(26, Math.floor(TALL / 16)));
}
measure();
// Which places of a long list are shown: the first ones, the last, and those that the step is about
// with their neighbours; between them, how many are folded. All where there is room.
function folded(count, focus) {
  if (count <= ROOM || at("unfold").checked) return [...Array(count).keys()].map(place => ({ place }));
  // What the step is about first, then its neighbours, the ends, and the first ones as far as there is room.
  const near = focus.flatMap(place => [place - 1, place + 1]);
  const wanted = [...focus, ...near, 0, count - 1, ...Array(ROOM).keys()].filter(place => place >= 0 && place < count);
  const shown = new Set();
  for (const place of wanted) if (shown.size < ROOM - 2) shown.add(place);
  const list = [];
  [...shown].sort((a, b) => a - b).forEach(place => {
    const before = list.length ? list[list.length - 1].place : -1;
    if (place > before + 1) list.push({ left: place - before - 1 });
    list.push({ place });
  });
  return list;
}
// The places on the left and the rows on the right that a step is about.
function focusOf(step, generation, order, made) {
  const { parents, elites } = generation;
  const rows = made ? made.map((_, row) => row).filter(row => concerns(step, generation, row)) : [];
  const from = rows.flatMap(row => made[row] ? made[row].from : []).map(k => order.indexOf(k));
  if (step.title === "selection") return [[parents - 1, parents], rows];
  if (step.title === "elite") return [[...Array(Math.min(elites || 0, 5)).keys()], rows];
  if (step.title === "fitness") { const best = generation.order[0]; return [[order.indexOf(best)], rows]; }
  return [from, rows];
}
function showPopulation(step) {
  const generation = DATA.generations[step.g];
  const count = generation.genes.length / generation.n;
  // Where nothing was compared there is no order.
  const isSorted = known(step, "selection") && generation.order.length > 0;
  const order = isSorted ? generation.order : [...Array(count).keys()];
  const next = known(step, "elite") ? offspring(step, generation) : [];
  const made = next.length ? next : null;
  const [left, rightRows] = focusOf(step, generation, order, made);
  const list = folded(count, left), born = made ? folded(made.length, rightRows) : [];
  at("unfolding").hidden = Math.max(count, made ? made.length : 0) <= ROOM;
  const rows = Math.max(list.length, born.length);
  const height = at("unfold").checked ? Math.max(9, Math.min(26, 520 / rows)) : Math.max(13, Math.min(24, TALL / rows));
  const width = made ? WIDE * 0.34 : WIDE - 150;
  const right = WIDE - width - 20;
  const focused = [...at("population").querySelectorAll(".row")].indexOf(document.activeElement);
  const image = svg("svg", { viewBox: "0 0 " + WIDE + " " + (40 + rows * height + 4), role: "group", "aria-label": "population of generation " + number(step.g) });
  image.append(label(44, 14, generation.unit.toLowerCase() + " " + number(step.g) + (isSorted && generation.fitness.length ? ", best first" : "")));
  image.append(...heads(44, width / generation.n, 30, { class: "remark" }));
  at("heads").textContent = key(width / generation.n) + (isByFate(generation) ? " Blue genes stay, orange ones have mutated." : "");
  const top = new Map();
  list.forEach(({ place, left }, line) => {
    const y = 36 + line * height;
    if (left) return image.append(label(44, y + height * 0.75, "\u22ee " + left + " more", { class: "remark", "font-size": Math.min(12, height) }));
    top.set(order[place], y);
    image.append(individual(present(step, generation, order[place]), 44, y, width, height));
    if (step.title === "selection" && place === generation.parents - 1 && generation.parents < count) {
      const cut = y + height - 0.5;
      image.append(svg("line", { class: "cut", x1: 20, y1: cut, x2: 44 + width + 90, y2: cut, stroke: "var(--ink)", "stroke-width": 1.5, "stroke-dasharray": "7 4" }));
    }
  });
  if (made) image.append(...heads(right, width / generation.n, 30, { class: "remark" }));
  // The children of the last generation are not simulated any more.
  if (made) image.append(fitted(right, 14, generation.call ? "after the operators" : number(step.g) < DATA.of ? "generation " + (number(step.g) + 1) : "children, not simulated"));
  born.forEach(({ place, left }, line) => {
    const y = 36 + line * height;
    if (left) return image.append(label(right, y + height * 0.75, "\u22ee " + left + " more", { class: "remark", "font-size": Math.min(12, height) }));
    const child = made[place], strong = concerns(step, generation, place);
    if (child) child.from.forEach((from, which) => {
      if (top.has(from)) image.append(svg("line", { x1: 44 + width + 8, y1: top.get(from) + 0.5 * height, x2: right - 26, y2: y + 0.5 * height,
        stroke: child.from.length < 2 ? "var(--ink)" : which ? "var(--orange)" : "var(--blue)", "stroke-width": strong ? 2.5 : 0.7, "stroke-dasharray": which ? "6 3" : "none", opacity: strong ? 1 : 0.35 }));
    });
    image.append(child ? individual(child, right, y, width, height) : svg("rect", { x: right, y, width: width - 1, height: height - 1, fill: "none", stroke: "var(--line)" }));
  });
  at("population").replaceChildren(image);
  const all = at("population").querySelectorAll(".row");
  const stop = all[Math.max(0, Math.min(focused, all.length - 1))];
  if (stop) stop.setAttribute("tabindex", 0);
  if (focused >= 0 && stop) stop.focus();
}
// The rows of the population are one stop of the tab key; the arrows go from row to row.
function alongRows(event) {
  const rows = [...at("population").querySelectorAll(".row")];
  const to = rows[rows.indexOf(document.activeElement) + { ArrowDown: 1, ArrowUp: -1 }[event.key]];
  if (!to) return;
  event.preventDefault();
  document.activeElement.setAttribute("tabindex", -1);
  to.setAttribute("tabindex", 0);
  to.focus();
}

// An individual of this generation, as far as it is known at the step.
function present(step, generation, k) {
  const origin = generation.origins[k] || {};
  const failed = known(step, "simulation") && generation.failures.some(failure => failure[0] === k);
  const rated = known(step, "fitness") && generation.fitness.length && !known(step, "elite");
  return {
    number: k, values: genome(generation.genes, generation.n, k), text: describe(generation, k, step), failed,
    crown: origin.elite !== undefined, changed: origin.mutated || [], isByFate: isByFate(generation),
    fitness: rated ? (failed ? "failed" : short(generation.fitness[k])) : "",
  };
}
// The rows of the next generation as far as the step has made them; null where nothing stands yet.
function offspring(step, generation) {
  const n = generation.n, elites = generation.elites || 0;
  const next = follows(step.g);
  const children = generation.children ? generation.children.length / n : 0;
  const rows = Math.max(children, next ? next.genes.length / n : 0);
  const second = step.title === "crossover" ? mate(step.of, generation.parents) : 0;
  const crossed = row => step.title === "crossover" ? row - elites <= Math.max(step.of, second) : known(step, "mutation");
  const mutated = row => generation.after && (step.title === "mutation" ? row <= step.of : known(step, "random completion"));
  const filled = row => step.title === "random completion" ? row <= step.of : known(step, "next generation");
  const made = [];
  for (let row = 0; row < rows; row++) {
    if (next && filled(row)) made.push(born(next, row));
    else if (row < children && (row < elites || crossed(row))) made.push(child(generation, row, mutated(row)));
    else made.push(null);
  }
  return made;
}
// What stands in this row of the next generation after completion.
function born(next, row) {
  const origin = next.origins[row] || {};
  const from = origin.of ? [...new Set(origin.of)] : (origin.elite !== undefined ? [origin.elite] : []);
  return { number: row, values: genome(next.genes, next.n, row), from, text: describe(next, row, { title: "initial population" }), crown: origin.elite !== undefined, changed: origin.mutated || [] };
}
// What stands in this row after crossover, or after mutation.
function child(generation, row, mutated) {
  const n = generation.n, elites = generation.elites || 0, rank = row - elites, order = generation.order;
  const values = genome(mutated ? generation.after : generation.children, n, row);
  const crown = rank < 0;
  const alone = !generation.points;
  const from = crown || alone ? [order[row]] : [...new Set([order[rank], order[mate(rank, generation.parents)]])];
  const u = mutated && !crown ? genome(generation.u, n, row) : [];
  const changed = u.map((value, j) => value < generation.factor ? j : -1).filter(j => j >= 0);
  const origin = crown ? { elite: from[0] } : alone ? { was: from[0], mutated: changed } : { of: from, mutated: changed };
  const genes = values.map((v, j) => name(j) + " = " + short(v) + unit(j)).join(", ");
  return { number: row, values, from, crown, changed, isByFate: isByFate(generation), text: "Row " + (row + 1) + " of the next generation, " + cameAs(origin) + ": " + genes };
}
// Whether a step is about the individual at this row of the next generation.
function concerns(step, generation, row) {
  const children = generation.elites || 0;
  if (step.title === "elite") return row < children;
  if (step.title === "crossover") return row - children === step.of || row - children === mate(step.of, generation.parents);
  return (step.title === "mutation" || step.title === "random completion") && row === step.of;
}
const mate = (rank, parents) => rank % 2 ? rank - 1 : rank + 1 < parents ? rank + 1 : 0;

// A call of Mutation alone is about which genes mutate: they have the colours of its drawing. The values are
// those that the script has chosen, often all the same.
const isByFate = generation => generation.call && Boolean(generation.u) && !generation.points;
// The names of the genes above their columns; their numbers where a name is wider than its column: a name
// that is cut can be taken for another. The key says then which number is which gene.
const HEAD = 11;
const areNumbered = cell => DATA.parameters.some((_, j) => name(j).length * HEAD * 0.6 > cell - 4);
function heads(x, cell, y, more) {
  const text = j => areNumbered(cell) ? String(j + 1) : name(j);
  return DATA.parameters.map((_, j) => label(x + (j + 0.5) * cell, y, text(j), Object.assign({ "text-anchor": "middle", "font-size": HEAD }, more)));
}
function key(cell) {
  if (!areNumbered(cell)) return "";
  return DATA.parameters.every((_, j) => name(j) === "gene " + (j + 1)) ? "The columns are the genes 1 to " + DATA.parameters.length + "."
    : "Columns: " + DATA.parameters.map((_, j) => (j + 1) + " " + name(j)).join(", ") + ".";
}

// One row: a box for each gene, its number, marks, and the fitness where it is known.
function individual({ number, values, text, failed, crown, changed, fitness, isByFate }, x, y, width, height) {
  const cell = width / values.length;
  const group = svg("g", { class: "row", tabindex: -1, role: "img", "aria-label": text });
  group.append(svg("title", {}, text));
  values.forEach((value, j) => {
    group.append(svg("rect", { x: x + j * cell, y, width: cell - 1, height: height - 1, fill: isByFate ? (changed.includes(j) ? "var(--second)" : "var(--first)") : colour(part(value, j)) }));
    if (changed.includes(j)) {
      group.append(svg("rect", { class: "changed", x: x + j * cell + 1, y: y + 1, width: cell - 3, height: height - 3, fill: "none", stroke: "var(--orange)", "stroke-width": 2 }));
      group.append(svg("circle", { cx: x + (j + 0.5) * cell, cy: y + height / 2, r: Math.min(4, height / 3), fill: "#fff", stroke: "#000" }));
    }
  });
  group.append(svg("rect", { class: "box", x, y: y - 0.5, width: width - 1, height: height - 0.5, fill: "none",
    stroke: failed ? "var(--red)" : "none", "stroke-width": Math.min(2.5, height / 8) }));
  // Smaller than the row: labels of neighbours do not touch.
  const size = Math.min(12, height * 0.8);
  const mark = failed ? "\u2715" : crown ? "\u265B" : "";
  const colours = failed ? { class: "failed" } : {};
  group.append(label(x - 6, y + height * 0.75, mark + " " + (number + 1), Object.assign({ "text-anchor": "end", "font-size": size }, colours)));
  if (fitness) group.append(label(x + width + 8, y + height * 0.75, fitness, Object.assign({ "font-size": size }, colours)));
  const tell = () => { at("individual").textContent = text; };
  group.addEventListener("mouseenter", tell);
  group.addEventListener("focus", tell);
  return group;
}

// A line of text that fits the drawing.
const fitted = (x, y, text, more) => label(x, y, text, Object.assign({ "font-size": Math.min(12, (WIDE - x) / text.length / 0.56) }, more));
// Genes as boxes with numbers, as in a textbook; `marks` are drawn with a thick edge.
function genes(values, y, title, fills, marks) {
  const group = svg("g", {}, label(0, y + 20, title));
  const cell = (WIDE - 90) / values.length;
  values.forEach((value, j) => {
    group.append(svg("rect", { x: 90 + j * cell, y, width: cell - 2, height: 30, rx: 3, fill: fills(j), stroke: marks(j) ? "var(--ink)" : "var(--soft)", "stroke-width": marks(j) ? 3 : 1 }));
    group.append(label(90 + (j + 0.5) * cell, y + 20, short(value), { "text-anchor": "middle", "font-size": Math.min(13, cell / 5) }));
  });
  return group;
}
const DRAWINGS = { "crossover": crossover, "mutation": mutation };
const CHART_DRAWINGS = {
  "initial population": drawn, "sampling": drawn, "random completion": drawn, "simulation": simulated, "fitness": ranking,
  "selection": ranking, "elite": elites, "next generation": composition, "stop": ending,
};
function showDrawing(step) {
  const generation = DATA.generations[step.g];
  const chart = CHART_DRAWINGS[step.title];
  const parts = DRAWINGS[step.title] ? DRAWINGS[step.title](step, generation) : chart ? chart(step, generation) : null;
  if (!parts) return note("drawing", "Nothing is known that could be drawn.");
  const cell = (WIDE - 90) / generation.n;
  const above = chart ? [] : heads(90, cell, 14);
  at("drawing").replaceChildren(svg("svg", { viewBox: "0 0 " + WIDE + " " + parts.height, role: "img", "aria-label": step.text }, ...above, ...parts.rows));
}
// A simulation: the model with the genes of an individual, and which of all have failed.
function simulated(step, generation) {
  const n = generation.n, count = generation.genes.length / n, across = Math.min(count, 20), wide = Math.min(26, (WIDE - 10) / across);
  const model = DATA.model.length > 30 ? DATA.model.slice(0, 29) + "\u2026" : DATA.model;
  const rows = [fitted(0, 12, "the genes of each individual are parameters of the model")];
  const one = genome(generation.genes, n, 0), most = Math.min(n, 4), cell = (WIDE * 0.5) / most;
  one.slice(0, most).forEach((value, j) => {
    const text = name(j) + " = " + short(value);
    rows.push(svg("rect", { x: j * cell, y: 24, width: cell - 3, height: 28, rx: 3, fill: "var(--first)", stroke: "var(--soft)" }), label((j + 0.5) * cell, 42, text.length * 6 > cell ? short(value) : text, { "text-anchor": "middle", "font-size": Math.min(12, cell / 5) }));
  });
  const x = WIDE * 0.5 + 4;
  rows.push(label(x, 42, "\u2192", { "font-size": 16 }), svg("rect", { x: x + 22, y: 20, width: WIDE - x - 24, height: 36, rx: 5, fill: "var(--plain)", stroke: "var(--ink)" }), label((x + 20 + WIDE) / 2, 42, model, { "text-anchor": "middle", "font-size": Math.min(12, (WIDE - x - 26) / model.length / 0.56) }));
  const lines = Math.min(Math.ceil(count / across), 6), failures = new Map(generation.failures);
  for (let k = 0; k < Math.min(count, across * lines); k++) {
    const [cx, cy] = [5 + (k % across + 0.5) * wide, 80 + Math.floor(k / across) * 18];
    rows.push(failures.has(k) ? svg("path", { class: "run", d: "M" + (cx - 4) + " " + (cy - 4) + "l8 8m0 -8l-8 8", stroke: "var(--red)", "stroke-width": 2 }, svg("title", {}, "individual " + (k + 1) + ": " + failures.get(k)))
      : svg("circle", { class: "run", cx, cy, r: 4, fill: "var(--blue)" }, svg("title", {}, "individual " + (k + 1))));
  }
  const left = count - across * lines;
  rows.push(fitted(0, 88 + lines * 18, count + (count === 1 ? " simulation, " : " simulations, ") + failures.size + " failed (\u2715)" + (left > 0 ? "; the first " + across * lines + " are shown" : ""), { class: "remark" }));
  return { rows, height: 98 + lines * 18 };
}
// Elites: the best rows of the order are copied, gene by gene.
function elites(step, generation) {
  const count = Math.min(generation.elites || 0, 3), rows = [fitted(0, 12, "the genes of the best are copied as they are")];
  for (let k = 0; k < count; k++) {
    const own = genome(generation.genes, generation.n, generation.order[k]);
    rows.push(genes(own, 24 + 84 * k, "rank " + (k + 1), () => "var(--first)", () => false));
    for (let j = 0; j < generation.n; j++) rows.push(label(90 + (j + 0.5) * (WIDE - 90) / generation.n, 67 + 84 * k, "\u2193", { "text-anchor": "middle" }));
    rows.push(genes(genome(generation.children, generation.n, k), 72 + 84 * k, "row " + (k + 1), () => "var(--first)", () => false));
  }
  if ((generation.elites || 0) > count) rows.push(label(90, 34 + 84 * count, "and " + (generation.elites - count) + " more", { class: "remark" }));
  return { rows, height: 44 + 84 * count };
}
// The next generation: where its individuals come from.
function composition(step, generation) {
  const next = follows(step.g);
  if (!next) return null;
  const kinds = [["elites", "var(--orange)", o => o && o.elite !== undefined], ["children", "var(--blue)", o => o && (o.of || o.was !== undefined)], ["random", "var(--soft)", o => o && o.random], ["from the script", "var(--line)", o => !o || o.script]];
  const count = next.origins.length, rows = [fitted(0, 12, "generation " + (number(step.g) + 1) + " has " + count + " individuals")];
  let x = 0, line = 0;
  for (const [what, fill, belongs] of kinds) {
    const own = next.origins.filter(belongs).length;
    if (!own) continue;
    const wide = WIDE * own / count;
    rows.push(svg("rect", { class: "part", x, y: 24, width: Math.max(2, wide - 1), height: 34, fill }), svg("rect", { x: 0, y: 70 + 20 * line, width: 12, height: 12, fill }), label(20, 81 + 20 * line, own + " " + what));
    x += wide;
    line += 1;
  }
  return { rows, height: 80 + 20 * line };
}
// The end: where the best and the others lie in their ranges.
function ending(step, generation) {
  if (!generation.n || !generation.genes.length) return null;
  const best = generation.order.length ? generation.order[0] : 0;
  return inRanges(generation, best, generation.order.length ? "the best, individual " + (best + 1) + "; grey, the others of the last " + counted(step.g) : "individual " + (best + 1), true);
}
// A draw: each gene of an individual in its range; grey, those of the others.
function drawn(step, generation) {
  const next = step.title === "random completion" ? follows(step.g) : generation;
  if (!next) return null;
  const k = step.title === "random completion" ? step.of : 0;
  return inRanges(next, k, "individual " + (k + 1) + ": a random place in each range" + (k === 0 ? "; grey, the others" : ""), k === 0);
}
// The genes of an individual in their ranges, with those of the others where they are wanted.
function inRanges(next, k, title, withOthers) {
  const n = next.n, high = n > 5 ? 38 : 44, left = 100, width = WIDE - left - 20;
  const rows = [fitted(0, 14, title)];
  for (let j = 0; j < n; j++) {
    const y = 40 + j * high, value = next.genes[k * n + j];
    const named = titled(j).length > 14 ? titled(j).slice(0, 13) + "\u2026" : titled(j);
    // One value has no range.
    if (!(DATA.maxima[j] > DATA.minima[j])) { rows.push(label(0, y + 4, named), label(left, y + 4, "= " + short(value) + unit(j))); continue; }
    rows.push(label(0, y + 4, named), svg("line", { x1: left, y1: y, x2: left + width, y2: y, stroke: "var(--soft)", "stroke-width": 2 }));
    rows.push(label(left, y + 18, short(DATA.minima[j]), { "font-size": 11, class: "remark" }), label(left + width, y + 18, short(DATA.maxima[j]), { "text-anchor": "end", "font-size": 11, class: "remark" }));
    const place = v => left + Math.min(1, Math.max(0, part(v, j))) * width;
    if (withOthers) for (let other = 0; other < next.genes.length / n; other++) if (other !== k) rows.push(svg("line", { class: "other", x1: place(next.genes[other * n + j]), x2: place(next.genes[other * n + j]), y1: y - 5, y2: y + 5, stroke: "var(--soft)", opacity: 0.5 }));
    rows.push(svg("circle", { class: "drawn", cx: place(value), cy: y, r: 6, fill: "var(--orange)", stroke: "var(--ink)" }), label(Math.min(left + width - 30, Math.max(left + 30, place(value))), y - 10, short(value), { "text-anchor": "middle", "font-size": 11 }));
  }
  return { rows, height: 40 + n * high };
}
// Fitness and selection: one bar for each individual, the shorter, the better; at the selection in
// order, with the cut behind the last parent.
function ranking(step, generation) {
  const isSorted = step.title === "selection";
  const order = isSorted ? generation.order : [...Array(generation.fitness.length).keys()];
  const good = generation.fitness.filter(v => !failed(v) && v > 0).map(Math.log10);
  if (!good.length) return null;
  const [low, high] = [Math.min(...good), Math.max(...good)], left = 66, wide = (WIDE - left - 10) / order.length, floor = 150, tall = 110;
  const length = v => 8 + (high > low ? (Math.log10(Math.max(v, 10 ** low)) - low) / (high - low) : 0.5) * (tall - 8);
  const best = generation.order[0];
  const rows = [fitted(0, 12, isSorted ? "sorted by fitness: the shorter the bar, the fitter" : "fitness of each individual: the shorter the bar, the fitter")];
  [[high, short(10 ** high)], [low, short(10 ** low)]].forEach(([v, text]) => rows.push(label(left - 6, floor - length(10 ** v) + 4, text, { "text-anchor": "end", "font-size": 11 })));
  order.forEach((k, place) => {
    const v = generation.fitness[k], x = left + place * wide;
    if (failed(v)) return rows.push(svg("path", { class: "bar", d: "M" + (x + wide / 2 - 3) + " " + (floor - 8) + "l6 6m0 -6l-6 6", stroke: "var(--red)", "stroke-width": 2 }));
    const fill = isSorted ? (place < (generation.elites || 0) ? "var(--orange)" : place < generation.parents ? "var(--blue)" : "var(--line)") : k === best ? "var(--orange)" : "var(--blue)";
    rows.push(svg("rect", { class: "bar", x, y: floor - length(v), width: Math.max(1, wide - 1), height: length(v), fill }, svg("title", {}, "individual " + (k + 1) + ": " + short(v))));
  });
  // As many numbers as there is room for.
  const every = Math.ceil(18 / wide);
  order.forEach((k, place) => place % every === 0 && rows.push(label(left + (place + 0.5) * wide, floor + 14, String(k + 1), { "text-anchor": "middle", "font-size": 11 })));
  let text = "orange: the best; \u2715 failed; logarithmic scale";
  if (isSorted) {
    const x = left + generation.parents * wide - 0.5;
    rows.push(svg("line", { class: "border", x1: x, x2: x, y1: 24, y2: floor + 4, stroke: "var(--ink)", "stroke-width": 2, "stroke-dasharray": "5 4" }));
    text = "orange: elite; blue: parents; grey: no children";
  }
  rows.push(fitted(0, floor + 34, text, { class: "remark" }));
  return { rows, height: floor + 42 };
}
function crossover(step, generation) {
  const n = generation.n, elites = generation.elites || 0, other = mate(step.of, generation.parents);
  const cell = (WIDE - 90) / n;
  const second = j => generation.points.filter(point => point <= j).length % 2;
  const light = ["var(--first)", "var(--second)"];
  const parent = rank => genome(generation.genes, n, generation.order[rank]);
  const none = () => false;
  const pair = other > step.of, alone = other === step.of;
  const rows = [
    genes(parent(step.of), 24, "rank " + (step.of + 1), () => light[0], none),
    genes(genome(generation.children, n, elites + step.of), 116, "child " + (step.of + 1), j => light[alone ? 0 : second(j)], none),
  ];
  if (alone) return { rows, height: 156 };
  rows.push(genes(parent(other), 60, "rank " + (other + 1), () => light[1], none));
  if (pair) rows.push(genes(genome(generation.children, n, elites + other), 152, "child " + (other + 1), j => light[1 - second(j)], none));
  for (const point of generation.points) {
    const x = 90 + point * cell - 1;
    rows.push(svg("line", { x1: x, y1: 20, x2: x, y2: pair ? 186 : 150, stroke: "var(--ink)", "stroke-width": 2, "stroke-dasharray": "5 4" }));
  }
  rows.push(label(90, 107, "exchanged behind a dashed line", { class: "remark" }));
  return { rows, height: pair ? 192 : 156 };
}
// What the random numbers decide: each lies on a scale from 0 to 1, of which the part below F_Mut is
// orange. Genes that stay are blue, those that mutate orange.
function mutation(step, generation) {
  const n = generation.n, factor = generation.factor;
  const u = genome(generation.u, n, step.of);
  const hit = j => u[j] < factor;
  const fill = j => hit(j) ? "var(--second)" : "var(--first)";
  const rows = [
    genes(genome(generation.children, n, step.of), 24, "before", () => "var(--first)", () => false),
    label(0, 76, "u, 0 to 1"),
    genes(genome(generation.after, n, step.of), 100, "after", fill, hit),
    label(0, 150, "place"),
    fitted(0, 176, "u in the orange part: u < F_Mut = " + factor + ", the gene mutates,"),
    fitted(0, 192, "and u/F_Mut is its place in its range; blue genes stay"),
  ];
  const cell = (WIDE - 90) / n;
  u.forEach((value, j) => {
    const [x, wide] = [90 + j * cell, cell - 6];
    const border = x + wide * Math.min(1, factor);
    rows.push(svg("line", { x1: x, y1: 72, x2: border, y2: 72, stroke: "var(--orange)", "stroke-width": 5 }));
    rows.push(svg("line", { x1: border, y1: 72, x2: x + wide, y2: 72, stroke: "var(--blue)", "stroke-width": 2 }));
    rows.push(svg("circle", { class: hit(j) ? "hit" : "missed", cx: x + wide * value, cy: 72, r: 5, fill: hit(j) ? "var(--orange)" : "var(--blue)", stroke: "var(--ink)" }));
    rows.push(label(x + wide / 2, 92, short(value), { "text-anchor": "middle", "font-size": Math.min(11, cell / 5) }));
    if (!hit(j)) return;
    rows.push(svg("line", { x1: x, y1: 146, x2: x + wide, y2: 146, stroke: "var(--soft)", "stroke-width": 2 }));
    rows.push(svg("circle", { cx: x + wide * value / factor, cy: 146, r: 5, fill: "var(--orange)", stroke: "var(--ink)" }));
  });
  return { rows, height: 200 };
}
