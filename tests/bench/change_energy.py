"""What a delivered change costs the nodes of a scene, against baseline nodes that send JPEG. Not a benchmark by itself.

SPDX-License-Identifier: Apache-2.0
"""
import json
import pathlib
import re
import subprocess
import tempfile

import progress

SCENES = ("house", "car", "bedroom", "street")  # in the tank hardly anything is a change of the picture
SEEDS = (1, 2)
ONE_BOARD = ("--set", 'pairs.boards="one"')
# Name, options, and the goal: a part of what the baseline's change costs.
KINDS = (
    ("JPEG pair", (*ONE_BOARD, "--baseline", "changes"), None),
    ("map only", (*ONE_BOARD, "--set", "pairs.reference_image=false"), 1 / 6),
    ("map and reference image", (*ONE_BOARD, "--set", "pairs.reference_image=true"), 1 / 2),
    ("map of two boards", ("--set", 'pairs.boards="two"', "--set", "pairs.reference_image=false"), 1 / 3),
    ("JPEG a minute", (*ONE_BOARD, "--baseline", "stream"), None),
)
BASELINE = KINDS[0][0]
SUMS = ("active_mj", "maps_received", "maps_withheld", "maps_lost", "frames_woken", "air_bytes")


def without_zones(text):
    """Zones make maps of their own accord, and baseline nodes have none."""
    return re.sub(r"(?ms)^\[\[zone\]\].*?(?=^\[|\Z)", "", text)


def run(programs, scenario, options, seed):
    with tempfile.TemporaryDirectory() as work:
        file = pathlib.Path(work) / scenario.name
        file.write_text(without_zones(scenario.read_text("utf-8")), "utf-8")
        out = pathlib.Path(work) / "out"
        subprocess.run([programs / "tarsier-emulator", file, "--seed", str(seed), *options, "--quiet", "--out", out], check=True,
                       capture_output=True)
        totals = json.loads((out / "summary.json").read_text("utf-8"))["totals"]
    return {**{key: totals[key] for key in SUMS}, "latency_s": totals["latency_s"].get("median")}


def measure(programs, scenarios):
    rows = []
    for scene in SCENES:
        for name, options, _ in KINDS:
            for seed in SEEDS:
                progress.tell(f"energy of a change, {scene}, {name}, seed {seed}")
                rows.append({"scene": scene, "kind": name, "seed": seed, **run(programs, scenarios / f"{scene}.toml", options, seed)})
    return rows


def total(rows, scene, kind):
    chosen = [row for row in rows if row["scene"] == scene and row["kind"] == kind]
    return {key: sum(row[key] for row in chosen) for key in SUMS}


def per_delivered(sums):
    return sums["active_mj"] / max(1, sums["maps_received"])


def per_answered(sums):
    """A map that is withheld is an answer too: the sink has one like it."""
    return sums["active_mj"] / max(1, sums["maps_received"] + sums["maps_withheld"])


def mean_ratio(rows, kind, cost):
    """Over the scenes, of the cost of a change to the baseline's."""
    ratios = [cost(total(rows, scene, kind)) / cost(total(rows, scene, BASELINE)) for scene in SCENES]
    return sum(ratios) / len(ratios)


def bench(programs, scenarios, target):
    """(targets, details) of the energy of changes."""
    rows = measure(programs, scenarios)
    targets = []
    for name, _, goal in KINDS:
        if goal is None:
            continue
        ratio, answered = mean_ratio(rows, name, per_delivered), mean_ratio(rows, name, per_answered)
        targets.append(target(f"energy of a delivered change, {name}", ratio, "of a JPEG pair's", round(goal, 3), ratio <= goal,
                              "idle excluded, over all nodes; mean of house, car, bedroom, street, two seeds each"))
        targets.append(target(f"the same of a change that was answered, {name}", answered, "of a JPEG pair's",
                              how="maps withheld because the sink has one like it count as well"))
    return targets, rows


def table(rows):
    lines = ["| scene | nodes send | delivered | withheld | lost | mJ a delivered change | of the baseline's | mJ an answered one | of the baseline's "
             "| on air, kB |", "|---|---|---:|---:|---:|---:|---:|---:|---:|---:|"]
    for scene in SCENES:
        base = total(rows, scene, BASELINE)
        for name, _, _ in KINDS:
            sums = total(rows, scene, name)
            cells = [sums["maps_received"], sums["maps_withheld"], sums["maps_lost"]]
            for cost in (per_delivered, per_answered):
                cells += [f"{cost(sums):.1f}", f"{cost(sums) / cost(base):.2f}".lstrip("0")]
            lines.append(f"| {scene} | {name} | " + " | ".join(map(str, cells)) + f" | {sums['air_bytes'] / 1000:.0f} |")
    return "\n".join(lines)
