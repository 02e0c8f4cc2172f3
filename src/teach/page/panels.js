// The panels: what each step looks like.

function showScript(step) {
  const place = step.place && DATA.scripts[step.place[0]];
  at("script-name").textContent = place ? place.name + ", line " + step.place[1] : "no line is known";
  const lines = place ? place.lines : [];
  at("script").replaceChildren(...lines.map((line, k) => {
    const row = document.createElement("span");
    row.textContent = String(k + 1).padStart(3) + "  " + line;
    if (k + 1 === step.place[1]) { row.className = "now"; row.setAttribute("aria-current", "step"); }
    return row;
  }));
  const now = at("script").querySelector(".now");
  if (now) at("script").scrollTop = now.offsetTop - at("script").offsetTop - at("script").clientHeight / 2;
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
  return "child of " + (origin.of[0] + 1) + " and " + (origin.of[1] + 1) + changed;
}

// Units of a drawing across; fewer on a phone, so that its text stays readable.
const WIDE = window.innerWidth < 760 ? 370 : 560;
function showPopulation(step) {
  const generation = DATA.generations[step.g];
  const count = generation.genes.length / generation.n;
  const order = known(step, "selection") ? generation.order : [...Array(count).keys()];
  const next = known(step, "crossover") && DATA.generations[step.g + 1];
  const rows = Math.max(count, next ? next.genes.length / next.n : 0);
  const height = Math.max(9, Math.min(26, 520 / rows));
  const width = next ? WIDE * 0.34 : WIDE - 150;
  const image = svg("svg", { viewBox: "0 0 " + WIDE + " " + (24 + rows * height + 4), role: "group", "aria-label": "population of generation " + (step.g + 1) });
  image.append(label(44, 14, next ? "generation " + (step.g + 1) + (known(step, "selection") ? ", best first" : "") : "generation " + (step.g + 1)));
  order.forEach((k, place) => image.append(individual(generation, k, 44, 20 + place * height, width, height, step, next)));
  if (next) {
    image.append(label(WIDE - width - 20, 14, "generation " + (step.g + 2)));
    const here = k => order.indexOf(k);
    const lines = (k, place, colours, strong) => k.forEach((from, which) => {
      if (here(from) < 0) return;
      image.append(svg("line", { x1: 44 + width + 8, y1: 20 + (here(from) + 0.5) * height, x2: WIDE - width - 26, y2: 20 + (place + 0.5) * height,
        stroke: colours[which], "stroke-width": strong ? 2.5 : 0.7, "stroke-dasharray": which ? "6 3" : "none", opacity: strong ? 1 : 0.35 }));
    });
    for (let place = 0; place < next.genes.length / next.n; place++) {
      const origin = next.origins[place];
      image.append(individual(next, place, WIDE - width - 20, 20 + place * height, width, height, { title: "initial population" }, true));
      const strong = concerns(step, generation, place);
      if (origin && origin.of) lines(origin.of, place, ["var(--blue)", "var(--orange)"], strong);
      if (origin && origin.elite !== undefined) lines([origin.elite], place, ["var(--ink)"], strong);
    }
  }
  at("population").replaceChildren(image);
}
// Whether a step is about the individual at this row of the next generation.
function concerns(step, generation, row) {
  const children = generation.elites || 0;
  if (step.title === "elite") return row < children;
  if (step.title === "crossover") return row - children === step.of || row - children === mate(step.of, generation.parents);
  return (step.title === "mutation" || step.title === "random completion") && row === step.of;
}
const mate = (rank, parents) => rank % 2 ? rank - 1 : rank + 1 < parents ? rank + 1 : 0;

function individual(generation, k, x, y, width, height, step, small) {
  const cell = width / generation.n;
  const origin = generation.origins[k] || {};
  const broken = known(step, "simulation") && generation.failures.some(failure => failure[0] === k);
  const text = describe(generation, k, step);
  const group = svg("g", { class: "row", tabindex: 0, role: "img", "aria-label": text });
  group.append(svg("title", {}, text));
  genome(generation.genes, generation.n, k).forEach((value, j) => {
    group.append(svg("rect", { x: x + j * cell, y, width: cell - 1, height: height - 1, fill: colour(part(value, j)) }));
    if (origin.mutated && origin.mutated.includes(j)) {
      group.append(svg("circle", { cx: x + (j + 0.5) * cell, cy: y + height / 2, r: Math.min(4, height / 3), fill: "#fff", stroke: "#000" }));
    }
  });
  group.append(svg("rect", { class: "box", x, y, width: width - 1, height: height - 1, fill: "none",
    stroke: broken ? "var(--red)" : "none", "stroke-width": 2.5 }));
  const size = Math.min(12, height);
  const mark = broken ? "\u2715" : origin.elite !== undefined ? "\u265B" : "";
  group.append(label(x - 6, y + height * 0.75, mark + " " + (k + 1), { "text-anchor": "end", "font-size": size }));
  if (!small && known(step, "fitness") && generation.fitness.length) {
    group.append(label(x + width + 8, y + height * 0.75, broken ? "failed" : short(generation.fitness[k]), { "font-size": size }));
  }
  const tell = () => { at("individual").textContent = text; };
  group.addEventListener("mouseenter", tell);
  group.addEventListener("focus", tell);
  return group;
}

// Genes as boxes with numbers, as in a textbook; `marks` are drawn with a thick edge.
function genes(values, y, title, fills, marks) {
  const group = svg("g", {}, label(0, y + 20, title));
  const cell = (WIDE - 90) / values.length;
  values.forEach((value, j) => {
    group.append(svg("rect", { x: 90 + j * cell, y, width: cell - 2, height: 30, rx: 3, fill: fills(j), stroke: marks(j) ? "#000" : "#888", "stroke-width": marks(j) ? 3 : 1 }));
    group.append(label(90 + (j + 0.5) * cell, y + 20, short(value), { "text-anchor": "middle", "font-size": Math.min(13, cell / 5) }));
  });
  return group;
}
function showDrawing(step) {
  const generation = DATA.generations[step.g];
  const parts = step.title === "crossover" ? crossover(step, generation) : step.title === "mutation" ? mutation(step, generation) : null;
  if (!parts) {
    const note = document.createElement("p");
    note.className = "note";
    note.textContent = "Crossover and mutation are drawn here.";
    return at("drawing").replaceChildren(note);
  }
  const cell = (WIDE - 90) / generation.n;
  const heads = DATA.parameters.map((_, j) => label(90 + (j + 0.5) * cell, 14, name(j), { "text-anchor": "middle", "font-size": Math.min(13, cell / 5) }));
  at("drawing").replaceChildren(svg("svg", { viewBox: "0 0 " + WIDE + " " + parts.height, role: "img", "aria-label": step.text }, ...heads, ...parts.rows));
}
function crossover(step, generation) {
  const n = generation.n, elites = generation.elites || 0, other = mate(step.of, generation.parents);
  const cell = (WIDE - 90) / n;
  const second = j => generation.points.filter(point => point <= j).length % 2;
  const light = ["#cfe3f7", "#ffd9b0"];
  const parent = rank => genome(generation.genes, n, generation.order[rank]);
  const none = () => false;
  const rows = [
    genes(parent(step.of), 24, "rank " + (step.of + 1), () => light[0], none),
    genes(parent(other), 60, "rank " + (other + 1), () => light[1], none),
    genes(genome(generation.children, n, elites + step.of), 116, "child " + (step.of + 1), j => light[second(j)], none),
  ];
  if (other > step.of) rows.push(genes(genome(generation.children, n, elites + other), 152, "child " + (other + 1), j => light[1 - second(j)], none));
  for (const point of generation.points) {
    const x = 90 + point * cell - 1;
    rows.push(svg("line", { x1: x, y1: 20, x2: x, y2: 186, stroke: "#000", "stroke-width": 2, "stroke-dasharray": "5 4" }));
  }
  return { rows, height: 192 };
}
function mutation(step, generation) {
  const n = generation.n;
  const u = genome(generation.u, n, step.of);
  const hit = j => u[j] < generation.factor;
  const fill = j => hit(j) ? "#ffd9b0" : "#eee";
  const rows = [
    genes(genome(generation.children, n, step.of), 24, "before", () => "#eee", () => false),
    genes(u, 70, "u", fill, hit),
    genes(genome(generation.after, n, step.of), 116, "after", fill, hit),
    label(0, 170, "a gene mutates where u < F_Mut = " + generation.factor + " (thick edge)"),
  ];
  return { rows, height: 180 };
}
