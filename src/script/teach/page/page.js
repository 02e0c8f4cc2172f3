// The steps of a run: which one is shown, and the controls. What a step looks like is in the panels.
const at = id => document.getElementById(id);
// Within another page there is no address that a link could lead to.
const EMBEDDED = location.href === "about:srcdoc";
let current = 0;
let timer = null;

const failed = fitness => fitness === null || !(fitness < 1e59);
const short = value => {
  if (value === null || value === undefined || Number.isNaN(value)) return "-";
  const size = Math.abs(value);
  if (value === 0) return "0";
  return size < 1e-3 || size >= 1e5 ? value.toExponential(2) : String(Number(value.toPrecision(4)));
};
const genome = (rows, n, k) => rows.slice(k * n, (k + 1) * n);
const name = j => DATA.parameters[j] || "gene " + (j + 1);
const unit = j => DATA.units[j] ? " " + DATA.units[j] : "";
const titled = j => DATA.units[j] ? name(j) + " (" + DATA.units[j] + ")" : name(j);

// An SVG element with attributes and children.
function svg(tag, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [key, value] of Object.entries(attributes || {})) element.setAttribute(key, value);
  for (const child of children) element.append(child);
  return element;
}
const label = (x, y, text, more) => svg("text", Object.assign({ x, y, "font-size": 12 }, more), text);

// Blue to yellow, with rising lightness: readable without colour vision and in grey print.
const STOPS = [[0, 34, 78], [43, 68, 111], [88, 95, 109], [124, 123, 120], [166, 157, 117], [211, 193, 100], [254, 232, 56]];
function colour(part) {
  if (part === null || Number.isNaN(part)) return "#fff";
  const place = Math.min(Math.max(part, 0), 1) * (STOPS.length - 1);
  const low = Math.min(Math.floor(place), STOPS.length - 2);
  const mix = STOPS[low].map((c, k) => Math.round(c + (STOPS[low + 1][k] - c) * (place - low)));
  return "rgb(" + mix.join(",") + ")";
}
// A gene is shown on a logarithmic scale where the first population is drawn so: half of it would
// lie at the lower end of a linear one.
const LOGARITHMIC = DATA.minima.map((low, j) => {
  const high = DATA.maxima[j], first = DATA.generations[0];
  const column = first.genes.filter((_, k) => k % first.n === j).sort((a, b) => a - b);
  return low > 0 && high / low > 10 && column[column.length >> 1] < low + 0.25 * (high - low);
});
// Where a gene lies within its range, from 0 to 1.
function part(value, j) {
  const [low, high] = [DATA.minima[j], DATA.maxima[j]];
  if (!(high > low)) return 0.5;
  if (LOGARITHMIC[j]) return Math.log(value / low) / Math.log(high / low);
  return (value - low) / (high - low);
}

// Which steps begin a generation; the sliders are one for the generation and one for its steps.
const STARTS = DATA.generations.map((_, g) => DATA.steps.findIndex(step => step.g === g));
// Long runs: not all generations are on the page. Their numbers count from 1.
const number = g => DATA.generations[g].number;
const follows = g => g + 1 < DATA.generations.length && number(g + 1) === number(g) + 1 ? DATA.generations[g + 1] : null;
// The last generation on the page that is not behind the one of this number.
const upTo = wanted => DATA.generations.reduce((found, generation, g) => generation.number <= wanted ? g : found, 0);
// What is counted: generations, evaluations or calls.
const counted = g => DATA.generations[g].unit.toLowerCase();
const stepsOf = g => (g + 1 < STARTS.length ? STARTS[g + 1] : DATA.steps.length) - STARTS[g];

function go(step, keepLink) {
  const before = current;
  current = Math.min(Math.max(step, 0), DATA.steps.length - 1);
  // An answer belongs to its question.
  if (current !== before) at("answer").value = "";
  show();
  if (!keepLink && !EMBEDDED) history.replaceState(null, "", "#step=" + (current + 1));
}
function goGeneration(number) {
  if (STARTS[number] >= 0) go(STARTS[number]);
}
function stop() {
  clearInterval(timer);
  timer = null;
  at("play").textContent = "Play";
  at("play").setAttribute("aria-pressed", "false");
}
// Where playing goes next: the next step, part or generation.
function ahead() {
  const { g, title } = DATA.steps[current], pace = at("pace").value;
  if (pace === "1") return current + 1 < DATA.steps.length ? current + 1 : -1;
  return DATA.steps.findIndex((step, k) => k > current && (step.g !== g || (pace === "2" && step.title !== title)));
}
function play() {
  if (timer !== null) return stop();
  if (ahead() < 0) go(0);
  timer = setInterval(() => ahead() < 0 ? stop() : go(ahead()), 900);
  at("play").textContent = "Pause";
  at("play").setAttribute("aria-pressed", "true");
}

// Draws a panel only when what it shows has changed.
const shown = {};
function once(id, key, draw) {
  if (shown[id] === key) return;
  shown[id] = key;
  draw();
}
// In a window of another width all is drawn again: a page within a hidden one begins with no width.
function redraw() {
  const before = [WIDE, TALL].join();
  measure();
  if ([WIDE, TALL].join() === before) return;
  Object.keys(shown).forEach(id => delete shown[id]);
  show();
}
// Predictions: which steps were answered, and how many of the answers were right.
const answered = new Map();
const waits = () => at("predicting").checked && DATA.steps[current].question && !answered.has(current);
// The numbers of an answer, sorted, each once; null where there is something else or too large a one.
function numbersOf(said, most) {
  const words = said.split(/[\s,;]+/).filter(word => word && word !== "and");
  const named = [...new Set(words.map(word => /^\d+$/.test(word) ? Number(word) : NaN))].sort((a, b) => a - b);
  return named.every(n => n >= 1 && n <= most) ? named : null;
}
// What each kind of question has for an answer: how it is read (null where it is none), what is right,
// and what to enter.
const KINDS = {
  Individuals: ({ right, of }) => ({
    read: said => { const named = numbersOf(said, of); return named && named.length === right.length ? named.join(" ") : null; },
    right: right.join(" "), enter: "Enter " + right.length + " different numbers from 1 to " + of + "." }),
  Letters: ({ right }) => ({
    read: said => { const letters = said.replace(/\s/g, ""); return letters.length === right.length && /^[ab]*$/.test(letters) ? letters : null; },
    right, enter: "Enter " + right.length + " letters, each of them a or b." }),
  Decision: ({ right }) => ({
    read: said => ({ y: "yes", yes: "yes", n: "no", no: "no" })[said] || null,
    right: right ? "yes" : "no", enter: "Enter y for yes or n for no." }),
  Number: ({ right, of }) => ({
    read: said => { const named = numbersOf(said, of); return named && named.length === 1 ? String(named[0]) : null; },
    right: String(right), enter: "Enter one number from 1 to " + of + "." }),
};
const kindOf = answer => { const [kind, content] = Object.entries(answer)[0]; return KINDS[kind](content); };
const solution = answer => kindOf(answer).right;
function predict(event) {
  event.preventDefault();
  if (!waits()) return;
  const { read, right, enter } = kindOf(DATA.steps[current].question.answer);
  const answer = read(at("answer").value.trim().toLowerCase());
  // What is no answer is asked for again, and does not count.
  if (answer === null) { at("score").textContent = enter; return; }
  answered.set(current, answer === right);
  at("answer").value = "";
  show();
}
// While a prediction is awaited, the step before is what is drawn.
function showPrediction(step) {
  const right = [...answered.values()].filter(Boolean).length;
  const isWaiting = waits();
  at("prediction").hidden = !at("predicting").checked || !step.question;
  at("answer").disabled = at("predict").disabled = !isWaiting;
  const verdict = !answered.has(current) ? "" : answered.get(current) ? "Right. " : "No: the answer is " + solution(step.question.answer) + ". ";
  at("score").textContent = verdict + (answered.size ? right + " of " + answered.size + " correct" : "");
  if (isWaiting) at("text").textContent = step.question.text;
}
function show() {
  const step = DATA.steps[current];
  const place = current - STARTS[step.g];
  at("slider").max = stepsOf(step.g);
  at("slider").value = place + 1;
  at("step").textContent = (place + 1) + " of " + stepsOf(step.g);
  at("generation").value = number(step.g);
  at("generations").value = step.g + 1;
  at("generations").setAttribute("aria-valuetext", counted(step.g) + " " + number(step.g));
  const { unit } = DATA.generations[step.g];
  at("unit").textContent = unit;
  at("generations").setAttribute("aria-label", unit);
  at("generation").setAttribute("aria-label", "Number of the " + counted(step.g));
  at("curve-heading").textContent = "Best fitness over the " + counted(step.g) + "s";
  at("jump").textContent = "";
  at("generation").removeAttribute("aria-invalid");
  at("title").textContent = unit + " " + number(step.g) + " of " + DATA.of + ": " + step.title;
  at("text").textContent = step.text;
  at("link").href = "#step=" + (current + 1);
  at("first").disabled = at("back").disabled = current === 0;
  at("previous-generation").disabled = current === 0;
  at("next").disabled = at("last").disabled = current === DATA.steps.length - 1;
  at("next-generation").disabled = step.g + 1 >= STARTS.length;
  showPrediction(step);
  const drawn = waits() && current > 0 ? DATA.steps[current - 1] : step;
  showScript(step);
  if (step.table) showOperation(step);
  if (DATA.generations[step.g].call && step.table) return hideRun();
  showRun(step);
  showPopulation(drawn);
  if (!drawn.table) showDrawing(drawn);
  showFit(drawn);
  showCurve(drawn);
  showLandscape(drawn);
  showFamily(drawn);
  showWhatIf(drawn);
  showTell();
}

// Which generations of a long run the page has.
function whatIsKept() {
  const { first, improvements, of } = DATA.kept;
  const gains = improvements === of ? (of === 1 ? "the only one" : "all " + of) + " in which the best improves"
    : "of the " + of + " in which the best improves, the " + improvements + " with the largest gains";
  return "A long run: this page has " + DATA.generations.length + " of its " + DATA.of + " generations: the first " + first + ", " + gains + ", each with the one before it, and the last.";
}
// To the generation of this number, or to the last one before it that is on the page. What is no number of
// a generation stays in the box, and the page where it is.
function jump(entry) {
  const wanted = Number(entry);
  if (!entry || !Number.isInteger(wanted) || wanted < 1 || wanted > DATA.of) {
    at("jump").textContent = DATA.of === 1 ? "There is only number 1." : "Enter a number from 1 to " + DATA.of + ".";
    at("generation").setAttribute("aria-invalid", "true");
    return;
  }
  const g = upTo(wanted);
  goGeneration(g);
  if (number(g) === wanted) return;
  at("jump").textContent = DATA.generations[g].unit + " " + wanted + " is not on this page. Shown is " + number(g) + ".";
}
function previousGeneration() {
  const { g } = DATA.steps[current];
  if (current > STARTS[g]) go(STARTS[g]); else goGeneration(g - 1);
}
const ACTIONS = {
  "first": () => go(0),
  "last": () => go(DATA.steps.length - 1),
  "next": () => go(current + 1),
  "back": () => go(current - 1),
  "next-generation": () => goGeneration(DATA.steps[current].g + 1),
  "previous-generation": previousGeneration,
  "play": play,
};
const KEYS = { ArrowRight: "next", ArrowLeft: "back", PageDown: "next-generation", PageUp: "previous-generation", Home: "first", End: "last", " ": "play" };

function begin() {
  for (const [id, action] of Object.entries(ACTIONS)) {
    at(id).addEventListener("click", () => { if (id !== "play" && timer !== null) stop(); action(); });
  }
  document.addEventListener("keydown", event => {
    const { tagName, type } = event.target;
    // What is only clicked takes the space bar alone; other controls take all keys.
    const isClicked = tagName === "BUTTON" || type === "checkbox";
    const own = isClicked ? event.key === " " : ["INPUT", "SELECT"].includes(tagName);
    if (own || event.ctrlKey || event.altKey || event.metaKey || !KEYS[event.key]) return;
    event.preventDefault();
    at(KEYS[event.key]).click();
  });
  at("slider").addEventListener("input", event => go(STARTS[DATA.steps[current].g] + Number(event.target.value) - 1));
  at("generations").max = DATA.generations.length;
  at("generation").max = DATA.of;
  at("generations").addEventListener("input", event => goGeneration(Number(event.target.value) - 1));
  at("generation").addEventListener("change", event => jump(event.target.value.trim()));
  // Not every entry is one that the browser reports as a change: letters in a box for numbers.
  at("generation").addEventListener("keydown", event => { if (event.key === "Enter") jump(event.target.value.trim()); });
  for (const id of ["across", "up"]) {
    DATA.parameters.forEach((_, j) => at(id).append(new Option(name(j), j)));
    at(id).addEventListener("change", () => showLandscape(DATA.steps[current]));
  }
  at("whose").addEventListener("change", () => showFamily(DATA.steps[current]));
  at("population").addEventListener("keydown", alongRows);
  at("up").value = Math.min(1, DATA.parameters.length - 1);
  at("subject").textContent = (DATA.model ? DATA.model + ": " : "") + DATA.parameters.map((_, j) => titled(j)).join(", ");
  at("kept").textContent = whatIsKept();
  at("kept").hidden = DATA.generations.length === DATA.of;
  at("prediction").addEventListener("submit", predict);
  at("predicting").closest("label").hidden = !DATA.steps.some(step => step.question);
  at("predicting").addEventListener("change", () => show());
  at("unfold").addEventListener("change", () => show());
  at("future").addEventListener("change", () => showCurve(DATA.steps[current]));
  at("link").hidden = EMBEDDED;
  // Not every browser reports a resize to a page within a hidden one.
  new ResizeObserver(redraw).observe(document.documentElement);
  window.addEventListener("resize", redraw);
  follow();
  beginWhatIf();
  if (EMBEDDED && WHAT_IF) {
    // The reader has just asked for it.
    go(DATA.steps.length - 1, true);
    at("what-if-panel").scrollIntoView();
  }
  window.addEventListener("hashchange", follow);
}
function follow() {
  const asked = /^#step=(\d+)$/.exec(location.hash);
  go(asked ? Number(asked[1]) - 1 : 0, true);
}
if (document.readyState === "loading") document.addEventListener("DOMContentLoaded", begin); else queueMicrotask(begin);
