/* What the run says of itself: heading, what is missing, tiles, the table of nodes. */
const summary = DATA.summary, totals = summary.totals;
const nodes = records(DATA.nodes), links = records(DATA.links), maps = records(DATA.maps);
const nodeById = new Map(nodes.map((node) => [node.id, node]));
const nameOf = (id) => id === 0 ? "sink" : nodeById.has(id) ? nodeById.get(id).name : `node ${id}`;
const isCamera = (node) => node.role === "lead" || node.role === "binocular";
const days = (value) => value === null ? "no end" : `${number(value, value < 10 ? 1 : 0)} days`;
const bytes = (value) => value >= 1e6 ? `${short(value / 1e6)} MB` : value >= 1e3 ? `${short(value / 1e3)} kB` : `${value} B`;
const time = (s) => s >= 1 ? `${short(s)} s` : `${number(1000 * s)} ms`;
const percent = (part) => `${number(100 * part, 1)} %`;

function showHead() {
  $("title").textContent = summary.site;
  document.title = `Tarsier: ${summary.site}`;
  const {scenario, set, baseline: views} = summary.settings;
  $("subtitle").textContent = `seed ${summary.seed}`;
  $("settings").textContent = [scenario ?? "a site", `seed ${summary.seed}`, ...set.map((one) => `--set ${one}`), ...(views ? [`--baseline ${views}`] : [])].join(" · ");
  const notices = [], {baseline} = summary;
  if (baseline) notices.push(`A baseline: nodes send both views as JPEG of quality ${baseline.jpeg_quality}, ${baseline.views === "stream" ? "once a minute" : "of each change"}. Where this page says map, read the two pictures.`);
  const planned = summary.virtual_time_s < DATA.played_s ? ` of ${number(DATA.played_s, 1)} s` : ", before all that was under way had ended";
  if (summary.stopped) notices.push(`A part of a run: stopped by a signal after ${number(summary.virtual_time_s, 1)} s${planned}. The results are those of the time until then.`);
  else if (!summary.settled) notices.push("Something was still under way when the run ended.");
  const restarts = DATA.faults_by_kind["sink restart"] ?? 0;
  if (summary.sink_restarts > restarts) notices.push(`The sink was started again ${count(summary.sink_restarts, "time")}.`);
  if (summary.faults.length > 0) notices.push(faultsInWords());
  const stuck = summary.zones.filter((zone) => zone.always_begun);
  if (stuck.length > 0) notices.push(zonesInWords(stuck));
  $("notice").textContent = notices.join(" ");
  $("notice").hidden = notices.length === 0;
}

function showTiles() {
  const {latency_s: latency, error_median_px: errorPx, error_median_mm: errorMm} = totals;
  const deepest = Math.max(...nodes.map((node) => node.hops));
  const pairs = nodes.filter(isCamera).length * DATA.nodes.of / nodes.length;
  const perMap = totals.maps_received > 0 ? `; ${bytes(Math.round(totals.air_bytes / totals.maps_received))} for each map delivered` : "";
  const unended = totals.shortest_life_days === null;
  const tiles = [
    [number(DATA.nodes.of), `${DATA.nodes.of === 1 ? "node" : "nodes"}, ${count(Math.round(pairs), "pair")}, up to ${count(deepest, "hop")} to the gateway`],
    [`${number(summary.virtual_time_s, 1)} s`, `of virtual time in ${number(summary.wall_time_s, 1)} s, ${short(summary.virtual_time_s / Math.max(summary.wall_time_s, 1e-3))} × real time`],
    [`${number(totals.maps_received)} <small>/ ${number(totals.maps_lost)} given up</small>`,
      `changes delivered; ${number(totals.frames_woken)} of ${number(totals.frames_watched)} frames woke, ${number(totals.maps_withheld)} maps were like the last` +
      (totals.maps_measured > 0 ? `, ${number(totals.maps_measured)} were for zones alone` : "") +
      (totals.captures_failed > 0 ? `, ${count(totals.captures_failed, "capture")} failed` : "")],
    [latency.count > 0 ? time(latency.median) : "–", latency.count > 0 ? `median latency from capture to commit; 95 % within ${time(latency.p95)}` : "latency: nothing was delivered"],
    [bytes(totals.air_bytes), `on air in ${count(totals.air_frames, "frame")}${perMap}`],
    [errorPx.count > 0 ? `${number(errorPx.median, 2)} px` : "–", errorPx.count > 0 ?
      `median error of ${count(errorPx.count, "map")}, ${errorMm.count > 0 ? short(errorMm.median) : "–"} mm; ${number(100 * totals.correct_median)} % of the pixels right within 1 px` : "error: no map was compared with ground truth"],
    [`${short(totals.energy_mj / 1000)} J`, `by all nodes, ${short(sum(nodes.map((node) => node.battery_mean_power_uw)) / nodes.length / 1000)} mW each on average while on` +
      (totals.active_mj_per_map > 0 ? `; ${short(totals.active_mj_per_map)} mJ of work and frames for each map delivered` : "")],
    [unended ? "no end" : `${number(totals.shortest_life_days, totals.shortest_life_days < 10 ? 1 : 0)} <small>days</small>`,
      `of battery, the shortest: ${escape(nameOf(totals.shortest_life_node))}; median ${days(totals.median_life_days)}`],
  ];
  $("tiles").innerHTML = tiles.map(([value, words]) => `<div class="tile"><b>${value}</b><span>${words}</span></div>`).join("");
}

function showNodes() {
  const shown = [["id", "id"], ["name", "node"], ["role", "role"], ["parent", "parent"], ["hops", "hops"], ["frames_watched", "frames watched"], ["frames_woken", "woken"],
    ["maps_made", "maps made"], ["maps_withheld", "withheld"], ["maps_received", "delivered"], ["maps_lost", "lost"], ["air_frames", "frames on air"], ["air_bytes", "bytes on air"],
    ["mac_retries", "retries"], ["forwarded", "forwarded"], ["battery_mean_power_uw", "mean power, uW"], ["battery_life_days", "life, days"], ["memory_bytes", "arena, bytes"]];
  const note = thinnedNote(DATA.nodes, "nodes");
  $("nodes").innerHTML = `<p class="soft note">${note} nodes.csv beside this page has ${DATA.nodes.columns.length} columns for each.</p>`;
  addTable($("nodes"), `${count(nodes.length, "node")} as a table`, () => [shown.map(([, title]) => title), nodes.map((node) => shown.map(([key]) => key === "parent" ? nameOf(node.parent) : node[key]))]);
}
