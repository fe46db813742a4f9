/* What went wrong on purpose: in words, as a table, and where it struck. */
const ENDS_AT_ONCE = /^(reboot|gateway restart|sink restart)$/;
const faultPlace = (fault) => fault.other ? `${nameOf(fault.node)} – ${nameOf(fault.other)}` : fault.kind === "link loss" ? `${nameOf(fault.node)} – all` : fault.node ? nameOf(fault.node) : "";

/* Nothing: it ended at once, or never came to an end. */
const faultUntil = (fault) => fault.for_s > 0 ? fault.at_s + fault.for_s : null;

function faultDetails(fault) {
  return [fault.ppm !== undefined && `${fault.ppm} ppm`, fault.loss_db > 0 && `${fault.loss_db} dB weaker`, fault.frame_loss > 0 && `${number(100 * fault.frame_loss)} % of the frames lost`,
    fault.counter_start && `counters from ${fault.counter_start}`, fault.without_effect && "without effect: it was off"].filter(Boolean).join(", ");
}

/* Each by name while they are few. */
function faultsInWords() {
  const faults = summary.faults;
  const named = faults.map((fault) => fault.kind + (faultPlace(fault) && ` of ${faultPlace(fault)}`) + ` at ${number(fault.at_s, 1)} s`);
  const counted = Object.entries(DATA.faults_by_kind).map(([kind, times]) => `${kind}: ${number(times)}`);
  return `${count(DATA.faults_of, "fault")}: ${faults.length <= 8 ? named.join(", ") : counted.join(", ")}.`;
}

function showFaults() {
  const {faults} = summary;
  $("faults-section").hidden = faults.length === 0;
  if (faults.length < DATA.faults_of) $("faults-note").textContent = `— ${number(faults.length)} of ${number(DATA.faults_of)}; all are in summary.json`;
  const until = (fault) => faultUntil(fault) !== null ? number(faultUntil(fault), 1) : ENDS_AT_ONCE.test(fault.kind) ? "at once" : "the end";
  $("faults").innerHTML = tableHtml(["at, s", "what", "node or link", "until, s", "more"],
    faults.map((fault) => [number(fault.at_s, 1), fault.kind, faultPlace(fault), until(fault), faultDetails(fault)]));
}

/* On the plan: a cross over a node that died, a bar across a link that was disturbed. at: a node's place. */
function faultsOnPlan(at, size, tree) {
  const parts = [], colour = 'stroke="var(--lost)" fill="none" stroke-linecap="round"';
  const titled = (body, fault) => parts.push(`<g>${body}<title>${escape(`${fault.kind} of ${faultPlace(fault)} at ${number(fault.at_s, 1)} s ${faultDetails(fault)}`)}</title></g>`);
  const bar = (one, other, fault) => {
    const [[x1, y1], [x2, y2]] = [at(one), at(other)], long = Math.hypot(x2 - x1, y2 - y1) || 1;
    const [x, y, dx, dy] = [(x1 + x2) / 2, (y1 + y2) / 2, (size + 2) * (y2 - y1) / long, (size + 2) * (x1 - x2) / long];
    titled(`<path d="M${fixed(x1)} ${fixed(y1)}L${fixed(x2)} ${fixed(y2)}" ${colour} stroke-width="1.4" stroke-dasharray="2 4"/>` +
      `<path d="M${fixed(x - dx)} ${fixed(y - dy)}L${fixed(x + dx)} ${fixed(y + dy)}" ${colour} stroke-width="3"/>`, fault);
  };
  for (const fault of summary.faults) {
    const node = nodeById.get(fault.node), other = nodeById.get(fault.other);
    if (fault.kind === "death" && node) {
      const [x, y] = at(node), arm = size + 4;
      titled(`<path d="M${fixed(x - arm)} ${fixed(y - arm)}l${fixed(2 * arm)} ${fixed(2 * arm)}m0 ${fixed(-2 * arm)}l${fixed(-2 * arm)} ${fixed(2 * arm)}" ${colour} stroke-width="3"/>`, fault);
    }
    if (fault.kind === "link loss" && node) {
      if (other) bar(node, other, fault);
      else for (const link of tree) if (link.node === node || link.parent === node) bar(link.node, link.parent, fault);
    }
  }
  return parts.join("");
}

function faultLegend() {
  const has = (kind) => summary.faults.some((fault) => fault.kind === kind);
  const words = [has("death") && "cross: died", has("link loss") && "bar: a link with a fault"].filter(Boolean);
  return words.length > 0 ? [["lost", words.join("; ")]] : [];
}
