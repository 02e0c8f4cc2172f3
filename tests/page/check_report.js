// Checks a report page as a reader uses it, and reports what is not as it should be.
(async () => {
  const reports = [];
  const check = (what, holds, more) => reports.push((holds ? "ok: " : "WRONG: ") + what + (holds || more === undefined ? "" : " (" + more + ")"));
  const all = selector => [...document.querySelectorAll(selector)];
  const within = document.documentElement;
  check("the page is no wider than the screen", within.scrollWidth <= within.clientWidth, within.scrollWidth + " > " + within.clientWidth);
  const lost = all("a[href^='#']").filter(a => !document.getElementById(a.hash.slice(1)));
  check("every link leads somewhere", lost.length === 0 && all("a[href]").length > 10, lost.map(a => a.hash).join());
  const ids = all("[id]").map(e => e.id);
  check("no id stands twice", new Set(ids).size === ids.length);
  const wider = all(".scroll").filter(e => e.tabIndex !== 0 || !e.getAttribute("aria-label"));
  check("what scrolls is reached with the tab key and has a name", wider.length === 0 && all(".scroll").length > 1);
  const nameless = all("svg").filter(e => !e.getAttribute("aria-label") && e.getAttribute("aria-hidden") !== "true");
  check("every figure has a name", nameless.length === 0 && all("figure svg").length > 1);
  document.querySelectorAll("details").forEach(d => { d.open = true; });
  const small = all("figure svg text").filter(t => t.getBoundingClientRect().width > 0 && Math.hypot(t.getScreenCTM().a, t.getScreenCTM().b) * parseFloat(t.getAttribute("font-size")) < 8);
  check("no letter of a figure is smaller than 8 pixels", small.length === 0, small.map(t => t.textContent).slice(0, 5).join());
  const unseen = all("figure svg text").filter(t => getComputedStyle(t).fill === getComputedStyle(document.body).backgroundColor);
  check("letters of figures have another colour than the page", unseen.length === 0);
  check("nor is it wider with everything unfolded", within.scrollWidth <= within.clientWidth, within.scrollWidth);
  if (window.axe) {
    const found = await axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"] });
    check("axe has no finding", found.violations.length === 0 && found.passes.length > 10,
      found.violations.map(v => v.id + ": " + v.nodes.slice(0, 3).map(n => n.target.join(" ")).join("; ")).join(" | "));
    reports.push("axe");
  }
  const dark = matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  reports.push(dark + " " + innerWidth);
  const text = "[[" + reports.join("\n") + "]]";
  if (parent === window) document.body.replaceChildren(text); else parent.postMessage(text, "*");
})();
