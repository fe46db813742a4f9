/* Charts: plain SVG at the width there is, a table behind each. */
const $ = (id) => document.getElementById(id);
const DATA = JSON.parse($("data").textContent); /* emulator/src/page.cpp says what is in it */
const number = (value, digits = 0) => value.toLocaleString("en", {minimumFractionDigits: digits, maximumFractionDigits: digits});
const escape = (text) => String(text).replace(/[&<>"]/g, (c) => ({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"}[c]));
/* Three digits that matter. */
const short = (value) => value === 0 ? "0" : number(value, Math.max(0, Math.min(4, 2 - Math.floor(Math.log10(Math.abs(value))))));
const count = (value, word, more = word + "s") => `${number(value)} ${value === 1 ? word : more}`;
const sum = (values) => values.reduce((a, b) => a + b, 0);
const fixed = (value) => +value.toFixed(2);

/* A table's rows as objects. */
function records(table) {
  return table.rows.map((row) => Object.fromEntries(table.columns.map((name, i) => [name, row[i]])));
}
const thinnedNote = (table, what) => table.rows.length < table.of ? `${number(table.rows.length)} of ${number(table.of)} ${what} are drawn; all are in the CSV tables.` : "";

/* At most n round values that cover low .. high. */
function ticks(low, high, n = 5) {
  const raw = (high - low || 1) / n, power = 10 ** Math.floor(Math.log10(raw));
  const step = [1, 2, 2.5, 5, 10].map((f) => f * power).find((s) => s >= raw * 0.999);
  const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
  return Array.from({length: last - first + 1}, (_, i) => +((first + i) * step).toPrecision(12));
}
const tickText = (value) => Math.abs(value) >= 1e6 ? number(value / 1e6, 1) + " M" : Math.abs(value) >= 1e4 ? number(value / 1e3) + " k" : String(value);

function text(x, y, content, {anchor = "start", kind = "", title = ""} = {}) {
  return `<text x="${fixed(x)}" y="${fixed(y)}" text-anchor="${anchor}" class="${kind}">${escape(content)}${title && `<title>${escape(title)}</title>`}</text>`;
}
function rect(x, y, width, height, fill, title = "", more = "") {
  return `<rect x="${fixed(x)}" y="${fixed(y)}" width="${fixed(Math.max(0, width))}" height="${fixed(Math.max(0, height))}" fill="var(--${fill})" ${more}>` +
    (title && `<title>${escape(title)}</title>`) + "</rect>";
}
const line = (x1, y1, x2, y2, kind = "grid", more = "") => `<line x1="${fixed(x1)}" y1="${fixed(y1)}" x2="${fixed(x2)}" y2="${fixed(y2)}" class="${kind}" ${more}/>`;
const legend = (entries) => `<div class="legend">${entries.map(([colour, label]) => `<span><i style="background:var(--${colour})"></i>${label}</span>`).join("")}</div>`;

/* The area between the axes, with its scales: x and y turn values into places. */
function plot(width, height, {x, y, left = 56, right = 14, top = 10, bottom = 40}) {
  const [x0, x1, y0, y1] = [left, width - right, height - bottom, top];
  return {
    x0, x1, y0, y1,
    x: (value) => x0 + (x1 - x0) * (value - x[0]) / (x[1] - x[0] || 1),
    y: (value) => y0 + (y1 - y0) * (value - y[0]) / (y[1] - y[0] || 1),
    axisX(label, values = ticks(x[0], x[1], Math.max(3, Math.floor((x1 - x0) / 80)))) {
      return line(x0, y0, x1, y0) + values.map((v) => line(this.x(v), y0, this.x(v), y0 + 4) + text(this.x(v), y0 + 17, tickText(v), {anchor: "middle", kind: "soft"})).join("") +
        text((x0 + x1) / 2, y0 + 34, label, {anchor: "middle", kind: "soft"});
    },
    axisY(label, values = ticks(y[0], y[1], Math.max(2, Math.floor((y0 - y1) / 40))), words = tickText) {
      return values.map((v) => line(x0, this.y(v), x1, this.y(v)) + text(x0 - 6, this.y(v) + 4, words(v), {anchor: "end", kind: "soft"})).join("") +
        `<text class="soft" text-anchor="middle" transform="translate(${x0 - left + 11} ${(y0 + y1) / 2}) rotate(-90)">${escape(label)}</text>`;
    },
  };
}

/* cells: text for strings, numbers otherwise; nothing for null. */
function tableHtml(columns, rows) {
  const kinds = columns.map((_, i) => rows.some((row) => typeof row[i] === "string") ? ' class="text"' : "");
  const cell = (value) => value === null || value === undefined ? "" : typeof value === "number" ? number(value, Number.isInteger(value) ? 0 : Math.abs(value) < 10 ? 3 : 1) : escape(value);
  return `<div class="scroll"><table><thead><tr>${columns.map((name, i) => `<th${kinds[i]} scope="col">${escape(name)}</th>`).join("")}</tr></thead><tbody>` +
    rows.map((row) => `<tr>${row.map((value, i) => `<td${kinds[i]}>${cell(value)}</td>`).join("")}</tr>`).join("") + "</tbody></table></div>";
}

/* The table is made when it is opened: a thousand rows cost nothing before. */
function addTable(parent, title, table) {
  const details = document.createElement("details");
  details.innerHTML = `<summary>${escape(title)}</summary>`;
  details.addEventListener("toggle", () => {
    if (details.open && details.childElementCount === 1) details.insertAdjacentHTML("beforeend", tableHtml(...table()));
  });
  parent.append(details);
}

const drawn = [];
/*
 * Draws into the element now and whenever the page's width changes. draw(width) gives {height, body}; label says what
 * is to be seen; below is HTML under it; table gives [columns, rows].
 */
function chart(id, {label, draw, below = "", table, tableTitle = "as a table"}) {
  const holder = document.createElement("div");
  const render = () => {
    const width = Math.max(240, Math.floor($(id).clientWidth));
    const {height, body} = draw(width);
    holder.innerHTML = `<svg width="${width}" height="${fixed(height)}" viewBox="0 0 ${width} ${fixed(height)}" role="img" aria-label="${escape(label)}">${body}</svg>`;
  };
  $(id).replaceChildren(holder);
  $(id).insertAdjacentHTML("beforeend", below);
  if (table) addTable($(id), tableTitle, table);
  render();
  drawn.push(render);
}
let pageWidth = window.innerWidth;
window.addEventListener("resize", () => {
  if (window.innerWidth === pageWidth) return;
  pageWidth = window.innerWidth;
  requestAnimationFrame(() => drawn.forEach((render) => render()));
});
const nothing = (id, why) => { $(id).innerHTML = `<p class="soft">${why}</p>`; };

/* Columns of equal width over the values of a quantity; series: [{name, colour, values}], stacked in that order; marks: [[value, text], ...]. */
function histogram(id, {series, quantity, unit, what, label, marks = []}) {
  const all = series.flatMap((one) => one.values);
  const high = Math.max(...all), low = Math.min(0.6 * high, Math.min(...all)) < 0.35 * high ? 0 : Math.min(...all);
  const steps = ticks(low, high || 1, 22), step = steps.length > 1 ? steps[1] - steps[0] : high || 1;
  const first = Math.floor(low / step + 1e-9), size = Math.max(1, Math.floor(high / step + 1e-9) - first + 1);
  const bins = series.map((one) => {
    const numbers = new Array(size).fill(0);
    for (const value of one.values) numbers[Math.min(size - 1, Math.max(0, Math.floor(value / step + 1e-9) - first))]++;
    return numbers;
  });
  const range = (i) => `${short((first + i) * step)} to ${short((first + i + 1) * step)} ${unit}`;
  const most = Math.max(...bins[0].map((_, i) => sum(bins.map((numbers) => numbers[i]))));
  chart(id, {
    label,
    draw(width) {
      const height = 210, p = plot(width, height, {x: [first * step, (first + size) * step], y: [0, most], top: 10 + 14 * marks.length});
      const parts = [p.axisY(what, ticks(0, most, 4).filter(Number.isInteger)), p.axisX(`${quantity}, ${unit}`)];
      for (let i = 0; i < size; i++) {
        let below = 0;
        bins.forEach((numbers, s) => {
          if (numbers[i] === 0) return;
          const [x, y] = [p.x((first + i) * step), p.y(below + numbers[i])];
          parts.push(rect(x + 1, y, p.x((first + i + 1) * step) - x - 2, p.y(below) - y, series[s].colour, `${series[s].name}: ${numbers[i]} of ${range(i)}`));
          below += numbers[i];
        });
      }
      marks.forEach(([value, words], i) => {
        const x = p.x(value), end = x > width - 90;
        parts.push(line(x, 14 * i + 3, x, p.y0, "", 'stroke="var(--ink)" stroke-dasharray="4 3"') + text(x + (end ? -4 : 4), 14 * i + 11, words, {anchor: end ? "end" : "start", kind: "halo"}));
      });
      return {height, body: parts.join("")};
    },
    below: series.length > 1 ? legend(series.map((one) => [one.colour, one.name])) : "",
    table: () => [["from", "to", ...series.map((one) => one.name)], bins[0].map((_, i) => [short((first + i) * step), `${short((first + i + 1) * step)} ${unit}`, ...bins.map((numbers) => numbers[i])])],
  });
}
