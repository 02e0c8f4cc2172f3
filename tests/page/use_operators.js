// Goes through all steps of a page of operators by name, and reports what is not shown as it should be.
(() => {
  const reports = [];
  const check = (what, holds, more) => reports.push((holds ? "ok: " : "WRONG: ") + what + (holds ? "" : " (" + more + ")"));
  const at = id => document.getElementById(id);
  const shown = element => element.getClientRects().length > 0;
  const data = JSON.parse(at("data").textContent);

  function steps() {
    data.steps.forEach((step, k) => {
      const what = "step " + (k + 1) + ", " + at("title").textContent + ": ";
      const rows = at("drawing").querySelectorAll("tr").length;
      check(what + "a row for each individual below the heading", rows === step.table.rows.length + 1, rows);
      check(what + "the call and the sentence", at("title").textContent.startsWith("Call ") && at("text").textContent === step.text, at("text").textContent);
      const marks = [...at("drawing").querySelectorAll("td.changed")].length;
      const expected = step.table.rows.flatMap(row => row.cells).filter(cell => cell[1] === "*").length;
      check(what + "changed genes are marked", marks === expected, marks + " of " + expected);
      check(what + "the line of the script", at("script").querySelector(".now").textContent.includes("Op_"), "no line");
      check(what + "no panel of a run", !["population", "fit", "curve", "landscape", "family", "tell", "what-if"].some(id => shown(at(id + "-panel"))), "one is shown");
      check(what + "the page is not wider than the window", document.documentElement.scrollWidth <= innerWidth, document.documentElement.scrollWidth);
      at("next").click();
    });
    check("the last step is the end", at("next").disabled, "more");
    at("previous-generation").click();
    check("back to the beginning of a call", at("title").textContent.startsWith("Call 5 "), at("title").textContent);
  }

  window.addEventListener("error", event => reports.push("WRONG: " + event.message));
  window.addEventListener("load", () => {
    try { steps(); } catch (error) { reports.push("WRONG: " + error.stack); }
    const told = "[[" + reports.join("\n") + "\nwidth " + innerWidth + "]]";
    if (parent !== window) return parent.postMessage(told, "*");
    document.body.replaceChildren(told);
  });
})();
