/* The plan: nodes where they stand, what their cameras see, the tree coloured by the quality of its links. */
const QUALITY = [[0.99, "link-5", "99 % and more"], [0.95, "link-4", "95 to 99 %"], [0.8, "link-3", "80 to 95 %"], [0.5, "link-2", "50 to 80 %"], [-1, "link-1", "less than half"]];
const PLAN_CELL_PX = 2, PLAN_LEVELS = 24;
const qualityOf = (success) => QUALITY.find(([least]) => success >= least);

/* A node and its parent: both directions of their link together. */
function treeLinks() {
  const used = new Map(links.map((link) => [`${link.from}>${link.to}`, link]));
  return nodes.filter((node) => nodeById.has(node.parent)).map((node) => {
    const [up, down] = [used.get(`${node.id}>${node.parent}`), used.get(`${node.parent}>${node.id}`)];
    const both = [up, down].filter(Boolean), frames = sum(both.map((link) => link.frames));
    return {node, parent: nodeById.get(node.parent), up, down, frames, bytes: sum(both.map((link) => link.bytes)), success: frames > 0 ? sum(both.map((link) => link.received)) / frames : null};
  });
}

function linkTitle({node, parent, up, down}) {
  const tell = (link, from, to) => link ? `${from.name} to ${to.name}: ${number(link.frames)} frames, ${percent(link.success ?? 0)} received, ${number(link.acknowledged)} acknowledged, ` +
    `${number(link.bytes)} B` : `${from.name} to ${to.name}: nothing`;
  const level = up ?? down;
  return `${tell(up, node, parent)}\n${tell(down, parent, node)}` + (level ? `\n${level.rssi_dbm} dBm, SNR ${level.snr_db} dB` : "");
}

function nodeTitle(node) {
  const lines = [`${node.name} (${node.role}, id ${node.id}), ${count(node.hops, "hop")}`, `at ${node.place_x_m}, ${node.place_y_m}, ${node.place_z_m} m`];
  if (isCamera(node)) lines.push(`${number(node.frames_watched)} frames watched, ${number(node.frames_woken)} woken, ${number(node.maps_received)} maps delivered, ${number(node.maps_lost)} lost`);
  lines.push(`${number(node.air_bytes)} B on air, ${short(node.battery_mean_power_uw / 1000)} mW, ${days(node.battery_life_days)}`);
  return lines.join("\n");
}

/* A label beside its node where no other label, no node and no edge is. */
function placeLabels(points, size, width) {
  const taken = points.map(([x, y]) => [x - size, y - size, x + size, y + size]);
  return points.map(([x, y, name]) => {
    const long = name.length * 6.6, gap = size + 4;
    const places = [[x + gap, y + 4, "start"], [x - gap, y + 4, "end"], [x, y - gap, "middle"], [x, y + gap + 9, "middle"],
      [x + gap, y - gap, "start"], [x + gap, y + gap + 9, "start"], [x - gap, y - gap, "end"], [x - gap, y + gap + 9, "end"]];
    for (const [lx, ly, anchor] of places) {
      const from = anchor === "start" ? lx : anchor === "end" ? lx - long : lx - long / 2;
      const box = [from, ly - 11, from + long, ly + 2];
      if (box[0] > 0 && box[2] < width && !taken.some((other) => box[0] < other[2] && box[2] > other[0] && box[1] < other[3] && box[3] > other[1])) {
        taken.push(box);
        return text(lx, ly, name, {anchor, kind: "halo small"});
      }
    }
    return "";
  });
}

/*
 * The cloud from above, as a picture of width x height: the more heights there are points at, the darker, so walls and
 * furniture stand out from floors. place: [x, y, z] of the place to px.
 */
function cloudFromAbove(positions, place, width, height) {
  const [columns, rows] = [Math.ceil(width / PLAN_CELL_PX), Math.ceil(height / PLAN_CELL_PX)], inside = [];
  for (let i = 0; i < positions.length; i += 3) {
    const [x, y] = place(positions[i], positions[i + 1]).map((px) => Math.floor(px / PLAN_CELL_PX));
    if (x >= 0 && x < columns && y >= 0 && y < rows) inside.push([y * columns + x, positions[i + 2]]);
  }
  if (inside.length === 0) return "";
  const heights = Float32Array.from(inside, ([, z]) => z).sort();
  const [low, high] = [0.02, 0.98].map((part) => heights[Math.floor(part * (heights.length - 1))]);
  const levels = new Uint32Array(columns * rows), filled = new Uint8Array(columns * rows);
  for (const [cell, z] of inside) {
    const level = Math.floor(PLAN_LEVELS * (z - low) / (high - low || 1));
    if (level >= 0 && level < PLAN_LEVELS && !(levels[cell] >> level & 1)) { levels[cell] |= 1 << level; filled[cell]++; }
  }
  const most = filled.filter((n) => n > 0).sort(), dark = most[Math.floor(0.98 * (most.length - 1))] ?? 1;
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
  [canvas.width, canvas.height] = [columns, rows];
  const image = context.createImageData(columns, rows), ink = matchMedia("(prefers-color-scheme: dark)").matches ? 255 : 0;
  filled.forEach((n, cell) => image.data.set([ink, ink, ink, n === 0 ? 0 : Math.min(150, 10 + 140 * n / dark)], 4 * cell));
  context.putImageData(image, 0, 0);
  return `<image href="${canvas.toDataURL()}" x="0" y="0" width="${columns * PLAN_CELL_PX}" height="${rows * PLAN_CELL_PX}"><title>what the maps show, from above</title></image>`;
}

function showPlan() {
  /* A place that is longer than wide is turned by a right angle: y to the right, x down. */
  const spread = (key) => Math.max(...nodes.map((node) => node[key])) - Math.min(...nodes.map((node) => node[key]));
  const turned = spread("place_y_m") > 1.3 * spread("place_x_m");
  const across = (node) => turned ? node.place_y_m : node.place_x_m, up = (node) => turned ? -node.place_x_m : node.place_y_m;
  const tree = treeLinks(), xs = nodes.map(across), ys = nodes.map(up);
  const positions = cloudPositions(), placeOf = (x, y) => ({place_x_m: x, place_y_m: y});
  const low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)];
  const few = nodes.length <= 30, some = nodes.length <= 200, most = Math.max(1, ...tree.map((link) => link.bytes));
  function draw(width) {
    const [size, reach] = (few ? [6, 54] : some ? [4, 26] : [2.4, 11]).map((px) => px * Math.min(1, 0.4 + width / 1400));
    const pad = reach + 4, left = 56 + pad, right = 14 + pad, top = 10 + pad, bottom = 40 + pad;
    const span = [Math.max(high[0] - low[0], 0.5), Math.max(high[1] - low[1], 0.5)];
    const wide = width - left - right, tall = Math.min(520, Math.max(150, wide * span[1] / span[0]));
    const scale = Math.min(wide / span[0], tall / span[1]), height = Math.max(150, scale * span[1]) + top + bottom;
    /* Both axes to one scale, the nodes in the middle, the axes around them. */
    const middle = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    const half = [(width - 70) / 2 / scale, (height - 50) / 2 / scale];
    const p = plot(width, height, {x: [middle[0] - half[0], middle[0] + half[0]], y: [middle[1] - half[1], middle[1] + half[1]]});
    const at = (node) => [p.x(across(node)), p.y(up(node))];
    const parts = turned ? [p.axisY("x, m", undefined, (value) => tickText(value === 0 ? 0 : -value)), p.axisX("y, m")] : [p.axisY("y, m"), p.axisX("x, m")];
    if (positions.length > 0) parts.unshift(cloudFromAbove(positions, (x, y) => at(placeOf(x, y)), width, height - 40));
    for (const node of nodes.filter((one) => isCamera(one) && one.view_azimuth_deg !== null)) {
      const [x, y] = at(node), turn = Math.PI / 180, length = reach * Math.max(0.35, Math.cos(node.view_elevation_deg * turn));
      const [a, b] = [-1, 1].map((side) => (node.view_azimuth_deg - (turned ? 90 : 0) + side * node.view_fov_deg / 2) * turn);
      parts.push(`<path d="M${fixed(x)} ${fixed(y)}L${fixed(x + length * Math.cos(a))} ${fixed(y - length * Math.sin(a))}A${fixed(length)} ${fixed(length)} 0 0 0 ` +
        `${fixed(x + length * Math.cos(b))} ${fixed(y - length * Math.sin(b))}Z" fill="var(--cone)" fill-opacity=".28"><title>${escape(nodeTitle(node))}</title></path>`);
    }
    for (const link of tree) {
      const colour = link.success === null ? "line" : qualityOf(link.success)[1], [[x1, y1], [x2, y2]] = [at(link.node), at(link.parent)];
      const thick = (few ? 1.6 : some ? 1.2 : 0.8) + (few ? 5 : 3) * link.bytes / most;
      parts.push(`<line x1="${fixed(x1)}" y1="${fixed(y1)}" x2="${fixed(x2)}" y2="${fixed(y2)}" stroke="var(--${colour})" stroke-width="${fixed(thick)}" stroke-linecap="round"` +
        `${link.success !== null && link.success < 0.8 ? ' stroke-dasharray="5 4"' : ""}><title>${escape(linkTitle(link))}</title></line>`);
    }
    for (const node of nodes) {
      const [x, y] = at(node), title = `<title>${escape(nodeTitle(node))}</title>`, look = 'stroke="var(--card)" stroke-width="1.5"';
      parts.push(node.role === "gateway" ? `<rect x="${fixed(x - size - 2)}" y="${fixed(y - size - 2)}" width="${2 * size + 4}" height="${2 * size + 4}" fill="var(--ink)" ${look}>${title}</rect>`
        : node.role === "relay" ? `<path d="M${fixed(x)} ${fixed(y - size - 2)}l${size + 2} ${size + 2}l${-size - 2} ${size + 2}l${-size - 2} ${-size - 2}z" fill="var(--soft)" ${look}>${title}</path>`
          : `<circle cx="${fixed(x)}" cy="${fixed(y)}" r="${node.role === "wing" ? size - 1 : size}" fill="var(--${node.role === "wing" ? "view" : "camera"})" ${look}>${title}</circle>`);
    }
    parts.push(faultsOnPlan(at, size, tree));
    if (few) parts.push(...placeLabels(nodes.map((node) => [...at(node), node.name]), size, width));
    return {height, body: parts.join("")};
  }
  const seen = new Set(tree.filter((link) => link.success !== null).map((link) => qualityOf(link.success)[1]));
  chart("plan", {
    label: `Plan of ${nodes.length} nodes and the tree that joins them`,
    draw,
    below: legend([...QUALITY.filter(([, colour]) => seen.has(colour)).map(([, colour, words]) => [colour, `link: ${words} of the frames received`]),
      ["cone", "what a camera sees (not to scale)"], ["ink", "gateway"], ["camera", "camera"], ...faultLegend()]) + `<p class="soft note">A link is as wide as its bytes.${positions.length > 0 ? " In gray what the maps show, the darker the more of its height." : ""} ${thinnedNote(DATA.nodes, "nodes")}</p>`,
    table: () => [["from", "to", "hops", "frames", "received", "success", "acknowledged", "bytes", "dBm", "SNR, dB"],
      links.map((link) => [nameOf(link.from), nameOf(link.to), link.hops, link.frames, link.received, link.success, link.acknowledged, link.bytes, link.rssi_dbm, link.snr_db])],
    tableTitle: `${count(links.length, "link")} that were used, each direction, as a table`,
  });
}
