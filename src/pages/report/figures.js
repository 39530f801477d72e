// What every page offers: figures as files, and units of the reader's choice. Without scripts the
// page shows all numbers in SI.
"use strict";

/** Saves a blob under a name. */
function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

/** A drawing that needs no page: its colours and fonts are in it. */
function standalone(svg) {
  const copy = svg.cloneNode(true), from = [svg, ...svg.querySelectorAll("*")], to = [copy, ...copy.querySelectorAll("*")];
  from.forEach((element, k) => {
    const style = getComputedStyle(element);
    for (const name of ["color", "fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "font-family", "font-size", "font-weight", "text-anchor"])
      to[k].style.setProperty(name, style.getPropertyValue(name));
    delete to[k].dataset.points;
  });
  const { width, height } = svg.viewBox.baseVal;
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", width);
  copy.setAttribute("height", height);
  copy.style.background = getComputedStyle(svg.closest("figure")).backgroundColor;
  return { text: new XMLSerializer().serializeToString(copy), width, height };
}

/** The points of all curves, a row each. */
function csvOf(figure) {
  const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
  const rows = ["curve,x,y"];
  for (const curve of figure.querySelectorAll("[data-points]"))
    for (const point of curve.dataset.points.split(" ").filter(Boolean)) rows.push(`${quoted(curve.dataset.name || figure.id)},${point}`);
  return rows.join("\n") + "\n";
}

const files = {
  SVG: (figure, svg) => save(new Blob([standalone(svg).text], { type: "image/svg+xml" }), `${figure.id}.svg`),
  PNG: (figure, svg) => {
    const { text, width, height } = standalone(svg), image = new Image(), canvas = document.createElement("canvas");
    image.onload = () => {
      canvas.width = 3 * width;
      canvas.height = 3 * height;
      canvas.getContext("2d").drawImage(image, 0, 0, canvas.width, canvas.height);
      canvas.toBlob((blob) => save(blob, `${figure.id}.png`));
    };
    image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(text);
  },
  CSV: (figure) => save(new Blob([csvOf(figure)], { type: "text/csv" }), `${figure.id}.csv`),
};

for (const figure of document.querySelectorAll("figure.chart")) {
  const svg = figure.querySelector("svg"), bar = document.createElement("p");
  bar.className = "files";
  for (const [kind, make] of Object.entries(files)) {
    if (kind === "CSV" && !figure.querySelector("[data-points]")) continue;
    const button = document.createElement("button");
    button.type = "button";
    button.textContent = kind;
    button.setAttribute("aria-label", `Save ${figure.querySelector("figcaption").textContent} as ${kind}`);
    button.addEventListener("click", () => make(figure, svg));
    bar.append(button);
  }
  figure.append(bar);
}

/** Units that a reader may choose, by the one of the page: how many of them it is. */
const units = { W: { W: 1, "J/min": 60, "kJ/h": 3.6 }, "W/kg": { "W/kg": 1, "J/(g min)": 0.06, "kJ/(g h)": 0.0036 },
  h: { h: 1, min: 60, s: 3600 }, "1/s": { "1/s": 1, "1/min": 60 } };
const cards = [...document.querySelectorAll(".card [data-unit]")];
const choices = [...new Set(cards.map((card) => card.dataset.unit))].filter((unit) => units[unit]);
if (choices.length) {
  const bar = document.createElement("p");
  bar.className = "units";
  for (const unit of choices) {
    const label = document.createElement("label"), select = document.createElement("select");
    for (const other of Object.keys(units[unit])) select.append(new Option(other));
    label.append(`show ${unit} in `, select);
    bar.append(label);
    select.addEventListener("change", () => {
      const factor = units[unit][select.value];
      for (const card of cards.filter((c) => c.dataset.unit === unit)) {
        const number = (value) => Number((factor * value).toPrecision(card.dataset.interval ? 4 : 3)).toString();
        card.querySelector("strong").textContent = number(card.dataset.value);
        card.querySelector(".unit").textContent = ` ${select.value}`;
        const interval = card.parentElement.querySelector(".interval");
        if (interval) interval.textContent = `\u00b1 ${Number((factor * card.dataset.interval).toPrecision(2))} ${select.value}`;
      }
    });
  }
  document.querySelector(".cards").after(bar);
}
