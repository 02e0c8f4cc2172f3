"use strict";
/* What paper cannot do: values under the pointer, a closer look, series switched off, and the chapter
   unfolded where a link leads into it. Figures describe their areas for data in `data-area` (left, top,
   width, height), `data-x` and `data-y` (low, high, 1 if logarithmic). */

const digits = (value) => {
  const shown = Number(value.toPrecision(5));
  return String(shown).replace("-", "\u2212");
};

/* The value at a part (0 to 1) of an axis. */
const valueAt = ([low, high, logarithmic], part) =>
  logarithmic ? low * (high / low) ** part : low + (high - low) * part;

const numbers = (element, name) => element.getAttribute(name).split(" ").map(Number);

/* A point of the screen in the units of the figure. */
const inFigure = (svg, event) =>
  new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM().inverse());

const areaAt = (svg, at) =>
  [...svg.querySelectorAll("[data-area]")].find((area) => {
    const [left, top, width, height] = numbers(area, "data-area");
    return at.x >= left && at.x <= left + width && at.y >= top && at.y <= top + height;
  });

/* The corners of what is drawn in an area. */
const pointsOf = (group) => {
  const points = [];
  for (const circle of group.querySelectorAll("circle"))
    points.push([Number(circle.getAttribute("cx")), Number(circle.getAttribute("cy"))]);
  for (const line of group.querySelectorAll("polyline"))
    for (const pair of line.getAttribute("points").split(" ")) points.push(pair.split(",").map(Number));
  for (const path of group.querySelectorAll("path"))
    for (const [, x, y] of path.getAttribute("d").matchAll(/M([-.\d]+) ([-.\d]+)/g))
      points.push([Number(x), Number(y)]);
  return points;
};

const NEAR = 14;

/* The nearest point of a visible series, else the place itself. */
const nearest = (svg, area, at) => {
  let best = { distance: NEAR, x: at.x, y: at.y, name: "" };
  for (const group of svg.querySelectorAll(`[data-series][data-of="${area.dataset.of}"]`)) {
    if (group.classList.contains("hidden")) continue;
    for (const [x, y] of pointsOf(group)) {
      const distance = Math.hypot(x - at.x, y - at.y);
      if (distance < best.distance) best = { distance, x, y, name: group.dataset.series };
    }
  }
  return best;
};

const hovered = (figure, svg) => {
  const tip = document.createElement("div");
  tip.className = "tip hidden";
  tip.setAttribute("aria-hidden", "true");
  figure.append(tip);
  svg.addEventListener("pointermove", (event) => {
    const at = inFigure(svg, event);
    const area = areaAt(svg, at);
    tip.classList.toggle("hidden", !area);
    if (!area) return;
    const [left, top, width, height] = numbers(area, "data-area");
    const near = nearest(svg, area, at);
    const x = valueAt(numbers(area, "data-x"), (near.x - left) / width);
    const y = valueAt(numbers(area, "data-y"), 1 - (near.y - top) / height);
    tip.textContent = `${near.name ? near.name + "  " : ""}${digits(x)}  ${digits(y)}`;
    const frame = figure.getBoundingClientRect();
    const right = event.clientX - frame.left + 14;
    tip.style.left = `${Math.min(right, frame.width - tip.offsetWidth)}px`;
    tip.style.top = `${event.clientY - frame.top - 30}px`;
  });
  svg.addEventListener("pointerleave", () => tip.classList.add("hidden"));
};

/* A rectangle drawn with the mouse fills the figure; a double click shows all again. */
const zoomed = (svg) => {
  const whole = svg.getAttribute("viewBox");
  let from = null;
  let zone = null;
  const box = (to) => [Math.min(from.x, to.x), Math.min(from.y, to.y), Math.abs(from.x - to.x), Math.abs(from.y - to.y)];
  svg.addEventListener("pointerdown", (event) => {
    if (event.pointerType !== "mouse" || event.button !== 0) return;
    event.preventDefault();
    from = inFigure(svg, event);
    zone = document.createElementNS(svg.namespaceURI, "rect");
    zone.setAttribute("class", "zone");
    svg.append(zone);
    svg.setPointerCapture(event.pointerId);
  });
  svg.addEventListener("pointermove", (event) => {
    if (!from) return;
    const [x, y, width, height] = box(inFigure(svg, event));
    Object.entries({ x, y, width, height }).forEach(([name, value]) => zone.setAttribute(name, value));
  });
  svg.addEventListener("pointerup", (event) => {
    if (!from) return;
    const [x, y, width, height] = box(inFigure(svg, event));
    zone.remove();
    from = null;
    if (width > 8 && height > 8) svg.setAttribute("viewBox", `${x} ${y} ${width} ${height}`);
  });
  svg.addEventListener("dblclick", () => svg.setAttribute("viewBox", whole));
};

/* Buttons that switch the named series of a figure. */
const switched = (figure, svg) => {
  const groups = [...svg.querySelectorAll("[data-series]")];
  const names = [...new Set(groups.map((group) => group.dataset.series))].filter((name) => name);
  if (names.length < 2) return;
  const keys = document.createElement("div");
  keys.className = "keys";
  for (const name of names) {
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = name;
    button.setAttribute("aria-pressed", "true");
    button.addEventListener("click", () => {
      const shown = button.getAttribute("aria-pressed") === "true";
      button.setAttribute("aria-pressed", String(!shown));
      for (const group of groups)
        if (group.dataset.series === name) group.classList.toggle("hidden", shown);
    });
    keys.append(button);
  }
  svg.after(keys);
};

for (const svg of document.querySelectorAll("figure:not(.legend) svg")) {
  const figure = svg.closest("figure");
  hovered(figure, svg);
  zoomed(svg);
  if (!figure.parentElement.classList.contains("small")) switched(figure, svg);
}

const unfold = () => {
  const target = location.hash && document.getElementById(decodeURIComponent(location.hash.slice(1)));
  const folded = target && target.closest("details");
  if (folded && !folded.open) {
    folded.open = true;
    target.scrollIntoView();
  }
};
addEventListener("hashchange", unfold);
unfold();
