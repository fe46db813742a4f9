/* What travelled, how long it took, and how right it is. */
const KINDS = [["map", "listen"], ["view", "camera"], ["wake", "storage"], ["status", "compute"], ["other", "failed"], ["acknowledgement", "board"]];

function showBytes() {
  const {traffic} = totals;
  if (traffic.length === 0) { nothing("bytes", "Nothing was on air."); return; }
  /* A kind that is new gets the last colour. */
  const kinds = [...KINDS, ...[...new Set(traffic.map((one) => one.kind))].filter((kind) => !KINDS.some(([name]) => name === kind)).map((kind) => [kind, "failed"])]
    .filter(([kind]) => traffic.some((one) => one.kind === kind));
  const hops = Array.from({length: Math.max(...traffic.map((one) => one.hops)) + 1}, (_, i) => i).filter((hop) => traffic.some((one) => one.hops === hop));
  const of = (kind, hop) => traffic.find((one) => one.kind === kind && one.hops === hop) ?? {bytes: 0, frames: 0};
  const most = Math.max(...hops.map((hop) => sum(kinds.map(([kind]) => of(kind, hop).bytes))));
  chart("bytes", {
    label: "Bytes on air by kind of message at each hop",
    draw(width) {
      const height = 210, p = plot(width, height, {x: [0, hops.length], y: [0, most / 1000]}), parts = [p.axisY("kB"), p.axisX("hops from the gateway", [])];
      const bar = Math.min(60, 0.7 * (p.x1 - p.x0) / hops.length), every = Math.ceil(hops.length / ((p.x1 - p.x0) / 26));
      hops.forEach((hop, i) => {
        let below = 0;
        const x = p.x(i + 0.5) - bar / 2;
        for (const [kind, colour] of kinds) {
          const {bytes: value, frames} = of(kind, hop), y = p.y((below + value) / 1000);
          if (value > 0) parts.push(rect(x, y, bar, p.y(below / 1000) - y, colour, `${kind}, hop ${hop}: ${number(value)} B in ${count(frames, "frame")}`));
          below += value;
        }
        if (i % every === 0) parts.push(text(p.x(i + 0.5), p.y0 + 17, hop, {anchor: "middle", kind: "soft"}));
      });
      return {height, body: parts.join("")};
    },
    below: legend(kinds.map(([kind, colour]) => [colour, kind])),
    table: () => [["kind", "hop", "frames", "bytes"], traffic.map((one) => [one.kind, one.hops, one.frames, one.bytes])],
  });
}

/* cause, colour, words: tsr/hal/air/loss.h has the causes. */
const CAUSES = [["collision", "lost", "collision"], ["receiver_busy", "storage", "receiver busy with another frame"], ["half_duplex", "compute", "receiver sending (half duplex)"],
  ["noise", "listen", "noise: too weak"], ["not_listening", "board", "receiver asleep or off"], ["link_fault", "failed", "link fault"]];

function showLosses() {
  const by = totals.air_lost_by, causes = CAUSES.filter(([cause]) => by[cause] > 0);
  $("losses-note").textContent = totals.air_lost === 0 ? "" : `— ${number(totals.air_lost)} of ${number(totals.air_frames)}, acknowledgements included`;
  if (causes.length === 0) { nothing("losses", "No frame was lost."); return; }
  const most = Math.max(...causes.map(([cause]) => by[cause]));
  chart("losses", {
    label: "Frames lost on the radio by cause",
    draw(width) {
      const bar = 22, height = causes.length * bar + 50, p = plot(width, height, {x: [0, most * 1.02], y: [causes.length, 0], left: width < 560 ? 150 : 230, top: 4});
      const parts = causes.map(([cause, colour, words], i) => text(0, p.y(i) + 15, width < 560 ? cause.replace("_", " ") : words, {title: words}) +
        rect(p.x0, p.y(i) + 3, p.x(by[cause]) - p.x0, bar - 6, colour, `${words}: ${count(by[cause], "frame")}`));
      return {height, body: p.axisX("frames", ticks(0, most, 5).filter(Number.isInteger)) + parts.join("")};
    },
    table: () => [["from", "to", "frames", "received", ...causes.map(([cause]) => cause.replace("_", " "))],
      links.filter((link) => link.frames > link.received).map((link) => [nameOf(link.from), nameOf(link.to), link.frames, link.received, ...causes.map(([cause]) => link[`lost_by_${cause}`])])],
    tableTitle: "links that lost data frames, each direction, as a table",
  });
}

function showMapBytes() {
  if (maps.length === 0) { nothing("map-bytes", "No map was delivered."); return; }
  const series = [{name: "map", colour: "listen", values: maps.map((map) => map.map_bytes)},
    {name: "its reference image", colour: "send", values: maps.map((map) => map.reference_bytes).filter((value) => value > 0)}].filter((one) => one.values.length > 0);
  histogram("map-bytes", {series, quantity: "coded length", unit: "bytes", what: "maps", label: "Coded length of maps and their reference images"});
}

function showLatency() {
  const values = maps.filter((map) => map.latency_s !== null), {latency_s: all} = totals;
  if (values.length === 0) { nothing("latency", "No map was delivered."); return; }
  histogram("latency", {series: [{name: "maps", colour: "listen", values: values.map((map) => map.latency_s)}], quantity: "latency", unit: "s", what: "maps", label: "Latency of maps from capture to commit",
    marks: [[all.median, `median ${time(all.median)}`], [all.p95, `95 % ${time(all.p95)}`]]});
  const rank = (sorted, part) => sorted[Math.ceil(sorted.length * part) - 1];
  const groups = [...new Set(values.map((map) => nodeById.get(map.node)?.hops))].filter((hop) => hop !== undefined).sort((a, b) => a - b).map((hop) => {
    const own = values.filter((map) => nodeById.get(map.node)?.hops === hop).map((map) => map.latency_s).sort((a, b) => a - b);
    return {hop, size: own.length, low: own[0], median: rank(own, 0.5), p95: rank(own, 0.95)};
  });
  const most = Math.max(...groups.map((group) => group.p95));
  chart("latency-hops", {
    label: "Latency by the number of hops: shortest, median and 95 %",
    draw(width) {
      const height = 210, p = plot(width, height, {x: [0, groups.length], y: [0, most * 1.05]}), parts = [p.axisY("latency, s"), p.axisX("hops to the gateway", [])];
      groups.forEach((group, i) => {
        const x = p.x(i + 0.5), title = `${count(group.hop, "hop")}, ${count(group.size, "map")}: shortest ${time(group.low)}, median ${time(group.median)}, 95 % within ${time(group.p95)}`;
        parts.push(`<g><line x1="${fixed(x)}" x2="${fixed(x)}" y1="${fixed(p.y(group.low))}" y2="${fixed(p.y(group.p95))}" stroke="var(--listen)" stroke-width="7" stroke-opacity=".35" stroke-linecap="round"/>` +
          `<circle cx="${fixed(x)}" cy="${fixed(p.y(group.median))}" r="5" fill="var(--listen)"/><title>${escape(title)}</title></g>`, text(x, p.y0 + 17, group.hop, {anchor: "middle", kind: "soft"}));
      });
      return {height, body: parts.join("")};
    },
    table: () => [["hops", "maps", "shortest, s", "median, s", "95 %, s"], groups.map((group) => [group.hop, group.size, group.low, group.median, group.p95])],
  });
}

/* Zones over a picture of the left view. */
function zoneFrames(size, zones) {
  if (zones.length === 0) return "";
  const [width, height] = size;
  return `<svg viewBox="0 0 ${width} ${height}" preserveAspectRatio="none">` + zones.map(([name, x, y, wide, high]) =>
    `<g><rect x="${x}" y="${y}" width="${wide}" height="${high}"/><rect class="dash" x="${x}" y="${y}" width="${wide}" height="${high}"/><title>${escape(`zone ${name}`)}</title></g>`).join("") + "</svg>";
}

function galleryFigure({pair, why, numbers, size, zones, ...pictures}) {
  const views = [["left", "left view"], ["right", "right view"], ["reference", "reference image"], ["map", "map"], ["truth", "truth"], ["error", "error"]].filter(([key]) => pictures[key]);
  const {error} = numbers, judged = error ? `median error <b>${error.median_px === null ? "–" : `${number(error.median_px, 2)} px`}</b>, ${error.median_mm === null ? "–" : short(error.median_mm)} mm; <b>${percent(error.correct)}</b> right; ` : "";
  return `<figure><div class="views">${views.map(([key, words]) => `<div><div class="framed"><img src="${pictures[key]}" alt="${words} of ${escape(pair)}">${key === "right" ? "" : zoneFrames(size, zones)}</div>${words}</div>`).join("")}</div>` +
    `<figcaption><b>${escape(pair)}</b> at ${number(numbers.capture_time_s, 1)} s${why ? `, the <b>${why}</b>` : ""}: ${judged}` +
    `${number(numbers.map_bytes)} + ${number(numbers.reference_bytes)} bytes${numbers.kept ? "" : "; dropped by the sink"}</figcaption></figure>`;
}

function showGallery() {
  const {gallery} = DATA;
  const chosen = gallery.some((one) => one.why.startsWith("best")) ? "best, median and worst by the pixels right within 1 px, the newest, and others over time" : "the newest, and others over time";
  $("gallery-note").textContent = totals.maps_received === 0 ? "— no map was delivered" : gallery.length === totals.maps_received ? `— all ${count(gallery.length, "map")}`
    : `— ${gallery.length} of ${count(totals.maps_received, "map")}: ${chosen}`;
  $("gallery").innerHTML = gallery.map(galleryFigure).join("");
  if (gallery.length < DATA.gallery_of) $("gallery").insertAdjacentHTML("beforeend", `<p class="soft">${DATA.gallery_of - gallery.length} more are in maps/ beside this page.</p>`);
  if (gallery.some((one) => one.error)) {
    $("gallery-legend").innerHTML = `<div class="legend"><span>map and truth: <i class="ramp"></i>far to near, black: nothing</span><span>error: <i class="ramp"></i>0 to 2 px, gray: no match, black: no truth</span>` +
      (gallery.some((one) => one.zones.length > 0) ? "<span>frames: zones</span>" : "") + "</div>";
  }
  const judged = maps.filter((map) => map.error_median_px !== null);
  if (judged.length > 0) {
    histogram("error", {series: [{name: "maps", colour: "listen", values: judged.map((map) => map.error_median_px)}], quantity: "median error of a map", unit: "px", what: "maps", label: "Median error of maps against truth",
      marks: [[totals.error_median_px.median, `median ${number(totals.error_median_px.median, 2)} px`]]});
  }
  if (maps.length > 0) {
    addTable($("error"), `${count(maps.length, "map")} as a table`, () => [["pair", "capture, s", "latency, s", "bytes", "reference bytes", "kept", "matched pixels", "right", "median, px", "mean, px", "median, mm"],
      maps.map((map) => [nodeById.get(map.node)?.pair ?? nameOf(map.node), map.capture_time_s, map.latency_s, map.map_bytes, map.reference_bytes, map.kept ? "yes" : "no", map.error_matched_pixels, map.error_correct, map.error_median_px, map.error_mean_px, map.error_median_mm])]);
  }
}
