const FOCAL = 1.0925; /* of the height of the canvas */
const DENSE_CELLS = 40, DENSE_PART = 0.6;
const SAMPLE_POINTS = 20000, CANDIDATE_POINTS = 3000;
const SWAY = 0.2; /* to both sides of the first view */
const CANDIDATE_YAWS = 16, CANDIDATE_PITCHES = [0.25, 0.45, 0.7, 0.95];

const bytesOf = (content) => Uint8Array.from(atob(content), (c) => c.charCodeAt(0));

/* x, y, z of each point, m. */
function cloudPositions() {
  const {low, step} = DATA.cloud, grid = new Uint16Array(bytesOf(DATA.cloud.positions).buffer);
  return Float32Array.from(grid, (value, i) => low[i % 3] + step[i % 3] * value);
}

/* The middle and the spread of each axis, without the part trim at each end. points: [[x, y, z], ...]. */
function boxOf(points, trim) {
  return [0, 1, 2].map((axis) => {
    const values = Float32Array.from(points, (point) => point[axis]).sort();
    const [low, high] = [values[Math.floor(values.length * trim)], values[Math.ceil(values.length * (1 - trim)) - 1]];
    return {centre: (low + high) / 2, spread: high - low};
  });
}

/*
 * What the cameras watch, for points thin out with the distance: those in the cells that have most, DENSE_PART of all.
 */
function denseOnes(points) {
  const box = boxOf(points, 0.02), cell = Math.max(...box.map((axis) => axis.spread), 1e-6) / DENSE_CELLS;
  const counts = new Map(), keys = points.map((point) => point.map((value) => Math.floor(value / cell)).join());
  keys.forEach((key) => counts.set(key, (counts.get(key) ?? 0) + 1));
  const least = keys.map((key) => counts.get(key)).sort((a, b) => b - a)[Math.floor(DENSE_PART * (points.length - 1))];
  return points.filter((_, i) => counts.get(keys[i]) >= least);
}

/* Along the view, to the right and upwards, of a point around the middle; yaw 0 looks along y, pitch > 0 from above. */
const turned = ([x, y, z], [sy, cy, sp, cp]) => {
  const right = cy * x - sy * y, ahead = sy * x + cy * y;
  return [cp * ahead - sp * z, right, sp * ahead + cp * z];
};
const turnOf = (yaw, pitch) => [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];

/*
 * Of views from all sides and several heights, each as near as it can be with nearly all points on the canvas, the one
 * in which the points that no other hides cover most of it. points: [[x, y, z], ...] around the middle, in sizes.
 */
function firstView(points, aspect) {
  const columns = 64, rows = Math.round(columns / aspect);
  let best = {yaw: 0.28, pitch: 0.14, distance: 1, score: -1};
  for (const pitch of CANDIDATE_PITCHES) {
    for (let step = 0; step < CANDIDATE_YAWS; step++) {
      const yaw = 2 * Math.PI * step / CANDIDATE_YAWS, turn = turnOf(yaw, pitch), seen = points.map((point) => turned(point, turn));
      const needed = seen.map(([ahead, right, up]) => FOCAL * 2 * Math.max(Math.abs(right) / aspect, Math.abs(up)) - ahead).sort((a, b) => a - b);
      const distance = Math.max(0.3, needed[Math.floor(0.96 * (needed.length - 1))]);
      const nearest = new Float32Array(columns * rows).fill(Infinity), cellOf = ([ahead, right, up]) => {
        const scale = FOCAL * rows / (ahead + distance), [u, v] = [Math.floor(columns / 2 + scale * right), Math.floor(rows / 2 - scale * up)];
        return ahead + distance > 0.05 && u >= 0 && u < columns && v >= 0 && v < rows ? v * columns + u : -1;
      };
      const cells = seen.map(cellOf);
      cells.forEach((cell, i) => { if (cell >= 0 && seen[i][0] < nearest[cell]) nearest[cell] = seen[i][0]; });
      const shown = cells.filter((cell, i) => cell >= 0 && seen[i][0] < nearest[cell] + 0.06).length / cells.length;
      const score = shown * nearest.filter((value) => value < Infinity).length;
      if (score > best.score) best = {yaw, pitch, distance, score};
    }
  }
  return {...best, distance: 1.08 * best.distance};
}

/*
 * The cloud, drawn point by point with a depth buffer: no library, no GPU.
 *
 * first: {yaw, pitch, distance} of the first view, the distance in sizes of the cloud; without, firstView() chooses.
 * from: first point shown; splatAtOne: side of a point, px, seen from the distance of that size.
 */
function showCloud(canvas, {first, from = 0, splatAtOne, still = false}) {
  const all = DATA.cloud.count, positions = cloudPositions(), colours = bytesOf(DATA.cloud.colours);
  const context = canvas.getContext("2d"), width = canvas.width, height = canvas.height;
  if (all === 0) { context.fillStyle = "#999"; context.font = "24px sans-serif"; context.fillText("no points", 30, 50); return; }
  const every = Math.max(1, Math.floor((all - from) / SAMPLE_POINTS)), sample = [];
  for (let i = from; i < all; i += every) sample.push([0, 1, 2].map((axis) => positions[3 * i + axis]));
  const dense = first ? sample : denseOnes(sample), middle = boxOf(dense, 0.02);
  const size = Math.max(...middle.map((axis) => axis.spread), 1e-6);
  const thin = Math.ceil(dense.length / CANDIDATE_POINTS), around = (point) => point.map((value, axis) => (value - middle[axis].centre) / size);
  const view = first ?? firstView(dense.filter((_, i) => i % thin === 0).map(around), width / height);
  let {yaw, pitch, distance} = view, turning = true, dragged = null;
  const image = context.createImageData(width, height), pixels = new Uint32Array(image.data.buffer), depth = new Float32Array(width * height);

  function draw() {
    pixels.fill(0xff13100e);
    depth.fill(Infinity);
    const [sy, cy, sp, cp] = turnOf(yaw, pitch), focal = FOCAL * height;
    for (let i = from; i < all; i++) {
      const px = (positions[3 * i] - middle[0].centre) / size, py = (positions[3 * i + 1] - middle[1].centre) / size, pz = (positions[3 * i + 2] - middle[2].centre) / size;
      const rx = cy * px - sy * py, ry = sy * px + cy * py;
      const forward = cp * ry - sp * pz + distance, up = sp * ry + cp * pz;
      if (forward < 0.05) continue;
      const splat = Math.min(9, Math.max(2, Math.round(splatAtOne / forward)));
      const u = Math.round(width / 2 + focal * rx / forward), v = Math.round(height / 2 - focal * up / forward);
      const colour = 0xff000000 | colours[3 * i + 2] << 16 | colours[3 * i + 1] << 8 | colours[3 * i];
      for (let y = Math.max(0, v); y < Math.min(height, v + splat); y++) {
        for (let x = Math.max(0, u); x < Math.min(width, u + splat); x++) {
          const at = y * width + x;
          if (forward < depth[at]) { depth[at] = forward; pixels[at] = colour; }
        }
      }
    }
    context.putImageData(image, 0, 0);
  }
  canvas.addEventListener("pointerdown", (event) => { dragged = [event.clientX, event.clientY]; turning = false; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointerup", () => { dragged = null; });
  canvas.addEventListener("pointermove", (event) => {
    if (!dragged) return;
    yaw -= (event.clientX - dragged[0]) / 200;
    pitch = Math.min(1.5, Math.max(-1.5, pitch + (event.clientY - dragged[1]) / 200));
    dragged = [event.clientX, event.clientY];
    requestAnimationFrame(draw);
  });
  canvas.addEventListener("wheel", (event) => {
    event.preventDefault();
    turning = false;
    distance = Math.min(4, Math.max(0.15, distance * Math.exp(event.deltaY / 900)));
    requestAnimationFrame(draw);
  }, {passive: false});
  const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
  (function sway(now) {
    if (turning) { yaw = view.yaw + SWAY * Math.sin(now / 2600); draw(); if (!calm && !still) requestAnimationFrame(sway); }
  })(0);
}

function showPicture() {
  const map = DATA.gallery[DATA.gallery.length - 1];
  document.body.innerHTML = `<div class="strip"><img src="${map.reference}"><img src="${map.map}"><canvas width="784" height="588"></canvas></div>`;
  document.body.style.margin = "0";
  /* The pairs' points follow each other: those of the last pair are the last. */
  const from = Math.ceil(DATA.cloud.count * (1 - DATA.last_pair_share));
  showCloud(document.querySelector("canvas"), {first: {yaw: 0.28, pitch: 0.14, distance: 0.95}, from, splatAtOne: 2.6, still: true});
}
