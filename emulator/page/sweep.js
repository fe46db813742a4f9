/* The page of a sweep: a chart for each figure over the first swept field, a line for each combination of the others, and the table. */
const {swept, columns, rows} = DATA, place = Object.fromEntries(columns.map((name, i) => [name, i]));
const keys = columns.slice(0, swept), complete = rows.filter((row) => !row[place.stopped]);
const LINES = ["listen", "send", "compute", "camera", "lost", "failed", "storage", "view"];
const unique = (values) => [...new Set(values)];
const xs = unique(rows.map((row) => row[0])), isNumeric = xs.every((value) => typeof value === "number");
const restOf = (row) => keys.slice(1).map((key, i) => `${key} = ${row[i + 1]}`).join(", ");
const lines = unique(rows.map(restOf)).map((name, i) => ({name, colour: LINES[i % LINES.length], rows: complete.filter((row) => restOf(row) === name)}));

/* Unit and meaning are in the name: docs/units.md, 7. */
const words = (column) => column.replace(/_(s|mj|uw|px|mm|days)(?=_|$)/, ", $1").replace(/_/g, " ").replace(/, (\w+) (.+)/, " $2, $1").replace(", uw", ", uW").replace(", mj", ", mJ");

function figureChart(id, column) {
  const at = place[column], values = complete.map((row) => row[at]).filter((value) => value !== null);
  const [low, high] = [Math.min(...values), Math.max(...values)], margin = (high - low || Math.abs(high) || 1) * 0.08;
  const bottom = low >= 0 && low < 0.5 * high ? 0 : low - margin;
  chart(id, {
    label: `${words(column)} over ${keys[0]}`,
    draw(width) {
      const height = 200, wide = isNumeric ? [Math.min(...xs), Math.max(...xs)] : [-0.5, xs.length - 0.5];
      const p = plot(width, height, {x: wide, y: [bottom, high + margin], left: 66, right: 20});
      const placeOf = (row) => [p.x(isNumeric ? row[0] : xs.indexOf(row[0])), p.y(row[at])];
      const every = Math.ceil(xs.length / ((p.x1 - p.x0) / 80));
      const parts = [p.axisY("", undefined, (value) => Math.abs(value) >= 1e6 ? tickText(value) : value.toLocaleString("en", {maximumFractionDigits: 6})), isNumeric ? p.axisX(keys[0]) : p.axisX(keys[0], [])];
      if (!isNumeric) xs.forEach((value, i) => { if (i % every === 0) parts.push(text(p.x(i), p.y0 + 17, value, {anchor: "middle", kind: "soft"})); });
      for (const one of lines) {
        const known = one.rows.filter((row) => row[at] !== null).sort((a, b) => placeOf(a)[0] - placeOf(b)[0]);
        if (known.length > 1) parts.push(`<path d="M${known.map((row) => placeOf(row).map(fixed).join(" ")).join("L")}" fill="none" stroke="var(--${one.colour})" stroke-width="2" stroke-linejoin="round"/>`);
        for (const row of known) {
          const [x, y] = placeOf(row), title = `${keys.map((key, i) => `${key} = ${row[i]}`).join(", ")}: ${row[at]}`;
          parts.push(`<circle cx="${fixed(x)}" cy="${fixed(y)}" r="4.5" fill="var(--${one.colour})" stroke="var(--card)" stroke-width="1.5"><title>${escape(title)}</title></circle>`);
        }
      }
      return {height, body: parts.join("")};
    },
  });
}

function showFigures() {
  const figures = columns.slice(swept, -1).filter((column) => column !== "stopped");
  const kinds = (column) => unique(complete.map((row) => row[place[column]]));
  const varied = figures.filter((column) => kinds(column).length > 1), same = figures.filter((column) => kinds(column).length === 1 && kinds(column)[0] !== null);
  $("figures-note").textContent = swept > 1 ? `— over ${keys[0]}, a line for each of the other values` : `— over ${keys[0]}`;
  if (lines.length > 1 && lines.length <= 24) $("legend").innerHTML = legend(lines.map((one) => [one.colour, escape(one.name)]));
  $("figures").innerHTML = varied.map((column) => `<div><h3>${escape(words(column))}</h3><div id="figure-${column}"></div></div>`).join("");
  varied.forEach((column) => figureChart(`figure-${column}`, column));
  const note = complete.length < 2 ? "There is nothing to compare: fewer than two runs are complete."
    : same.length > 0 ? `The same in every run: ${same.map((column) => `${words(column)}: ${kinds(column)[0]}`).join("; ")}.` : "";
  $("figures").insertAdjacentHTML("afterend", `<p class="soft note">${escape(note)}</p>`);
}

/* A run's folder, the last column, comes first: a link. */
function showRuns() {
  const first = (row) => [row[row.length - 1], ...row.slice(0, -1)];
  $("runs").innerHTML = tableHtml(first(columns), rows.map(first));
  document.querySelectorAll("#runs tbody td:first-child").forEach((cell) => { cell.innerHTML = `<a style="color:inherit" href="${cell.textContent}/index.html">${cell.textContent}</a>`; });
}

$("title").textContent = DATA.scenario;
document.title = `Tarsier: ${DATA.scenario}, a sweep`;
$("subtitle").textContent = `${count(rows.length, "run")} over ${keys.join(", ")}`;
const missing = DATA.planned - complete.length;
if (missing > 0) {
  $("notice").textContent = `A part of a sweep: ${count(missing, "run")} of ${DATA.planned} ${missing === 1 ? "is" : "are"} not complete.` +
    (complete.length < rows.length ? " One was stopped: it is in the table and not in the charts." : "");
  $("notice").hidden = false;
}
showFigures();
showRuns();
