// Uses every control of the page as a reader would, and reports what does not do what it should.
(() => {
  const reports = [];
  const check = (what, holds, more) => reports.push((holds ? "ok: " : "WRONG: ") + what + (holds || more === undefined ? "" : " (" + more + ")"));
  const at = id => document.getElementById(id);
  const all = (id, selector) => [...at(id).querySelectorAll(selector)];
  const data = JSON.parse(at("data").textContent);
  const title = () => at("title").textContent;
  const click = id => at(id).click();
  const key = (name, target) => (target || document.body).dispatchEvent(new KeyboardEvent("keydown", { key: name, bubbles: true, cancelable: true }));
  const choose = (id, value, event) => { at(id).value = value; at(id).dispatchEvent(new Event(event || "change", { bubbles: true })); };
  const step = () => Number(/^#step=(\d+)$/.exec(location.hash)[1]);
  const find = (part, g) => data.steps.findIndex(s => s.title === part && s.g === g) + 1;
  // Browsers count changes of the address, and ignore them where there are many.
  const visit = number => {
    const { g } = data.steps[number - 1];
    choose("generations", String(g + 1), "input");
    choose("slider", String(number - data.steps.findIndex(s => s.g === g)), "input");
  };

  function buttonsAndKeys() {
    check("the first step is shown first", title().startsWith("Generation 1 of") && at("back").disabled && at("first").disabled);
    click("next"); check("next", step() === 2, step());
    click("back"); check("back", step() === 1, step());
    click("next-generation"); check("next generation", title().startsWith("Generation 2 "), title());
    click("next"); click("previous-generation"); check("to the beginning of this generation", step() === find(data.steps.find(s => s.g === 1).title, 1), step());
    click("previous-generation"); check("previous generation", title().startsWith("Generation 1 "), title());
    click("last"); check("last", step() === data.steps.length && at("next").disabled && at("last").disabled && at("next-generation").disabled, step());
    click("first"); check("first", step() === 1, step());
    const moves = [["ArrowRight", 2], ["ArrowRight", 3], ["ArrowLeft", 2], ["End", data.steps.length], ["Home", 1]];
    for (const [name, to] of moves) { key(name); check("key " + name, step() === to, step()); }
    key("PageDown"); check("key PageDown", title().startsWith("Generation 2 "), title());
    key("PageUp"); check("key PageUp", title().startsWith("Generation 1 "), title());
    key("ArrowRight", at("generation")); check("keys in a field are the field's own", step() === 1, step());
  }

  function slidersAndLink() {
    choose("generations", "3", "input"); check("slider of generations", title().startsWith("Generation 3 ") && at("generation").value === "3", title());
    const before = step();
    choose("slider", "4", "input"); check("slider of steps", step() === before + 3, step());
    choose("generation", "2"); check("number of the generation", title().startsWith("Generation 2 "), title());
    check("the link leads to this step", at("link").hash === location.hash && step() === find(data.steps.find(s => s.g === 1).title, 1));
    check("no control is without a name", [...document.querySelectorAll("button, input, select, a")].every(e => e.getAttribute("aria-label") || e.textContent.trim() || e.closest("label")));
  }

  function panels() {
    visit(find("crossover", 0));
    const line = at("script").querySelector("[aria-current]");
    check("the script shows the line of Cross", line && line.textContent.includes("Cross("), line && line.textContent);
    const strong = all("population", "line").filter(l => l.getAttribute("stroke-width") === "2.5");
    check("lines lead from two parents to two children", strong.length === 4, strong.length);
    const count = data.generations[0].genes.length / data.generations[0].n;
    const born = data.generations[0].elites + 2;
    check("the children so far stand beside their parents", all("population", ".row").length === count + born, all("population", ".row").length);
    check("crossover has four rows of boxes", all("drawing", "rect").length === 4 * data.generations[0].n, all("drawing", "rect").length);
    const fills = all("drawing", "rect").map(r => r.getAttribute("fill"));
    check("children's boxes have their parents' colours", new Set(fills.slice(-data.generations[0].n)).size === 2, fills.join());
    mutation();
    drawings(count);
    visit(find("selection", 0));
    check("a line parts the parents from the others", all("population", ".cut").length === 1);
    visit(find("fitness", 0));
    check("all measured points are drawn", all("fit", "circle").length === data.x.length, all("fit", "circle").length);
    check("the sum is given", /sum of the squared distances.*: [\d.]+/.test(at("fit").textContent), at("fit").textContent);
    check("the fitness stands behind each row", all("population", ".row").every(row => row.querySelectorAll("text").length === 2));
    future();
    visit(find("fitness", 0));
    landscapeAndFamily();
  }
  // On each kind of step the sentence, the drawing and rows of the population are in the window.
  function inView() {
    const height = window.innerHeight - (innerWidth < 760 ? 56 : 0), bottom = id => { const { top, bottom } = at(id).getBoundingClientRect(); return [top, bottom]; };
    for (const kind of new Set(data.steps.map(s => s.title))) {
      visit(find(kind, data.steps.find(s => s.title === kind).g));
      scrollTo(0, 0);
      check(kind + " is drawn", all("drawing", "svg").length === 1, at("drawing").textContent);
      const cut = all("drawing", "text").filter(t => t.getBBox().x < -1 || t.getBBox().x + t.getBBox().width > t.ownerSVGElement.viewBox.baseVal.width + 1);
      check(kind + ": no text is cut off", cut.length === 0, cut.map(t => t.textContent).join());
      check(kind + ": the sentence is in view", bottom("text")[1] <= height, bottom("text"));
      check(kind + ": the drawing is in view", bottom("drawing")[1] <= height, bottom("drawing"));
      const rows = all("population", ".row").filter(row => row.getBoundingClientRect().bottom <= height).length;
      check(kind + ": rows of the population are in view", rows >= 4, rows);
      if (innerWidth >= 1180) check(kind + ": the line of the script is in view", !at("script").querySelector(".now") || (at("script").querySelector(".now").getBoundingClientRect().bottom <= height && at("script").getBoundingClientRect().top < height), "below");
    }
    click("last");
    check("no generation is announced behind the last one", !at("population").textContent.includes("generation " + (data.of + 1)), at("population").textContent);
  }
  function drawings(count) {
    visit(find("initial population", 0));
    check("the draw has one place for each gene", all("drawing", ".drawn").length === data.generations[0].n, all("drawing", ".drawn").length);
    check("and those of the others", all("drawing", ".other").length === (count - 1) * data.generations[0].n);
    visit(find("fitness", 0));
    check("each individual has a bar of its fitness", all("drawing", ".bar").length === count, all("drawing", ".bar").length);
    visit(find("selection", 0));
    const grey = all("drawing", ".bar[fill='var(--line)']").length;
    check("who is no parent is grey, behind the cut", grey === count - data.generations[0].parents - all("drawing", "path.bar").length && all("drawing", ".border").length === 1, grey);
    check("small populations are not folded", at("unfolding").hidden);
    at("changed").value = "N_Parents"; at("changed").dispatchEvent(new Event("change"));
    check("another number of parents is proposed", at("changed-to").value === String(Math.floor(data.generations[0].parents / 2)), at("changed-to").value);
    at("what-if").dispatchEvent(new Event("submit", { cancelable: true }));
    check("what if: both runs, or the command for them", at("both").hidden ? window.parent !== window || at("what-if-said").textContent.includes("--what-if \"N_Parents := ") : all("both", "svg").length > 0, at("what-if-said").textContent);
  }
  function future() {
    const length = () => all("curve", "path").map(p => p.getAttribute("d").split("L").length);
    check("nothing of the future is drawn at first", length().length === 0, length());
    choose("generation", "4"); key("End"); click("first"); choose("generation", "4");
    while (data.steps[step() - 1].title !== "fitness") click("next");
    check("convergence ends at this generation", length().join() === "4", length());
    check("the generation is marked on it", all("curve", "line[stroke-dasharray]").length === 1);
    at("future").click();
    check("how it goes on is drawn when asked for", length().length === 2 && length()[0] === data.curve.length - 3, length());
    at("future").click();
    check("and not otherwise", length().join() === "4", length());
    check("the verdict of the data is kept for the end", all("tell", "tr").length === 0);
    click("last");
    check("every parameter is judged", !data.result || all("tell", "tr").length === data.parameters.length + 1, all("tell", "tr").length);
    const before = title();
    for (const entry of [String(data.of + 50), "0", "1.5", ""]) {
      choose("generation", entry); check("`" + entry + "` is no generation", title() === before && at("generation").value === entry && at("jump").textContent === "Enter a number from 1 to " + data.of + ".", at("jump").textContent);
    }
    choose("generation", "2"); check("and then one that is", title().startsWith("Generation 2 ") && at("jump").textContent === "" && !at("generation").hasAttribute("aria-invalid"), title());
  }
  function prediction() {
    click("first");
    at("predicting").click();
    const asked = data.steps.map((s, k) => s.question ? k + 1 : 0).filter(k => k);
    const say = text => { at("answer").value = text; at("prediction").dispatchEvent(new Event("submit", { cancelable: true })); };
    const right = answer => { const [[kind, { right }]] = Object.entries(answer); return kind === "Individuals" ? right.join(" ") : kind === "Decision" ? (right ? "yes" : "no") : String(right); };
    const wrong = answer => { const [[kind, { right, of }]] = Object.entries(answer); return kind === "Number" ? String(right % of + 1) : kind === "Decision" ? (right ? "no" : "yes") : kind === "Letters" ? right.replace(/[ab]/g, c => c === "a" ? "b" : "a") : [...Array(right.length + 1).keys()].slice(1).map(k => k === right[0] ? right.length + 1 : k).join(" "); };
    visit(asked[0]);
    const question = data.steps[asked[0] - 1].question;
    check("the question is asked instead of the answer", at("text").textContent === question.text && !at("prediction").hidden, at("text").textContent);
    check("the answer is not drawn yet", all("population", ".cut").length === 0);
    say(right(question.answer));
    check("a right answer counts", at("score").textContent === "Right. 1 of 1 correct", at("score").textContent);
    check("then the step is shown", at("text").textContent === data.steps[asked[0] - 1].text && all("population", ".cut").length === 1);
    const kinds = new Set(data.steps.filter(s => s.question).map(s => s.title + " " + Object.keys(s.question.answer)[0]));
    check("parents, pair, heritage and mutation are asked for", ["crossover Number", "crossover Letters", "mutation Decision"].every(kind => kinds.has(kind)) && [...kinds].some(kind => kind.startsWith("selection ")), [...kinds].join());
    for (const number of asked) {
      visit(number);
      const score = at("score").textContent;
      if (number === asked[0]) continue;
      say("nonsense 99x");
      check("nonsense is asked again and does not count, step " + number, at("score").textContent.startsWith("Enter ") && !at("answer").disabled, at("score").textContent);
      if (number > asked[4]) break;
    }
    visit(asked[1]); say(wrong(data.steps[asked[1] - 1].question.answer));
    check("a wrong answer is put right", at("score").textContent.startsWith("No: the answer is") && at("score").textContent.endsWith("1 of 2 correct"), at("score").textContent);
    at("predicting").click();
    check("without predictions nothing is asked", at("prediction").hidden);
  }
  function mutation() {
    const first = data.steps.findIndex(s => s.g === 0 && s.title === "mutation" && s.text.includes("becomes"));
    visit(first + 1);
    const thick = all("drawing", "rect").filter(r => r.getAttribute("stroke-width") === "3").length;
    const n = data.generations[0].n, of = data.steps[first].of;
    const hits = data.generations[0].u.slice(of * n, (of + 1) * n).filter(u => u < data.generations[0].factor).length;
    check("genes that mutate have a thick edge", thick === hits && hits > 0, thick);
    check("the number of each gene lies on its scale", all("drawing", "circle.hit").length === hits && all("drawing", "circle.missed").length === n - hits);
    check("the place of the new gene in its range", all("drawing", "circle").length === n + hits);
    check("the mutated gene is marked in the matrix", all("population", "circle").length >= hits);
  }
  function landscapeAndFamily() {
    const picture = id => at(id).innerHTML;
    const before = picture("landscape");
    check("both genes can be chosen", at("across").options.length === data.parameters.length && at("up").options.length === data.parameters.length);
    choose("across", String(data.parameters.length - 1)); check("another gene across", picture("landscape") !== before);
    const between = picture("landscape");
    choose("up", "0"); check("another gene up", picture("landscape") !== between);
    check("fields and dots", all("landscape", ".field").length > 0 && all("landscape", "circle, path").length === data.generations[0].fitness.length);
    choose("whose", "winner");
    check("the winner's family", all("family", ".member").length === data.families[data.winner].length, all("family", ".member").length);
    check("lines lead to its parents", all("family", "line").length === data.families[data.winner].flatMap(m => m.from).filter(p => p !== null).length);
    choose("whose", "now"); check("the family of this generation's best", all("family", ".member").length === data.families[data.family_of[0]].length);
  }

  function rows() {
    const first = at("population").querySelector(".row[tabindex='0']");
    first.focus(); check("a row tells its numbers", at("individual").textContent.includes(data.parameters[0] + " = "), at("individual").textContent);
    const text = at("individual").textContent;
    key("ArrowDown", document.activeElement); check("the arrows go from row to row", at("individual").textContent !== text);
    key("ArrowUp", document.activeElement); check("and back", at("individual").textContent === text);
    check("the rows are one stop of the tab key", all("population", ".row[tabindex='0']").length === 1);
    key("ArrowRight", document.activeElement); check("the place is kept from step to step", at("population").contains(document.activeElement));
    document.activeElement.blur();
  }

  const wait = time => new Promise(done => setTimeout(done, time));
  async function playing() {
    click("first"); click("play"); check("play can be paused", at("play").textContent === "Pause");
    await wait(2000); check("play goes on step by step", step() === 3, step());
    key(" "); check("the space key pauses", at("play").textContent === "Play");
    await wait(2000); check("paused", step() === 3, step());
    choose("pace", "3"); click("play"); await wait(2000); check("play by generations", title().startsWith("Generation 3 "), title());
    click("next"); check("a step stops playing", at("play").textContent === "Play");
    choose("pace", "2"); click("first"); click("play"); await wait(1000); check("play by parts", step() > 1 && data.steps[step() - 1].title !== data.steps[0].title);
    click("play"); choose("pace", "1"); click("last"); click("back"); click("play"); await wait(3000);
    check("play ends at the end", step() === data.steps.length && at("play").textContent === "Play", step());
    location.hash = "#step=5"; await wait(100); check("a link is followed", at("link").hash === "#step=5");
  }
  function outside() {
    check("nothing is loaded", performance.getEntriesByType("resource").length === 0);
    check("the page is not wider than the window", document.documentElement.scrollWidth <= innerWidth, document.documentElement.scrollWidth + " in " + innerWidth);
    const texts = [...document.querySelectorAll("svg text")].filter(t => t.getBBox().x < -1 || t.getBBox().x + t.getBBox().width > t.ownerSVGElement.viewBox.baseVal.width + 1);
    check("no text of a drawing is cut off", texts.length === 0, texts.map(t => t.textContent).join());
  }

  window.addEventListener("error", event => reports.push("WRONG: " + event.message));
  window.addEventListener("load", async () => {
    try { buttonsAndKeys(); slidersAndLink(); inView(); panels(); prediction(); outside(); rows(); await playing(); outside(); } catch (error) { reports.push("WRONG: " + error.stack); }
    const told = "[[" + reports.join("\n") + "\nwidth " + innerWidth + "]]";
    if (parent !== window) return parent.postMessage(told, "*");
    document.body.replaceChildren(told);
  });
})();
