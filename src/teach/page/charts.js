// The charts: fit, convergence, landscape, family, and what the data can tell.

// A frame with axes: places for numbers and the elements to draw on.
function frame(xs, ys, xTitle, yTitle, logarithmic) {
  const [w, h, left, bottom, top] = [WIDE, 300, 66, 40, 24];
  const forward = logarithmic ? v => Math.log10(v) : v => v;
  const range = values => {
    const kept = values.filter(v => v !== null && Number.isFinite(v));
    let low = Math.min(...kept), high = Math.max(...kept);
    if (!(high > low)) { const pad = Math.abs(low) * 0.05 || 1; low -= pad; high += pad; }
    return [low, high];
  };
  const [x0, x1] = range(xs), [y0, y1] = range(ys.map(v => v === null ? null : forward(v)));
  const px = v => left + (v - x0) / (x1 - x0) * (w - left - 12);
  const py = v => h - bottom - (forward(v) - y0) / (y1 - y0) * (h - bottom - top);
  const image = svg("svg", { viewBox: "0 0 " + w + " " + h, role: "img" });
  for (let k = 0; k <= 4; k++) {
    const x = x0 + (x1 - x0) * k / 4, y = y0 + (y1 - y0) * k / 4;
    const line = h - bottom - (h - bottom - top) * k / 4;
    image.append(svg("line", { x1: left, y1: line, x2: w - 12, y2: line, stroke: "var(--line)" }));
    image.append(label(left - 6, line + 4, short(logarithmic ? 10 ** y : y), { "text-anchor": "end" }));
    image.append(label(px(x), h - bottom + 16, short(x), { "text-anchor": "middle" }));
  }
  image.append(label((w + left) / 2, h - 6, xTitle, { "text-anchor": "middle" }));
  image.append(label(4, 12, yTitle));
  return { image, px, py };
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
  const best = g >= 0 ? DATA.generations[g].best : [];
  if (!DATA.x.length) return note("fit", "The script has read no measured data with Exp_Adq_SISO.");
  const drawn = best.length === DATA.x.length ? best : [];
  const f = frame(DATA.x, DATA.y.concat(drawn), DATA.x_name, DATA.y_name);
  if (drawn.length) {
    f.image.append(svg("path", { d: path(DATA.x, drawn, f), fill: "none", stroke: "var(--orange)", "stroke-width": 2.5 }));
    DATA.x.forEach((x, k) => f.image.append(svg("line", { x1: f.px(x), y1: f.py(DATA.y[k]), x2: f.px(x), y2: f.py(drawn[k]), stroke: "var(--red)", "stroke-width": 1.5 })));
  }
  DATA.x.forEach((x, k) => f.image.append(svg("circle", { cx: f.px(x), cy: f.py(DATA.y[k]), r: 3.5, fill: "var(--blue)" })));
  const sum = drawn.reduce((total, y, k) => total + (y - DATA.y[k]) ** 2, 0);
  const text = drawn.length ? "Dots: measured; line: the best of generation " + (g + 1) + "; sum of the squared distances (red): " + short(sum) : "Dots: measured. Nothing has been compared with them yet.";
  f.image.setAttribute("aria-label", text);
  note("fit", text);
  at("fit").prepend(f.image);
}

function showCurve(step) {
  const points = DATA.curve.filter(point => !failed(point[1]) && point[1] > 0);
  if (points.length < 2) return note("curve", "There is no curve of less than two generations.");
  const f = frame(points.map(p => p[0]), points.map(p => p[1]), "generation", "best fitness (logarithmic)", true);
  f.image.append(svg("path", { d: path(points.map(p => p[0]), points.map(p => p[1]), f), fill: "none", stroke: "var(--blue)", "stroke-width": 2 }));
  const x = f.px(step.g + 1);
  f.image.append(svg("line", { x1: x, y1: 24, x2: x, y2: 260, stroke: "var(--orange)", "stroke-width": 2, "stroke-dasharray": "4 3" }));
  f.image.setAttribute("aria-label", "best fitness over the generations, generation " + (step.g + 1) + " is marked");
  at("curve").replaceChildren(f.image);
}

// Every individual that was simulated up to the step, at two of its genes.
function showLandscape(step) {
  const [a, b] = [Number(at("across").value), Number(at("up").value)];
  const seen = [];
  for (let g = 0; g <= step.g; g++) {
    const generation = DATA.generations[g];
    if (!generation.fitness.length || (g === step.g && !known(step, "fitness"))) continue;
    for (let k = 0; k < generation.fitness.length; k++) {
      const values = genome(generation.genes, generation.n, k);
      seen.push({ x: values[a], y: values[b], fitness: generation.fitness[k], now: g === step.g });
    }
  }
  const thin = Math.ceil(seen.length / 3000);
  const f = frame([DATA.minima[a], DATA.maxima[a]], [DATA.minima[b], DATA.maxima[b]], titled(a), titled(b));
  const good = seen.filter(point => !failed(point.fitness) && point.fitness > 0).map(point => Math.log(point.fitness));
  const [low, high] = [good.reduce((m, v) => Math.min(m, v), Infinity), good.reduce((m, v) => Math.max(m, v), -Infinity)];
  seen.filter((point, k) => point.now || k % thin === 0).forEach(point => {
    const [x, y] = [f.px(point.x), f.py(point.y)];
    if (failed(point.fitness)) {
      f.image.append(svg("path", { d: "M" + (x - 4) + " " + (y - 4) + "l8 8m0 -8l-8 8", stroke: "var(--red)", "stroke-width": 1.5 }));
    } else {
      const shade = high > low ? (high - Math.log(point.fitness)) / (high - low) : 1;
      f.image.append(svg("circle", { cx: x, cy: y, r: point.now ? 5 : 3, fill: colour(shade), stroke: point.now ? "#000" : "none" }));
    }
  });
  const text = "Each dot was simulated: the lighter, the fitter; crosses failed; this generation has a black edge.";
  f.image.setAttribute("aria-label", text);
  note("landscape", text);
  at("landscape").prepend(f.image);
}

// The best of this generation and its forebears, at most five generations back.
function showFamily(step) {
  const generation = DATA.generations[step.g];
  if (!generation.fitness.length || !known(step, "fitness")) return note("family", "Who is the best is not known yet.");
  const levels = [[generation.order[0]]];
  for (let depth = 0; depth < 5 && step.g - depth > 0; depth++) {
    const origins = levels[depth].map(k => DATA.generations[step.g - depth].origins[k] || {});
    const before = origins.flatMap(o => o.of ? o.of : o.elite !== undefined ? [o.elite] : []);
    if (!before.length) break;
    levels.push([...new Set(before)].slice(0, 12));
  }
  const high = 58;
  const image = svg("svg", { viewBox: "0 0 " + WIDE + " " + (levels.length * high + 8), role: "img", "aria-label": "forebears of individual " + (generation.order[0] + 1) });
  const x = (level, place) => 80 + (WIDE - 90) * (place + 0.5) / levels[level].length;
  levels.forEach((level, depth) => level.forEach((k, place) => {
    const origin = DATA.generations[step.g - depth].origins[k] || {};
    const from = origin.of || (origin.elite !== undefined ? [origin.elite] : []);
    if (depth + 1 < levels.length) from.forEach((parent, which) => {
      const there = levels[depth + 1].indexOf(parent);
      if (there >= 0) image.append(svg("line", { x1: x(depth, place), y1: depth * high + 34, x2: x(depth + 1, there), y2: (depth + 1) * high + 8,
        stroke: which ? "var(--orange)" : "var(--blue)", "stroke-dasharray": which ? "6 3" : "none", "stroke-width": 1.8 }));
    });
  }));
  levels.forEach((level, depth) => {
    const g = step.g - depth;
    image.append(label(0, depth * high + 25, "gen. " + (g + 1)));
    level.forEach((k, place) => {
      const origin = DATA.generations[g].origins[k] || {};
      const mark = origin.elite !== undefined ? "\u265B " : origin.random ? "? " : origin.mutated && origin.mutated.length ? "\u25CF " : "";
      image.append(svg("rect", { x: x(depth, place) - 20, y: depth * high + 8, width: 40, height: 26, rx: 5, fill: "#fff", stroke: "#333" }, svg("title", {}, describe(DATA.generations[g], k, { title: "fitness" }))));
      image.append(label(x(depth, place), depth * high + 26, mark + (k + 1), { "text-anchor": "middle" }));
    });
  });
  note("family", "\u265B passed on as elite, \u25CF mutated, ? drawn at random. Solid: the parent of the genes before the crossing point, dashed: the other.");
  at("family").prepend(image);
}

const percent = value => (value < 10 ? value.toPrecision(2) : Math.round(value)) + " %";
function showTell() {
  const result = DATA.result;
  if (!result || !Array.isArray(result.details)) return note("tell", "The run has left no report of the deviations.");
  const table = document.createElement("table");
  const row = (cells, tag) => {
    const tr = document.createElement("tr");
    cells.forEach(cell => { const td = document.createElement(tag); td.textContent = cell; tr.append(td); });
    table.append(tr);
    return tr;
  };
  row(["parameter", "value", "deviation", "determined?"], "th");
  for (const d of result.details) {
    const deviation = d.standard_deviation === null || d.standard_deviation === undefined ? "unknown" : percent(100 * d.standard_deviation / Math.abs(d.value));
    const verdict = d.determined === true ? "yes" : d.determined === false ? "no" : "unknown";
    const tr = row([d.name, short(d.value) + (d.unit ? " " + d.unit : ""), deviation, verdict], "td");
    if (d.determined === false) tr.lastChild.className = "doubt";
  }
  const holder = document.createElement("div");
  holder.className = "scroll";
  holder.append(table);
  const pairs = (result.correlated || []).map(c => c.pair.join(" and ") + " (" + c.correlation.toFixed(3) + ")");
  note("tell", pairs.length ? "Strongly correlated: " + pairs.join(", ") + ". A change of one is made up for by the other, so a good fit does not mean right values." : "No two parameters are strongly correlated.");
  at("tell").prepend(holder);
}
