/*
 * The page of a sweep: a chart for each figure over the first swept field, a line for each combination of the others,
 * and the table. Seeds are no line of their own: their runs make one point, the mean, with whiskers from the least to
 * the largest.
 */
const {swept, columns, rows} = DATA, place = Object.fromEntries(columns.map((name, i) => [name, i]));
const complete = rows.filter((row) => !row[place.stopped]);
const LINES = ["listen", "send", "compute", "camera", "lost", "failed", "storage", "view"];
const unique = (values) => [...new Set(values)];
const keys = columns.slice(0, swept), seedAt = keys.indexOf("seed");
const overSeeds = seedAt >= 0 && swept > 1; /* seeds alone are the axis */
const axes = keys.map((_, i) => i).filter((i) => !(overSeeds && i === seedAt)), xAt = axes[0];
const xs = unique(rows.map((row) => row[xAt])), isNumeric = xs.every((value) => typeof value === "number");
const restOf = (row) => axes.slice(1).map((i) => `${keys[i]} = ${row[i]}`).join(", ");
const lines = unique(rows.map(restOf)).map((name, i) => ({name, colour: LINES[i % LINES.length], rows: complete.filter((row) => restOf(row) === name)}));

/* Unit and meaning are in the name: docs/units.md, 7. */
const words = (column) => column.replace(/_(s|mj|uw|px|mm|days)(?=_|$)/, ", $1").replace(/_/g, " ").replace(/, (\w+) (.+)/, " $2, $1").replace(", uw", ", uW").replace(", mj", ", mJ");

/* What a line has at each x: the mean of its runs there, their least and largest. */
function pointsOf(one, at) {
  const known = one.rows.filter((row) => row[at] !== null);
  return unique(known.map((row) => row[xAt])).map((x) => {
    const own = known.filter((row) => row[xAt] === x), values = own.map((row) => row[at]);
    const name = axes.map((i) => `${keys[i]} = ${own[0][i]}`).join(", "), mean = sum(values) / values.length, [low, high] = [Math.min(...values), Math.max(...values)];
    const title = overSeeds ? `${name}: mean ${short(mean)} of ${count(values.length, "seed")}, ${short(low)} to ${short(high)}` : `${name}: ${mean}`;
    return {x, mean, low, high, title};
  }).sort((a, b) => isNumeric ? a.x - b.x : xs.indexOf(a.x) - xs.indexOf(b.x));
}

function whisker(x, top, bottom, colour) {
  return `<path d="M${fixed(x)} ${fixed(top)}L${fixed(x)} ${fixed(bottom)}M${fixed(x - 4)} ${fixed(top)}h8M${fixed(x - 4)} ${fixed(bottom)}h8" class="whisker" fill="none" stroke="var(--${colour})" stroke-width="1.5"/>`;
}

function drawLine(p, {colour}, points) {
  const centre = (point) => p.x(isNumeric ? point.x : xs.indexOf(point.x)), parts = [];
  if (points.length > 1 && !(seedAt >= 0 && !overSeeds)) {
    parts.push(`<path d="M${points.map((point) => `${fixed(centre(point))} ${fixed(p.y(point.mean))}`).join("L")}" fill="none" stroke="var(--${colour})" stroke-width="2" stroke-linejoin="round"/>`);
  }
  for (const point of points) {
    if (overSeeds && point.low < point.high) parts.push(whisker(centre(point), p.y(point.high), p.y(point.low), colour));
    parts.push(`<circle cx="${fixed(centre(point))}" cy="${fixed(p.y(point.mean))}" r="4.5" fill="var(--${colour})" stroke="var(--card)" stroke-width="1.5"><title>${escape(point.title)}</title></circle>`);
  }
  return parts.join("");
}

function figureChart(id, column) {
  const at = place[column], drawn = lines.map((one) => [one, pointsOf(one, at)]), all = drawn.flatMap(([, points]) => points);
  const [low, high] = [Math.min(...all.map((point) => point.low)), Math.max(...all.map((point) => point.high))], margin = (high - low || Math.abs(high) || 1) * 0.08;
  const bottom = low >= 0 && low < 0.5 * high ? 0 : low - margin;
  chart(id, {
    label: `${words(column)} over ${keys[xAt]}`,
    draw(width) {
      const height = 200, wide = isNumeric ? [Math.min(...xs), Math.max(...xs)] : [-0.5, xs.length - 0.5];
      const p = plot(width, height, {x: wide, y: [bottom, high + margin], left: 66, right: 20});
      const every = Math.ceil(xs.length / ((p.x1 - p.x0) / 80));
      const parts = [p.axisY("", undefined, (value) => Math.abs(value) >= 1e6 ? tickText(value) : value.toLocaleString("en", {maximumFractionDigits: 6})), isNumeric ? p.axisX(keys[xAt]) : p.axisX(keys[xAt], [])];
      if (!isNumeric) xs.forEach((value, i) => { if (i % every === 0) parts.push(text(p.x(i), p.y0 + 17, value, {anchor: "middle", kind: "soft"})); });
      return {height, body: parts.join("") + drawn.map(([one, points]) => drawLine(p, one, points)).join("")};
    },
  });
}

/* How many came and how right they are, then all else as in the table. */
function inOrder(figures) {
  const first = (column) => column === "maps_received" ? 0 : /^(error_|matched$|correct$)/.test(column) ? 1 : 2;
  return [...figures].sort((a, b) => first(a) - first(b));
}

function showFigures() {
  const figures = inOrder(columns.slice(swept, -1).filter((column) => column !== "stopped"));
  const kinds = (column) => unique(complete.map((row) => row[place[column]]));
  const varied = figures.filter((column) => kinds(column).length > 1), same = figures.filter((column) => kinds(column).length === 1 && kinds(column)[0] !== null);
  const seeds = overSeeds ? `; points: mean over ${count(unique(rows.map((row) => row[seedAt])).length, "seed")}, whiskers: least to largest` : "";
  $("figures-note").textContent = `— over ${keys[xAt]}${axes.length > 1 ? ", a line for each of the other values" : ""}${seeds}`;
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
