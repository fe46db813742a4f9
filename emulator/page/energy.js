/* Mean power by part, and what a battery makes of it. */
/* part, words, colour, states of nodes.csv. */
const PARTS = [
  ["listening", "listen", ["radio_receive"]],
  ["sending", "send", ["radio_transmit", "radio_assess", "radio_acknowledge", "radio_sleep"]],
  ["processor", "compute", ["cpu_run", "cpu_sleep"]],
  ["camera", "camera", ["camera_start", "camera_expose", "camera_read", "camera_standby"]],
  ["storage", "storage", ["storage_write", "storage_read", "storage_standby"]],
  ["leakage", "board", ["board_leakage"]],
];
/* Of the time in which the node had power, as its battery's life is. */
const mj = (node, [, , states]) => sum(states.map((state) => node[`energy_mj_${state}`]));
const mw = (node, part) => node.energy_mj_total > 0 ? mj(node, part) / node.energy_mj_total * node.battery_mean_power_uw / 1000 : 0;
const powerOf = (node, parts) => sum(parts.map((part) => mw(node, part)));

/* A bar each. */
function powerBars(id, title, parts, sorted, withLife) {
  const most = Math.max(...sorted.map((node) => powerOf(node, parts)), 1e-9);
  return (width) => {
    const left = width < 560 ? 84 : 128, bar = 20, fit = Math.floor((left - 6) / 6.4), height = sorted.length * bar + 66;
    const p = plot(width, height, {x: [0, most * 1.02], y: [sorted.length, 0], left, right: withLife ? 92 : 20, top: 22});
    const out = [text(0, 12, title, {kind: "soft"}), p.axisX("mean power, mW")];
    if (withLife) out.push(text(width - 2, 12, "battery life", {kind: "soft", anchor: "end"}));
    sorted.forEach((node, i) => {
      let x = 0;
      const y = p.y(i);
      out.push(text(0, y + 14, node.name.length > fit ? node.name.slice(0, fit - 1) + "…" : node.name, {title: nodeTitle(node)}));
      for (const part of parts) {
        const value = mw(node, part);
        out.push(rect(p.x(x), y + 3, p.x(x + value) - p.x(x), bar - 6, part[1], `${node.name}, ${part[0]}: ${short(value)} mW, ${short(mj(node, part))} mJ in all`));
        x += value;
      }
      if (withLife) out.push(text(width - 2, y + 14, days(node.battery_life_days), {anchor: "end"}));
    });
    return {height, body: out.join("")};
  };
}

/* Many nodes side by side, the greediest first: areas in the place of bars. */
function powerCurve(id, title, parts, sorted) {
  const most = Math.max(...sorted.map((node) => powerOf(node, parts)), 1e-9);
  return (width) => {
    const height = 220, p = plot(width, height, {x: [0, sorted.length], y: [0, most * 1.05], top: 24});
    const out = [text(0, 12, title, {kind: "soft"}), p.axisY("mean power, mW")];
    let below = sorted.map(() => 0);
    for (const part of parts) {
      const above = sorted.map((node, i) => below[i] + mw(node, part));
      const edge = (values) => values.flatMap((value, i) => [`${fixed(p.x(i))} ${fixed(p.y(value))}`, `${fixed(p.x(i + 1))} ${fixed(p.y(value))}`]);
      out.push(`<path d="M${[...edge(above), ...edge(below).reverse()].join("L")}Z" fill="var(--${part[1]})"><title>${part[0]}: ${short(sum(sorted.map((node) => mw(node, part))) / sorted.length)} mW on average</title></path>`);
      below = above;
    }
    out.push(p.axisX("nodes, by their power"));
    return {height, body: out.join("")};
  };
}

function showEnergy() {
  const few = nodes.length <= 40, used = PARTS.filter((part) => nodes.some((node) => mw(node, part) > 0));
  const rest = used.filter(([part]) => part !== "listening"); /* listening outweighs all else, so it is shown with and without */
  const draw = (id, title, parts, life) => {
    const sorted = [...nodes].sort((a, b) => powerOf(b, parts) - powerOf(a, parts));
    return few ? powerBars(id, title, parts, sorted, life) : powerCurve(id, title, parts, sorted);
  };
  const states = used.flatMap((part) => part[2]).filter((state) => nodes.some((node) => node[`energy_mj_${state}`] > 0));
  $("energy-note").textContent = `— batteries of ${number(summary.usable_battery_j / 1000, 1)} kJ usable; figures from data sheets, not measured`;
  chart("energy-all", {label: "Mean power of the nodes by part", draw: draw("energy-all", "all parts", used, true)});
  chart("energy-rest", {
    label: "Mean power of the nodes by part, without listening",
    draw: draw("energy-rest", "without listening", rest, false),
    below: legend(used.map(([part, colour]) => [colour, part])) + `<p class="soft note">The radio is always on in this version and outweighs all else. A gateway is fed by the sink's computer where it stands beside it.</p>`,
    table: () => [["node", "mean power, uW", "life, days", ...states.map((state) => state.replace("_", " ") + ", mJ")],
      nodes.map((node) => [node.name, node.battery_mean_power_uw, node.battery_life_days, ...states.map((state) => node[`energy_mj_${state}`])])],
    tableTitle: "every state of every node as a table",
  });
  const lives = nodes.filter((node) => node.role !== "gateway" && node.battery_life_days !== null).map((node) => node.battery_life_days);
  if (!few && lives.length > 0) {
    histogram("life", {series: [{name: "nodes", colour: "listen", values: lives}], quantity: "battery life", unit: "days", what: "nodes", label: "Battery life of the nodes but the gateway",
      marks: totals.median_life_days === null ? [] : [[totals.median_life_days, `median ${days(totals.median_life_days)}`]]});
  }
}
