// Calls of operators by name: what went in and what came out, as a table.

// What only a run has to show.
const OF_RUNS = ["population", "fit", "curve", "landscape", "family", "tell", "what-if"];
function hideRun() {
  for (const id of OF_RUNS) at(id + "-panel").hidden = true;
  at("subject").textContent = DATA.parameters.join(", ");
}
// Calls on individuals of the script have a population, and nothing of a run; an evaluation alone has no
// forebears, and one gene no plane.
const EVOLVES = DATA.generations.some(generation => !generation.call && generation.after);
const IS_OF = {
  population: () => true,
  landscape: isCall => !isCall && DATA.parameters.length > 1,
  curve: isCall => !isCall && DATA.curve.length > 1,
  tell: isCall => !isCall && (EVOLVES || Boolean(DATA.result && Array.isArray(DATA.result.parameters))),
  family: isCall => !isCall && DATA.families.some(family => family.length > 1),
  "what-if": isCall => !isCall && EVOLVES,
};
function showRun(step) {
  const isCall = DATA.generations[step.g].call;
  for (const id of OF_RUNS) at(id + "-panel").hidden = IS_OF[id] ? !IS_OF[id](isCall) : isCall;
}
function showOperation(step) {
  const { columns, rows, left, legend } = step.table;
  const table = document.createElement("table");
  const hasNotes = rows.some(row => row.note);
  table.append(tableRow(["", ...columns, ...(hasNotes ? ["what becomes of it"] : [])], "th"));
  rows.forEach(row => {
    const cells = row.cells.map(([value, mark]) => short(value) + (mark === " " ? "" : " " + mark));
    const shown = tableRow([row.name, ...cells, ...(hasNotes ? [row.note] : [])], "td");
    row.cells.forEach(([, mark], j) => { shown.children[j + 1].className = GENE_CLASSES[mark] || ""; });
    table.append(shown);
  });
  const holder = document.createElement("div");
  holder.className = "scroll";
  holder.tabIndex = 0;
  holder.setAttribute("role", "group");
  holder.setAttribute("aria-label", "what went in and what came out");
  holder.append(table);
  note("drawing", [left ? "\u22ee " + left + " more" : "", legend].filter(Boolean).join("; "));
  if (rows.length) at("drawing").prepend(holder);
}
const GENE_CLASSES = { a: "first", b: "second", "*": "changed" };
function tableRow(cells, tag) {
  const tr = document.createElement("tr");
  cells.forEach(cell => { const td = document.createElement(tag); td.textContent = cell; tr.append(td); });
  return tr;
}
