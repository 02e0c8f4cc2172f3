// What if: a change at this generation, and both runs beside each other.
const WHAT_IF = JSON.parse(document.getElementById("what-if-data").textContent);
// Within the page that runs scripts in the browser the run can be repeated.
const canRun = window.parent !== window;

function beginWhatIf() {
  at("what-if").addEventListener("submit", askWhatIf);
  at("changed").addEventListener("change", proposeValue);
  proposeValue();
  // What has been compared stays where it was entered.
  const [, name, value] = /^(\w+) := ([^]*)$/.exec(WHAT_IF ? WHAT_IF.statement : "") || [];
  if ([...at("changed").options].some(option => option.value === name)) {
    at("changed").value = name;
    at("changed-to").value = value;
  }
  // The page around this one says why there is nothing to compare.
  window.addEventListener("message", ({ source, data }) => {
    if (source === window.parent && data && data.whatIfFailed) refuse("No comparison: " + data.whatIfFailed.replace(/\.?$/, ".") + (WHAT_IF ? " Below is the comparison before, with " + WHAT_IF.statement + "." : ""));
  });
}
// Values that differ from the present ones.
function proposed() {
  const { factor, parents, elites } = DATA.generations[DATA.steps[current].g];
  return {
    F_Mut: String(factor ? Math.min(1, 2 * factor) : 0.5), N_Parents: String(Math.max(2, Math.floor((parents || 4) / 2))),
    N_Elitism: elites ? "0" : "1", Seed: "{1, 2, 3, 4, 5, 6}",
  };
}
function proposeValue() {
  at("changed-to").value = proposed()[at("changed").value];
}
// Why there is nothing to compare; what was entered stays, to be put right.
function refuse(text) {
  at("what-if-said").textContent = text;
  at("changed-to").setAttribute("aria-invalid", "true");
}
function askWhatIf(event) {
  event.preventDefault();
  const value = at("changed-to").value.trim();
  if (!value) return refuse("Enter a value for " + at("changed").value + ", such as " + proposed()[at("changed").value] + ".");
  at("changed-to").removeAttribute("aria-invalid");
  const generation = number(DATA.steps[current].g), statement = at("changed").value + " := " + value;
  if (canRun) {
    at("what-if-said").textContent = "Running again with " + statement + " from generation " + generation + " on ...";
    window.parent.postMessage({ whatIf: { generation, statement } }, "*");
    return;
  }
  at("what-if-said").textContent = "This page cannot simulate. On the command line: gapi teach SCRIPT.mos --generation " + generation +
    " --what-if \"" + statement + "\" --html what_if.html";
}

function showWhatIf(step) {
  at("both").hidden = !WHAT_IF;
  if (!WHAT_IF) return;
  const last = number(step.g) - (known(step, "fitness") ? 0 : 1);
  once("both", [step.g, last, known(step, "fitness"), current === DATA.steps.length - 1].join(), () => drawBoth(step, last));
}
function drawBoth(step, last) {
  const { statement, generation } = WHAT_IF;
  const bestOf = curve => curve.filter(point => point[0] <= last && !failed(point[1]) && point[1] > 0);
  const [own, changed] = [bestOf(DATA.curve), bestOf(WHAT_IF.curve)];
  const parts = [];
  const text = last < generation ? "Both runs are the same up to generation " + generation + ", where " + statement + " is executed."
    : "Generation " + last + ": best " + short(own.length ? own[own.length - 1][1] : null) + " in the run of the script (solid), "
      + short(changed.length ? changed[changed.length - 1][1] : null) + " with " + statement + " from generation " + generation + " on (dashed).";
  if (own.length > 1 && changed.length > 1) {
    const all = own.concat(changed);
    const f = frame(all.map(p => p[0]), all.map(p => p[1]), "generation", "best fitness (logarithmic)", false, true);
    const line = (points, stroke, dash) => f.image.append(svg("path", { d: path(points.map(p => p[0]), points.map(p => p[1]), f), fill: "none", stroke, "stroke-width": 2, "stroke-dasharray": dash }));
    line(own, "var(--blue)", "none");
    line(changed, "var(--orange)", "6 4");
    f.image.setAttribute("aria-label", text);
    parts.push(f.image);
  }
  const beside = known(step, "fitness") && WHAT_IF.populations.find(population => population.number === number(step.g));
  if (beside) parts.push(populations(DATA.generations[step.g], beside, statement));
  note("both", text + (current === DATA.steps.length - 1 ? " " + WHAT_IF.verdict : ""));
  at("both").prepend(...parts);
}
// The best rows of both populations, best first.
function populations(own, changed, statement) {
  const rows = Math.min(12, Math.max(own.fitness.length, changed.fitness.length)), height = 18;
  const half = WIDE / 2, width = half - 110;
  const image = svg("svg", { viewBox: "0 0 " + WIDE + " " + (24 + rows * height), role: "img", "aria-label": "the best of both populations" });
  [[own, "script", 0], [changed, statement, half]].forEach(([population, title, x]) => {
    const most = Math.floor((half - 40) / 7);
    image.append(label(x + 36, 14, title.length > most ? title.slice(0, most - 1) + "\u2026" : title));
    population.order.slice(0, rows).forEach((k, row) => {
      const values = genome(population.genes, population.n, k), cell = width / values.length, y = 22 + row * height;
      values.forEach((value, j) => image.append(svg("rect", { x: x + 36 + j * cell, y, width: cell - 1, height: height - 2, fill: colour(part(value, j)) })));
      image.append(label(x + 30, y + 12, String(k + 1), { "text-anchor": "end", "font-size": 11 }));
      image.append(label(x + 42 + width, y + 12, failed(population.fitness[k]) ? "failed" : short(population.fitness[k]), { "font-size": 11 }));
    });
  });
  return image;
}
