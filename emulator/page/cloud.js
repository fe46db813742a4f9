/*
 * The cloud, drawn point by point with a depth buffer: no library, no GPU.
 *
 * nearness: first distance, in sizes of the cloud; from: first point shown; splatAtOne: side of a point, px, seen from
 * the distance of that size; trim: the part at each end of an axis that does not count for the size.
 */
function showCloud(canvas, {nearness, from = 0, splatAtOne, trim, still = false}) {
  const bytesOf = (content) => Uint8Array.from(atob(content), (c) => c.charCodeAt(0));
  const {count: all, low, step} = DATA.cloud, grid = new Uint16Array(bytesOf(DATA.cloud.positions).buffer), colours = bytesOf(DATA.cloud.colours);
  const positions = Float32Array.from(grid, (value, i) => low[i % 3] + step[i % 3] * value);
  const context = canvas.getContext("2d"), width = canvas.width, height = canvas.height;
  if (all === 0) { context.fillStyle = "#999"; context.font = "24px sans-serif"; context.fillText("no points", 30, 50); return; }
  const middle = [0, 1, 2].map((axis) => {
    const shown = all - from, values = Float32Array.from({length: shown}, (_, i) => positions[3 * (from + i) + axis]).sort();
    const [first, last] = [values[Math.floor(shown * trim)], values[Math.floor(shown * (1 - trim))]];
    return {centre: (first + last) / 2, spread: last - first};
  });
  const size = Math.max(...middle.map((axis) => axis.spread), 1e-6);
  let yaw = 0.28, pitch = 0.14, distance = nearness, turning = true, dragged = null;
  const image = context.createImageData(width, height), pixels = new Uint32Array(image.data.buffer), depth = new Float32Array(width * height);

  function draw() {
    pixels.fill(0xff13100e);
    depth.fill(Infinity);
    const [sy, cy, sp, cp] = [Math.sin(yaw), Math.cos(yaw), Math.sin(pitch), Math.cos(pitch)];
    const focal = 0.95 * height * 1.15;
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
    if (turning) { yaw = 0.28 * Math.cos(now / 2600); draw(); if (!calm && !still) requestAnimationFrame(sway); }
  })(0);
}

function showPicture() {
  const map = DATA.gallery[DATA.gallery.length - 1];
  document.body.innerHTML = `<div class="strip"><img src="${map.reference}"><img src="${map.map}"><canvas width="784" height="588"></canvas></div>`;
  document.body.style.margin = "0";
  /* The pairs' points follow each other: those of the last pair are the last. */
  const from = Math.ceil(DATA.cloud.count * (1 - DATA.last_pair_share));
  showCloud(document.querySelector("canvas"), {nearness: 0.95, from, splatAtOne: 2.6, trim: 0.02, still: true});
}
