// The charts: fit, convergence, landscape, family, and what the data can tell.

// Round numbers between two ends: steps of 1, 2 or 5, on a logarithmic scale decades where there
// are enough of them.
function ticks(low, high, logarithmic) {
  if (logarithmic && high / low >= 10) {
    const every = Math.ceil(Math.log10(high / low) / 6), mantissas = Math.log10(high / low) > 2 ? [1] : [1, 2, 5];
    const found = [];
    for (let e = Math.floor(Math.log10(low)); e <= Math.log10(high); e++) {
      if (e % every === 0) mantissas.forEach(m => found.push(m * 10 ** e));
    }
    return found.filter(v => v >= low * 0.999 && v <= high * 1.001);
  }
  const rough = (high - low) / 5, decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 5, 10].find(m => m * decade >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; k++) found.push(k * step);
  return found;
}
// A place for each value between two ends of the paper.
function scale(values, from, to, logarithmic) {
  const kept = values.filter(v => v !== null && Number.isFinite(v));
  let low = Math.min(...kept), high = Math.max(...kept);
  if (!(high > low)) { const pad = Math.abs(low) * 0.05 || 1; low -= pad; high += pad; }
  const forward = logarithmic && low > 0 ? Math.log : v => v;
  const at = v => from + (forward(v) - forward(low)) / (forward(high) - forward(low)) * (to - from);
  return { at, ticks: ticks(low, high, logarithmic && low > 0) };
}
// A frame with axes: places for numbers and the elements to draw on.
function frame(xs, ys, xTitle, yTitle, logX, logY) {
  const [w, h, left, bottom, top, right] = [WIDE, 300, 66, 40, 24, 16];
  const x = scale(xs, left, w - right, logX), y = scale(ys, h - bottom, top, logY);
  const image = svg("svg", { viewBox: "0 0 " + w + " " + h, role: "img" });
  for (const tick of y.ticks) {
    image.append(svg("line", { x1: left, y1: y.at(tick), x2: w - right, y2: y.at(tick), stroke: "var(--line)" }));
    image.append(label(left - 6, y.at(tick) + 4, short(tick), { "text-anchor": "end" }));
  }
  for (const tick of x.ticks) {
    image.append(svg("line", { x1: x.at(tick), y1: h - bottom, x2: x.at(tick), y2: h - bottom + 4, stroke: "var(--soft)" }));
    image.append(label(x.at(tick), h - bottom + 16, short(tick), { "text-anchor": "middle" }));
  }
  image.append(label((w + left) / 2, h - 6, xTitle, { "text-anchor": "middle" }));
  image.append(label(4, 12, yTitle));
  return { image, px: x.at, py: y.at };
}
const path = (xs, ys, f) => xs.map((x, k) => (k ? "L" : "M") + f.px(x).toFixed(1) + " " + f.py(ys[k]).toFixed(1)).join("");

function note(id, text) {
  const p = document.createElement("p");
  p.className = "note";
  p.textContent = text;
  at(id).replaceChildren(p);
}

function showFit(step) {
  let g = known(step, "fitness") ? step.g : step.g - 1;
  while (g > 0 && !DATA.generations[g].best.length) g -= 1;
  once("fit", g, () => drawFit(g));
}
// Measurements are known here from calls of Fit.
const NOT_COMPARED = "No call of Fit compares this simulation with measurements, so there is nothing to draw. What the script prints of its own comparison is in its output.";
function drawFit(g) {
  const best = g >= 0 ? DATA.generations[g].best : [];
  if (!DATA.x.length) return note("fit", NOT_COMPARED);
  const drawn = best.length === DATA.x.length ? best : [];
  const f = frame(DATA.x, DATA.y.concat(drawn), DATA.x_name, DATA.y_name);
  if (drawn.length) {
    f.image.append(svg("path", { d: path(DATA.x, drawn, f), fill: "none", stroke: "var(--orange)", "stroke-width": 2.5 }));
    DATA.x.forEach((x, k) => f.image.append(svg("line", { x1: f.px(x), y1: f.py(DATA.y[k]), x2: f.px(x), y2: f.py(drawn[k]), stroke: "var(--red)", "stroke-width": 1.5 })));
  }
  DATA.x.forEach((x, k) => f.image.append(svg("circle", { cx: f.px(x), cy: f.py(DATA.y[k]), r: 3.5, fill: "var(--blue)" })));
  const sum = drawn.reduce((total, y, k) => total + (y - DATA.y[k]) ** 2, 0);
  const text = drawn.length ? "Dots: measured; line: the best of " + counted(g) + " " + number(g) + "; sum of the squared distances (red): " + short(sum) : "Dots: measured. Nothing has been compared with them yet.";
  f.image.setAttribute("aria-label", text);
  note("fit", text);
  at("fit").prepend(f.image);
}

// The curve ends at the generation that is shown, or at the one before while its fitness is not known;
// how it goes on is drawn in grey when it is asked for.
function showCurve(step) {
  const last = number(step.g) - (known(step, "fitness") ? 0 : 1);
  once("curve", [step.g, last, at("future").checked].join(), () => drawCurve(step, last));
}
function drawCurve(step, last) {
  const future = at("future").checked;
  const points = DATA.curve.filter(point => !failed(point[1]) && point[1] > 0 && (future || point[0] <= last));
  if (points.length < 2) return note("curve", "The curve begins with the second " + counted(step.g) + ".");
  const f = frame(points.map(p => p[0]), points.map(p => p[1]), counted(step.g), "best fitness (logarithmic)", false, true);
  const line = (part, stroke) => part.length && f.image.append(svg("path", { d: path(part.map(p => p[0]), part.map(p => p[1]), f), fill: "none", stroke, "stroke-width": 2 }));
  if (future) line(points.filter(p => p[0] >= last), "var(--line)");
  line(points.filter(p => p[0] <= last), "var(--blue)");
  const x = f.px(Math.min(number(step.g), points[points.length - 1][0]));
  f.image.append(svg("line", { x1: x, y1: 24, x2: x, y2: 260, stroke: "var(--orange)", "stroke-width": 2, "stroke-dasharray": "4 3" }));
  f.image.setAttribute("aria-label", "best fitness over the " + counted(step.g) + "s, number " + number(step.g) + " is marked");
  at("curve").replaceChildren(f.image);
}

// What the search knows of the fitness over two of the genes, up to the step: each field has the
// shade of the best that was simulated in it, and the individuals of this generation lie on top.
const FIELDS = [22, 15];
function showLandscape(step) {
  const [a, b] = [Number(at("across").value), Number(at("up").value)];
  const last = known(step, "fitness") ? step.g : step.g - 1;
  once("landscape", [a, b, last].join(), () => drawLandscape(a, b, last));
}
function drawLandscape(a, b, last) {
  const field = (v, j, count) => Math.min(count - 1, Math.max(0, Math.floor(part(v, j) * count)));
  const best = new Map();
  for (let g = 0; g <= last; g++) {
    const { n, genes, fitness } = DATA.generations[g];
    for (let k = 0; k < fitness.length; k++) {
      const key = field(genes[k * n + a], a, FIELDS[0]) + FIELDS[0] * field(genes[k * n + b], b, FIELDS[1]);
      const value = failed(fitness[k]) ? Infinity : Math.max(fitness[k], Number.MIN_VALUE);
      best.set(key, Math.min(value, best.has(key) ? best.get(key) : Infinity));
    }
  }
  const good = [...best.values()].filter(Number.isFinite).map(Math.log);
  const [low, high] = [good.reduce((m, v) => Math.min(m, v), Infinity), good.reduce((m, v) => Math.max(m, v), -Infinity)];
  const shade = fitness => high > low ? Math.max(0, (high - Math.log(Math.max(fitness, Number.MIN_VALUE))) / (high - low)) : 1;
  const f = frame([DATA.minima[a], DATA.maxima[a]], [DATA.minima[b], DATA.maxima[b]], titled(a), titled(b), LOGARITHMIC[a], LOGARITHMIC[b]);
  const [x0, x1, y0, y1] = [f.px(DATA.minima[a]), f.px(DATA.maxima[a]), f.py(DATA.minima[b]), f.py(DATA.maxima[b])];
  const [wide, tall] = [(x1 - x0) / FIELDS[0], (y0 - y1) / FIELDS[1]];
  for (const [key, value] of best) {
    if (!Number.isFinite(value)) continue;
    const x = x0 + (key % FIELDS[0]) * wide, y = y0 - (Math.floor(key / FIELDS[0]) + 1) * tall;
    f.image.append(svg("rect", { class: "field", x, y, width: wide, height: tall, fill: colour(shade(value)) }));
  }
  const now = last >= 0 ? DATA.generations[last] : { fitness: [] };
  now.fitness.forEach((fitness, k) => {
    const [x, y] = [f.px(now.genes[k * now.n + a]), f.py(now.genes[k * now.n + b])];
    if (failed(fitness)) f.image.append(svg("path", { d: "M" + (x - 4) + " " + (y - 4) + "l8 8m0 -8l-8 8", stroke: "var(--red)", "stroke-width": 2 }));
    else f.image.append(svg("circle", { cx: x, cy: y, r: 4, fill: colour(shade(fitness)), stroke: "var(--ink)" }));
  });
  const text = last < 0 ? "Nothing has been simulated yet." :
    "Each field: the best that was simulated there so far" + (DATA.of > DATA.generations.length ? " (in the generations on this page)" : "") + ", the lighter, the fitter; empty fields have not been tried or all failed there. Dots: " + counted(last) + " " + number(last) + "; crosses failed. The other parameters differ from dot to dot.";
  f.image.setAttribute("aria-label", text);
  note("landscape", text);
  at("landscape").prepend(f.image);
}

// The best and its forebears, each where it came into being; an elite that lives on is drawn once.
function showFamily(step) {
  const winner = at("whose").value === "winner";
  const which = winner ? DATA.winner : known(step, "fitness") ? DATA.family_of[step.g] : null;
  once("family", String(which), () => drawFamily(which));
}
function drawFamily(which) {
  if (which === null || which === undefined) return note("family", "Who is the best is not known yet.");
  const family = DATA.families[which];
  const levels = [];
  family.forEach((member, k) => (levels[member.depth] = levels[member.depth] || []).push(k));
  const high = 74;
  const image = svg("svg", { viewBox: "0 0 " + WIDE + " " + (levels.length * high - 10), role: "img", "aria-label": "forebears of individual " + (family[0].k + 1) + " of generation " + (family[0].g + 1) });
  const x = family.map(member => { const level = levels[member.depth]; return WIDE * (level.indexOf(family.indexOf(member)) + 0.5) / level.length; });
  family.forEach((member, k) => member.from.forEach((parent, which) => {
    if (parent !== null) image.append(svg("line", { x1: x[k], y1: member.depth * high + 46, x2: x[parent], y2: family[parent].depth * high + 8,
      stroke: which ? "var(--orange)" : "var(--blue)", "stroke-dasharray": which ? "6 3" : "none", "stroke-width": 1.8 }));
  }));
  family.forEach((member, k) => {
    const y = member.depth * high + 8, room = WIDE / levels[member.depth].length;
    const wide = Math.min(92, room - 4), size = Math.min(12, wide / 5.5);
    const origin = member.origin;
    const mark = origin.random ? "? " : origin.mutated && origin.mutated.length ? "\u25CF " : "";
    const text = "Individual " + (member.k + 1) + " of generation " + (member.g + 1) + ", " + cameAs(origin) + ", fitness " + short(member.fitness) + ": " + member.genes.map((v, j) => name(j) + " = " + short(v) + unit(j)).join(", ");
    image.append(svg("rect", { class: "member", x: x[k] - wide / 2, y, width: wide, height: 38, rx: 5, fill: "var(--plain)", stroke: "var(--soft)" }, svg("title", {}, text)));
    image.append(label(x[k], y + 16, mark + (member.k + 1), { "text-anchor": "middle", "font-size": size }));
    image.append(label(x[k], y + 31, (wide > 60 ? "gen. " : "g") + (member.g + 1), { "text-anchor": "middle", "font-size": size }));
  });
  note("family", "Above: the number of the individual, below: the generation it came in. \u25CF mutated, ? drawn at random. Solid: to the parent of the genes before the crossing point, dashed: to the other." + (levels.length > 5 ? " Earlier forebears are left out." : ""));
  at("family").prepend(image);
}

const percent = value => (value < 10 ? value.toPrecision(2) : Math.round(value)) + " %";
function showTell() {
  const isEnd = current === DATA.steps.length - 1;
  once("tell", isEnd, () => isEnd ? drawTell() : note("tell", "What the data can tell is said at the last step."));
}
function drawTell() {
  const result = DATA.result;
  if (!result || !Array.isArray(result.parameters) || !result.script) return note("tell", "The run has left no report.");
  const table = document.createElement("table");
  const row = (cells, tag) => {
    const tr = document.createElement("tr");
    cells.forEach(cell => { const td = document.createElement(tag); td.textContent = cell; tr.append(td); });
    table.append(tr);
    return tr;
  };
  const script = result.script, given = value => value !== null && value !== undefined;
  row(["parameter", "script's best", "least squares", "standard error", "identifiable?"], "th");
  for (const p of result.parameters) {
    const own = script.parameters[p.name], unit = p.unit ? " " + p.unit : "";
    const error = given(p.deviation) ? percent(100 * p.deviation / Math.abs(p.value)) : "unknown";
    const verdict = p.determined === true ? "yes" : p.determined === false ? "no" : "unknown";
    const tr = row([p.name, given(own) ? short(own) + unit : "-", script.probed ? short(p.value) + unit : "-", error, verdict], "td");
    if (p.determined === false) tr.lastChild.className = "doubt";
  }
  const holder = document.createElement("div");
  holder.className = "scroll";
  holder.append(table);
  note("tell", (result.findings || []).map(finding => finding.sentence).join(" "));
  at("tell").prepend(holder);
}
