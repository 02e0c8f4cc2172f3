// The generations while they are computed: every picture that came is kept, to go back to.

const at = (id) => document.getElementById(id);
// Units of a drawing across; fewer on a phone, so that its text stays readable.
const WIDE = window.innerWidth < 800 ? 370 : 560;
/** Pictures kept: some megabytes; of longer runs every second one is forgotten, again and again. */
const MOST = 2000;

/** What stands there before a run. */
const BEFORE = "Press Run: the generations are drawn here while they are computed. The data stay in this browser; nothing is sent anywhere.";

function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}
const label = (x, y, text, more = {}) => svg("text", { x, y, ...more }, text);
export const short = (value) => {
  if (value === null || value === undefined || !Number.isFinite(value)) return "-";
  const size = Math.abs(value);
  return value !== 0 && (size < 1e-3 || size >= 1e5) ? value.toExponential(2) : String(Number(value.toPrecision(4)));
};

/** Round numbers between two ends; decades on a logarithmic scale. */
function ticks(low, high, logarithmic) {
  if (logarithmic) {
    const [from, to] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
    const every = Math.max(1, Math.ceil((to - from) / 5));
    const found = [];
    for (let e = from; e <= to; e += every) found.push(10 ** e);
    return found.length > 1 ? found : [low, high];
  }
  const rough = (high - low) / 4, decade = 10 ** Math.floor(Math.log10(rough));
  const step = decade * [1, 2, 5, 10].find((m) => m * decade >= rough * 0.999);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + step * 1e-9; k++) found.push(k * step);
  return found;
}
function scale(values, from, to, logarithmic) {
  const kept = values.filter((v) => v !== null && Number.isFinite(v) && (!logarithmic || v > 0));
  let low = Math.min(...kept), high = Math.max(...kept);
  if (!(high > low)) {
    const pad = Math.abs(low) * 0.05 || 1;
    [low, high] = logarithmic ? [low / 2, high * 2] : [low - pad, high + pad];
  }
  const f = logarithmic ? Math.log : (v) => v;
  return { to: (v) => from + ((f(v) - f(low)) / (f(high) - f(low))) * (to - from), ticks: ticks(low, high, logarithmic) };
}
/** A frame with axes. */
function frame(xs, ys, [xTitle, yTitle], text, logarithmic = false) {
  const height = 240, [left, right, top, bottom] = [66, 14, 24, 40];
  const x = scale(xs, left, WIDE - right, false), y = scale(ys, height - bottom, top, logarithmic);
  const image = svg("svg", { viewBox: `0 0 ${WIDE} ${height}`, role: "img", "aria-label": text });
  for (const tick of y.ticks) {
    image.append(svg("line", { x1: left, x2: WIDE - right, y1: y.to(tick), y2: y.to(tick), stroke: "var(--line)" }), label(left - 6, y.to(tick) + 4, short(tick), { "text-anchor": "end" }));
  }
  for (const tick of x.ticks) image.append(label(x.to(tick), height - bottom + 16, short(tick), { "text-anchor": "middle" }));
  image.append(label((left + WIDE) / 2, height - 6, xTitle, { "text-anchor": "middle" }), label(4, 12, yTitle));
  const line = (px, py) => px.map((v, k) => `${k ? "L" : "M"}${x.to(v).toFixed(1)} ${y.to(py[k]).toFixed(1)}`).join("");
  return { image, x: x.to, y: y.to, line };
}

export class Live {
  #views = [];
  #follows = true;
  #unit = "generation";

  constructor() {
    at("moment").addEventListener("input", () => this.#go(Number(at("moment").value)));
    at("before").addEventListener("click", () => this.#go(Number(at("moment").value) - 1));
    at("after").addEventListener("click", () => this.#go(Number(at("moment").value) + 1));
  }

  clear() {
    this.#unit = "generation";
    at("nothing").textContent = BEFORE;
    this.#views = [];
    this.#follows = true;
    at("watch").hidden = true;
    at("nothing").hidden = false;
    at("preview").toggleAttribute("hidden", false);
  }

  /** One more picture of the run. */
  add(view) {
    const { best, ...kept } = view;
    // It shows in the second one: what it is holds for all of them.
    this.#unit = view.progress.label === "evaluation" ? "evaluation" : "generation";
    this.#views.push(kept);
    this.best = best;
    if (this.#views.length > MOST) this.#views = this.#views.filter((_, k) => k % 2 === 0 || k === this.#views.length - 1);
    at("watch").hidden = false;
    at("nothing").hidden = true;
    at("preview").toggleAttribute("hidden", true);
    at("moment").max = this.#views.length - 1;
    if (this.#follows) this.#go(this.#views.length - 1);
  }

  /** What is counted: generations, or evaluations of a script in which nothing evolves. */
  unit() {
    return this.#unit;
  }

  /** The run has ended. */
  ended() {
    if (!this.#views.length) at("preview").toggleAttribute("hidden", true);
    if (!this.#views.length) at("nothing").textContent = "This script compares no simulation with measurements, so there are no generations to draw. What it prints is in Output; calls of operators can be walked through in Step by step.";
  }

  /** The best fitness that was reported last, and the generation. */
  now() {
    return this.#views.at(-1)?.progress ?? null;
  }

  #go(k) {
    const place = Math.min(Math.max(k, 0), this.#views.length - 1);
    this.#follows = place === this.#views.length - 1;
    at("moment").value = place;
    at("before").disabled = place === 0;
    at("after").disabled = this.#follows;
    this.#draw(this.#views[place]);
  }

  #draw({ title, progress, spreads, fitted }) {
    const of = progress.total ? ` of ${progress.total}` : "";
    const unit = this.#unit;
    at("moment").setAttribute("aria-label", unit[0].toUpperCase() + unit.slice(1));
    at("moment").setAttribute("aria-valuetext", `${unit} ${progress.done}`);
    at("headline").textContent = `${title}: ${unit} ${progress.done}${of}, best fitness ${short(progress.best)}, ${progress.failures} simulations failed`;
    at("failures").textContent = whyFailed(progress, spreads.length);
    at("failures").hidden = !progress.failures || !progress.main_cause;
    at("curve-title").textContent = `Best fitness over the ${unit}s`;
    at("fit").replaceChildren(...fitted.map(fitOf));
    at("curve").replaceChildren(curveOf(this.best, progress.done, unit));
    at("spreads").replaceChildren(spreadsOf(spreads, unit));
  }
}

/** Why simulations fail, and where that is to be seen. */
function whyFailed({ failures, main_cause }, parameters) {
  if (!main_cause) return "";
  const [cause, count] = main_cause;
  const where = parameters > 1 ? " Where in the ranges they fail: Step by step, \u201cThe landscape of the fitness\u201d." : "";
  return `Why they failed: ${cause}${count < failures ? ` (${count} of ${failures})` : ""}. They get the worst fitness, and the search continues.${where}`;
}

function fitOf({ x_name, y_name, x, measured, simulated }) {
  const drawn = simulated.length === x.length ? simulated : [];
  const f = frame(x, measured.concat(drawn), [x_name, y_name], `${y_name} over ${x_name}: dots measured, line simulated`);
  const order = x.map((_, k) => k).sort((a, b) => x[a] - x[b]);
  if (drawn.length) f.image.append(svg("path", { d: f.line(order.map((k) => x[k]), order.map((k) => drawn[k])), fill: "none", stroke: "var(--orange)", "stroke-width": 2.5 }));
  measured.forEach((y, k) => f.image.append(svg("circle", { cx: f.x(x[k]), cy: f.y(y), r: 3.5, fill: "var(--blue)" })));
  f.image.append(label(WIDE - 14, 12, WIDE < 500 ? "dots: measured" : "dots: measured, line: best so far", { "text-anchor": "end" }));
  return f.image;
}

function curveOf(best, now, unit) {
  const points = best.map((v, k) => [k + 1, v]).filter(([, v]) => v > 0 && v < 1e59);
  const text = document.createElement("p");
  if (points.length < 2) {
    text.textContent = `The curve begins with the second ${unit}.`;
    return text;
  }
  const every = Math.ceil(points.length / 600), thin = points.filter((_, k) => k % every === 0 || k === points.length - 1);
  const f = frame(thin.map((p) => p[0]), thin.map((p) => p[1]), [unit, "best fitness (logarithmic)"], `best fitness over the ${unit}s`, true);
  f.image.append(svg("path", { d: f.line(thin.map((p) => p[0]), thin.map((p) => p[1])), fill: "none", stroke: "var(--blue)", "stroke-width": 2 }));
  const x = f.x(Math.min(Math.max(now, thin[0][0]), thin.at(-1)[0]));
  f.image.append(svg("line", { x1: x, x2: x, y1: 24, y2: 200, stroke: "var(--orange)", "stroke-width": 2, "stroke-dasharray": "4 3" }));
  return f.image;
}

function spreadsOf(spreads, unit) {
  const height = 34, left = WIDE < 500 ? 70 : 120, width = WIDE - left - (WIDE < 500 ? 90 : 130);
  const image = svg("svg", { viewBox: `0 0 ${WIDE} ${spreads.length * height + 22}`, role: "img",
    "aria-label": spreads.map(({ name, value, unit }) => `${name} = ${short(value)} ${unit}`).join(", ") });
  spreads.forEach(({ name, unit, value, best, generation: [low, middle, high] }, k) => {
    const y = k * height + 16;
    image.append(label(0, y + 4, name.length > left / 7.5 ? "\u2026" + name.slice(1 - left / 7.5) : name),
      svg("line", { x1: left, x2: left + width, y1: y, y2: y, stroke: "var(--line)", "stroke-width": 2 }),
      svg("rect", { x: left + low * width, y: y - 6, width: Math.max(2, (high - low) * width), height: 12, fill: "var(--selection)", stroke: "var(--blue)" }),
      svg("line", { x1: left + middle * width, x2: left + middle * width, y1: y - 6, y2: y + 6, stroke: "var(--blue)", "stroke-width": 2 }),
      svg("circle", { cx: left + best * width, cy: y, r: 5, fill: "var(--orange)", stroke: "var(--ink)" }),
      label(left + width + 10, y + 4, `${short(value)} ${unit === "1" ? "" : unit}`));
  });
  image.append(label(0, spreads.length * height + 12, `box: smallest to largest of the ${unit}, dot: best so far`));
  return image;
}
