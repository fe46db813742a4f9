/* When what happened: rows of numbers over time, then a lane for each camera. */
const FATES = [["committed", "committed", "map delivered"], ["withheld", "withheld", "like the last one, withheld"], ["measured", "compute", "measured for its zones alone"], ["lost", "lost", "given up"], ["failed", "failed", "no map came of it"]];
const FATE_COLOUR = {...Object.fromEntries(FATES.map(([fate, colour]) => [fate, colour])), "view": "view", "under way": "soft"};
const FATE_WORDS = {...Object.fromEntries(FATES.map(([fate, , words]) => [fate, words])), "view": "view sent to its lead", "under way": "under way at the end"};
/* Phases as they mean something to a reader. */
const PHASE_COLOUR = {waking: "listen", capturing: "storage", receiving: "listen", unpacking: "compute", reference: "compute", matching: "compute", median: "compute", measuring: "compute", comparing: "compute",
  filtering: "compute", encoding: "compute", sealing: "compute", sending: "send"};
const END = Math.max(summary.virtual_time_s, 1e-3);

const EVENT_ROWS = 4, EVENT_ROW_HEIGHT = 15;
/* A label goes to the first row that has room for it, the lowest only if no later mark is there; without any, its mark
 * alone is there, with a title. */
function eventRows(x, right) {
  const ends = [];
  const events = DATA.events.filter(([at]) => at <= END), places = events.map(([at]) => x(at));
  return events.map(([at, what], i) => {
    const place = places[i], long = what.length * 6 + 12, from = place + 7 + long <= right + 12 ? place : place - long - 7;
    const marked = places.some((other, k) => k !== i && other > from - 4 && other < from + long);
    let row = ends.findIndex((end, k) => end < from && !(k === 0 && marked));
    if (row < 0 && ends.length === 0 && marked) ends.push(-Infinity);
    if (row < 0 && ends.length < EVENT_ROWS) row = ends.push(-Infinity) - 1;
    if (row >= 0) ends[row] = from + long;
    return {place, row, what, before: from < place, title: `${what} at ${number(at, 1)} s`};
  });
}

function drawEvents(events, y, rows) {
  const base = y + EVENT_ROW_HEIGHT * rows;
  return text(0, base - 3, "the scene", {kind: "soft"}) + events.map(({place, row, what, before, title}) => {
    const level = row < 0 ? base : base - EVENT_ROW_HEIGHT * row;
    return `<g>${row > 0 ? line(place, level, place, base - 7) : ""}<path d="M${fixed(place)} ${fixed(base)}l-4 -7h8z" fill="var(--ink)"/><title>${escape(title)}</title></g>` +
      (row < 0 ? "" : text(place + (before ? -7 : 7), level, what, {kind: "small halo", anchor: before ? "end" : "start", title}));
  }).join("");
}

/* One row of columns over time. */
function binRow(x, y, height, left, title, series) {
  const {bin_s: width} = DATA.timeline, size = DATA.timeline.looks.length;
  const most = Math.max(1, ...Array.from({length: size}, (_, i) => sum(series.map(([key]) => DATA.timeline[key][i]))));
  const parts = [line(left, y + height, x(END), y + height), text(0, y + height / 2 + 4, title, {kind: "soft"}), text(left - 6, y + 9, tickText(most), {anchor: "end", kind: "soft small"})];
  for (let i = 0; i < size; i++) {
    let below = 0;
    for (const [key, colour, words] of series) {
      const value = DATA.timeline[key][i], high = height * value / most, from = x(i * width), until = x(Math.min(END, (i + 1) * width));
      if (value > 0) parts.push(rect(from, y + height - below - high, Math.max(0.8, until - from - (until - from > 3 ? 0.6 : 0)), high, colour, `${number(value)} ${words}, ${i * width} to ${(i + 1) * width} s`));
      below += high;
    }
  }
  return parts.join("");
}

/* Faults in the lane of their node; those of no node cross all lanes. */
function faultMarks(x, laneOf, top, laneHeight, lanes) {
  return summary.faults.filter((fault) => fault.at_s <= END).map((fault) => {
    const lane = laneOf.get(fault.node), y = lane === undefined ? top : top + lane * laneHeight, high = lane === undefined ? lanes * laneHeight : laneHeight;
    const until = Math.min(END, faultUntil(fault) ?? (/reboot|restart/.test(fault.kind) ? fault.at_s : END));
    const more = [faultPlace(fault), fault.for_s && `for ${number(fault.for_s, 2)} s`, faultDetails(fault)].filter(Boolean);
    const title = `${fault.kind} at ${number(fault.at_s, 2)} s${more.map((one) => ", " + one).join("")}`;
    return `<g><rect x="${fixed(x(fault.at_s))}" width="${fixed(x(until) - x(fault.at_s))}" y="${fixed(y)}" height="${fixed(high)}" fill="var(--lost)" fill-opacity=".14"/>` +
      `<line x1="${fixed(x(fault.at_s))}" x2="${fixed(x(fault.at_s))}" y1="${fixed(y)}" y2="${fixed(y + high)}" stroke="var(--lost)" stroke-width="1.6" stroke-dasharray="3 2"/>` +
      (laneHeight >= 16 ? text(x(fault.at_s) + 3, y + 8, fault.kind, {kind: "soft small halo"}) : "") + `<title>${escape(title)}</title></g>`;
  }).join("");
}

function episodeMark(x, y, height, [node, from, until, fate], phases) {
  const title = `${nameOf(node)}: ${FATE_WORDS[fate]}, ${number(from, 2)} to ${number(until, 2)} s`;
  if (!phases) return rect(x(from), y, Math.max(1.4, x(until) - x(from)), Math.max(0.8, height - (height > 4 ? 1 : 0)), FATE_COLOUR[fate], title);
  const parts = [];
  phases.forEach(([start, phase], i) => {
    if (!PHASE_COLOUR[phase] || start < from - 1e-6 || start >= until) return;
    const end = i + 1 < phases.length ? Math.min(until, phases[i + 1][0]) : until;
    parts.push(rect(x(start), y + 4, Math.max(0.8, x(end) - x(start)), height - 8, PHASE_COLOUR[phase], `${nameOf(node)}: ${phase}, ${number(1000 * (end - start))} ms at ${number(start, 2)} s`));
  });
  const [cx, cy, colour] = [x(until), y + height / 2, FATE_COLOUR[fate]];
  const mark = fate === "lost" || fate === "failed" ? `<path d="M${fixed(cx - 4)} ${fixed(cy - 4)}l8 8m0 -8l-8 8" stroke="var(--${colour})" stroke-width="2.6" fill="none"/>`
    : fate === "view" || fate === "under way" ? "" : `<circle cx="${fixed(cx)}" cy="${fixed(cy)}" r="4.5" fill="var(--${fate === "withheld" ? "card" : colour})" stroke="var(--${fate === "withheld" ? colour : "card"})" stroke-width="2"/>`;
  return parts.join("") + `<g>${mark}<title>${escape(title)}</title></g>`;
}

/* Committed messages that are no maps. */
function messageMark(x, y, height, [at, node, kind]) {
  return `<path d="M${fixed(x(at))} ${fixed(y + height / 2 - 5)}l5 5l-5 5l-5 -5z" fill="var(--ink)" stroke="var(--card)"><title>${escape(`${nameOf(node)}: ${kind} at ${number(at, 2)} s`)}</title></path>`;
}

function showTimeline() {
  const woken = new Set([...DATA.episodes.rows.map(([node]) => node), ...DATA.messages.rows.map(([, node]) => node), ...summary.faults.map((fault) => fault.node)]);
  const lanes = nodes.filter((node) => isCamera(node) || woken.has(node.id)), many = lanes.length > 24;
  if (many) lanes.sort((a, b) => a.hops - b.hops);
  const laneOf = new Map(lanes.map((node, i) => [node.id, i])), laneHeight = many ? Math.max(0.4, Math.min(12, 480 / lanes.length)) : 24;
  const phasesOf = new Map();
  if (!many) DATA.phases.forEach(([at, node, phase]) => phasesOf.set(node, [...(phasesOf.get(node) ?? []), [at, phase]]));
  const hasEvents = DATA.events.length > 0;
  function draw(width) {
    const left = width < 560 ? 84 : 128, right = width - 12, x = (t) => left + (right - left) * Math.min(t, END) / END;
    let y = 6;
    const parts = [];
    if (hasEvents) {
      const events = eventRows(x, right), rows = 1 + Math.max(0, ...events.map((one) => one.row));
      parts.push(drawEvents(events, y, rows));
      y += EVENT_ROW_HEIGHT * rows + 13;
    }
    parts.push(binRow(x, y, 30, left, "frames", [["looks", "look", "frames watched"]])); y += 42;
    parts.push(binRow(x, y, 30, left, "woken", [["woken", "listen", "frames woke a pair"]])); y += 42;
    parts.push(binRow(x, y, 64, left, "outcome", FATES.map(([key, colour, words]) => [key, colour, words]))); y += 82;
    const top = y, height = top + lanes.length * laneHeight + 42;
    const grid = ticks(0, END, Math.max(3, Math.floor((right - left) / 80))).map((t) => line(x(t), 0, x(t), height - 36) + text(x(t), height - 22, tickText(t), {anchor: "middle", kind: "soft"})).join("");
    if (!many) {
      const fit = Math.floor((left - 6) / 6.4);
      lanes.forEach((node, i) => parts.push(line(left, top + (i + 0.5) * laneHeight, right, top + (i + 0.5) * laneHeight),
        text(0, top + (i + 0.5) * laneHeight + 4, node.name.length > fit ? node.name.slice(0, fit - 1) + "…" : node.name, {title: node.name})));
    } else {
      ["a line for each", `of ${number(lanes.length)} nodes,`, "few hops first"].forEach((words, i) => parts.push(text(0, top + 12 + 15 * i, words, {kind: "soft small"})));
      parts.push(line(left, top, left, top + lanes.length * laneHeight));
    }
    parts.push(faultMarks(x, laneOf, top, laneHeight, lanes.length));
    const lane = (node) => top + laneOf.get(node) * laneHeight;
    for (const episode of DATA.episodes.rows) if (laneOf.has(episode[0])) parts.push(episodeMark(x, lane(episode[0]), laneHeight, episode, phasesOf.get(episode[0])));
    for (const message of DATA.messages.rows) if (laneOf.has(message[1])) parts.push(messageMark(x, lane(message[1]), laneHeight, message));
    parts.push(text((left + right) / 2, height - 4, "virtual time, s", {anchor: "middle", kind: "soft"}));
    return {height, body: grid + parts.join("")};
  }
  const kinds = [...new Set(DATA.messages.rows.map(([, , kind]) => kind))], phased = phasesOf.size > 0, seen = new Set(DATA.episodes.rows.map((row) => row[3]));
  const fates = Object.keys(FATE_WORDS).filter((fate) => seen.has(fate) && !(phased && (fate === "view" || fate === "under way")));
  const entries = [...(phased ? [["storage", "capturing"], ["listen", "waking, receiving a view"], ["compute", "computing"], ["send", "sending"]] : []),
    ...fates.map((fate) => [FATE_COLOUR[fate], FATE_WORDS[fate]]), ...(kinds.length > 0 ? [["ink", `diamonds: ${kinds.join(", ")}`]] : []),
    ...(summary.faults.length > 0 ? [["lost", "dashed: faults"]] : [])];
  const {bin_s: width, looks, woken: wakes} = DATA.timeline;
  chart("timeline", {
    label: "What the cameras did over time: frames watched, pairs woken, what became of it, and a lane for each camera",
    draw,
    below: legend(entries) +
      `<p class="soft note">A column is ${width} s. ${thinnedNote(DATA.episodes, "wakes")}</p>`,
    table: () => [["from, s", "to, s", "frames watched", "woken", ...FATES.map(([fate]) => fate)], looks.map((_, i) => [i * width, (i + 1) * width, looks[i], wakes[i], ...FATES.map(([fate]) => DATA.timeline[fate][i])])],
  });
  if (hasEvents) addTable($("timeline"), "what the scene tells, as a table", () => [["at, s", "what"], DATA.events]);
}
