/* What zones told: depth over time of those that follow a surface, and the events as a table. */
const ZONE_CHARTS_MAX = 12;
const ZONE_COLUMNS = ["at", "node", "zone", "kind", "depth", "area", "latency", "truth"];
const zoneRecord = (row) => Object.fromEntries(ZONE_COLUMNS.map((name, i) => [name, row[i]]));
const pairName = (id) => nodeById.get(id)?.pair ?? nameOf(id);

/* Reports as a line of steps with a point each, the truth of the same instants behind it. */
function zoneChart(id, name, reports) {
  const depths = reports.flatMap((one) => [one.depth, one.truth]).filter((value) => value !== null);
  const [low, high] = [Math.min(...depths), Math.max(...depths)], margin = Math.max(high - low, 0.2) * 0.1;
  const truths = reports.filter((one) => one.truth !== null);
  chart(id, {
    label: `Reported depth of ${name} over time`,
    draw(width) {
      const height = 190, p = plot(width, height, {x: [0, END], y: [high + margin, low - margin]});
      const path = (points) => `M${points.map(([t, z]) => `${fixed(p.x(t))} ${fixed(p.y(z))}`).join("L")}`;
      const steps = reports.flatMap((one, i) => i > 0 ? [[one.at, reports[i - 1].depth], [one.at, one.depth]] : [[one.at, one.depth]]);
      const parts = [p.axisY("depth, m", ticks(low - margin, high + margin, 4)), p.axisX("virtual time, s")];
      parts.push(`<path d="${path(steps)}" fill="none" stroke="var(--listen)" stroke-width="1.5"/>`);
      if (truths.length > 0) parts.push(`<path d="${path(truths.map((one) => [one.at, one.truth]))}" fill="none" stroke="var(--lost)" stroke-width="1.5" stroke-dasharray="5 3"/>`);
      for (const one of reports) {
        const title = `${number(one.depth, 3)} m at ${number(one.at, 1)} s${one.truth === null ? "" : `, in truth ${number(one.truth, 3)} m`}`;
        parts.push(`<circle cx="${fixed(p.x(one.at))}" cy="${fixed(p.y(one.depth))}" r="${reports.length > 200 ? 1.5 : 3}" fill="var(--listen)"><title>${escape(title)}</title></circle>`);
      }
      return {height, body: parts.join("")};
    },
  });
}

/* Those whose limit lies behind what always stands there. */
function zonesInWords(stuck) {
  const named = stuck.slice(0, 3).map((zone) => `“${zone.zone}” of ${zone.pair}`).join(", ") + (stuck.length > 3 ? ` and ${number(stuck.length - 3)} more` : "");
  return `Begun at the first look and never ended: ${stuck.length === 1 ? "zone" : "zones"} ${named}. What always stands there is beyond the limit.`;
}

function showZoneCharts(reports) {
  const zones = new Map();
  reports.forEach((one) => zones.set(`${one.node} ${one.zone}`, [...(zones.get(`${one.node} ${one.zone}`) ?? []), one]));
  const shown = [...zones.values()].sort(([a], [b]) => a.node - b.node).slice(0, ZONE_CHARTS_MAX);
  const name = ([first]) => `${pairName(first.node)}, ${first.zone}`;
  $("zone-charts").innerHTML = shown.map((own, i) => `<div><h3>${escape(name(own))}</h3><div id="zone-chart-${i}"></div></div>`).join("");
  shown.forEach((own, i) => zoneChart(`zone-chart-${i}`, name(own), own));
  if (shown.length === 0) return "";
  const truth = reports.some((one) => one.truth !== null) ? [["lost", "dashed: the truth at the reports"]] : [];
  return legend([["listen", "reported depth, nearer above"], ...truth]) + (zones.size > shown.length ? `<p class="soft note">${number(shown.length)} of ${number(zones.size)} zones are drawn.</p>` : "");
}

function showEvents() {
  const {of, rows, newest} = DATA.zone_events;
  $("events-section").hidden = of === 0;
  if (of === 0) return;
  const below = showZoneCharts(rows.map(zoneRecord).filter((one) => one.kind === "measured" && one.depth !== null));
  $("events-note").textContent = `— ${number(of)} that the sink has`;
  const thin = [rows.length < of && `${number(rows.length)} of ${number(of)} events are drawn`, newest.length < of && `the table has the newest ${number(newest.length)}`].filter(Boolean);
  const told = newest.map(zoneRecord).reverse().map((one) => [number(one.at, 1), pairName(one.node), one.zone, one.kind, one.depth, one.truth, one.area, one.latency]);
  $("events").innerHTML = below + (thin.length > 0 ? `<p class="soft note">${thin.join("; ")}; all are in events.csv and summary.json.</p>` : "") +
    tableHtml(["at, s", "pair", "zone", "kind", "depth, m", "in truth, m", "area, %", "latency, s"], told);
}
