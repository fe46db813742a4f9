"""The laboratory: what the change detector makes of the five scenes, and how fast scenes and crowds run.

SPDX-License-Identifier: Apache-2.0
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import threading
import time

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/target"))
import board  # noqa: E402
import change_energy  # noqa: E402
import progress  # noqa: E402
import zone_events  # noqa: E402

SCENES = ("house", "car", "bedroom", "street", "tank")
SEEDS = (1, 2, 3)
CAUGHT_MIN, FALSE_MAX = 0.99, 0.005
# 100 nodes, one frame a second each, in the scene that has room for them.
STREET_SPEED_MIN = 5
STREET = ("pairs.count=100", "pairs.watch_period_ms=1000", "duration_s=60", "scene.sun_hours=0.02")
# 1,000 nodes as the scenario file has them, and all switched on at one instant: then the channel is full.
CROWD_NODES, CROWD_SPEED_MIN, CROWD_KB_MAX = 1000, 20, 300
RUSH = ("duration_s=60", "pairs.start_within_s=0")


def target(name, value, unit, goal=None, met=None, how=""):
    return {"name": name, "value": round(value, 4), "unit": unit, "target": goal, "met": met, "how": how}


def build():
    release = SOURCE / "build/release"
    board.run(["cmake", "--preset", "release", "-DTSR_TESTS=ON"], cwd=SOURCE)
    board.run(["cmake", "--build", release, "--target", "scene_changes", "scene_doorways", "scene_zones",
               "tarsier", "tarsier-emulator", "tarsier-sink"], timeout_s=1800)
    return release / "bin"


def changes(programs, scene, seed):
    progress.tell(f"{scene}, seed {seed}")
    found = subprocess.run([programs / "scene_changes", SOURCE / f"emulator/scenarios/{scene}.toml", f"seed={seed}"],
                           capture_output=True, text=True, check=True)
    return {"scene": scene, "seed": seed, **json.loads(found.stdout)}


def change_targets(rows):
    def total(field, chosen):
        return sum(row[field] for row in chosen)
    for scene in (*SCENES, "all five"):
        chosen = [row for row in rows if scene in (row["scene"], "all five")]
        caught = total("caught", chosen) / max(1, total("events", chosen))
        false = total("quiet_wakes", chosen) / max(1, total("quiet", chosen))
        goal = scene == "all five"
        yield target(f"change detection, {scene}: events caught", caught, f"of {total('events', chosen)}",
                     CAUGHT_MIN if goal else None, caught >= CAUGHT_MIN if goal else None,
                     "noise, light drift, exposure control; an event covers half a percent of the picture")
        yield target(f"change detection, {scene}: false wakes", false, f"of {total('quiet', chosen)} quiet frames",
                     FALSE_MAX if goal else None, false <= FALSE_MAX if goal else None, "")


def watch_sink(pid, peaks_kb):
    """Notes the largest resident set of the emulator's child until that has ended; its last 200 ms may be missed."""
    children = pathlib.Path(f"/proc/{pid}/task/{pid}/children")
    while True:
        try:
            for child in children.read_text().split():
                found = re.search(r"VmHWM:\s+(\d+) kB", pathlib.Path(f"/proc/{child}/status").read_text())
                peaks_kb.append(int(found[1]) if found else 0)
        except OSError:
            if not children.exists():
                return
        time.sleep(0.2)


def emulate(programs, scenario, settings):
    """What a run says of itself, and what it took: processor time of both programs, memory of the larger one and of the sink."""
    with tempfile.TemporaryDirectory() as out:
        words = [word for setting in settings for word in ("--set", setting)]
        run = subprocess.Popen([programs / "tarsier-emulator", SOURCE / f"emulator/scenarios/{scenario}.toml", *words, "--quiet",
                                "--out", out], stdout=subprocess.DEVNULL)
        sink_peaks_kb = [0]
        watcher = threading.Thread(target=watch_sink, args=(run.pid, sink_peaks_kb))
        watcher.start()
        _, status, usage = os.wait4(run.pid, 0)
        watcher.join()
        run.returncode = os.waitstatus_to_exitcode(status)
        if run.returncode != 0:
            raise RuntimeError(f"{scenario}: exit status {run.returncode}")
        summary = json.loads((pathlib.Path(out) / "summary.json").read_text())
    return {"nodes": len(summary["nodes"]), "virtual_s": summary["virtual_time_s"], "wall_s": summary["wall_time_s"],
            "cpu_s": round(usage.ru_utime + usage.ru_stime, 1), "peak_kb": usage.ru_maxrss, "sink_peak_kb": max(sink_peaks_kb),
            "speed": summary["virtual_time_s"] / summary["wall_time_s"], **summary["totals"]}


def scale(programs):
    progress.tell("100 nodes in a scene")
    found = {"street": emulate(programs, "street", STREET)}
    with tempfile.TemporaryDirectory() as folder:
        frames = pathlib.Path(folder) / "house"
        progress.tell("frames for 1,000 nodes")
        board.run([programs / "tarsier", "render", SOURCE / "emulator/scenarios/house.toml", "--out", frames], timeout_s=1800)
        site = f'recorded.site="{frames}/site.toml"'
        progress.tell("1,000 nodes")
        found["crowd"] = emulate(programs, "crowd", (site,))
        progress.tell("100 nodes")
        found["hundred"] = emulate(programs, "crowd", (site, "pairs.count=100"))
        progress.tell("1,000 nodes at one instant")
        found["rush"] = emulate(programs, "crowd", (site, *RUSH))
    return found


def scale_targets(found):
    street, crowd, hundred, rush = found["street"], found["crowd"], found["hundred"], found["rush"]
    yield target("100 nodes in a virtual scene", street["speed"], "x real time", STREET_SPEED_MIN, street["speed"] >= STREET_SPEED_MIN,
                 "one frame a second each, start and report included")
    yield target("1,000 nodes from recorded frames", crowd["speed"], "x real time", CROWD_SPEED_MIN, crowd["speed"] >= CROWD_SPEED_MIN,
                 "emulator/scenarios/crowd.toml; start and report included")
    yield target("1,000 nodes from recorded frames: memory of a node", crowd["peak_kb"] / CROWD_NODES, "KB", CROWD_KB_MAX,
                 crowd["peak_kb"] <= CROWD_KB_MAX * CROWD_NODES, "peak resident set of the larger process, emulator or sink; frames, start and report included")
    yield target("1,000 nodes from recorded frames: memory of one more", (crowd["peak_kb"] - hundred["peak_kb"]) / (CROWD_NODES - 100), "KB",
                 how="against 100 nodes, which share the same frames")
    yield target("1,000 nodes from recorded frames: memory of the sink", crowd["sink_peak_kb"] / CROWD_NODES, "KB a node",
                 how="peak resident set while it runs beside the emulator")
    yield target("1,000 nodes switched on at one instant", rush["speed"], "x real time", how="the channel is full; 60 s and 2 minutes more")


def bench():
    programs = build()
    rows = [changes(programs, scene, seed) for scene in SCENES for seed in SEEDS]
    zone_targets, zones = zone_events.bench(programs, SOURCE / "emulator/scenarios", target)
    energy_targets, energy = change_energy.bench(programs, SOURCE / "emulator/scenarios", target)
    found = scale(programs)
    return {"targets": [*change_targets(rows), *zone_targets, *energy_targets, *scale_targets(found)],
            "details": {"changes": rows, "zones": zones, "energy": energy, "scale": found}}


def changes_table(result):
    lines = ["| scene | cameras x seeds | events | caught | quiet frames | false wakes |", "|---|---:|---:|---:|---:|---:|"]
    for scene in SCENES:
        rows = [row for row in result["details"]["changes"] if row["scene"] == scene]
        cells = [sum(row[field] for row in rows) for field in ("cameras", "events", "caught", "quiet", "quiet_wakes")]
        lines.append(f"| {scene} | " + " | ".join(str(cell) for cell in cells) + " |")
    return "\n".join(lines)


def table(result):
    details = result["details"]
    return "\n\n".join(("## Change detection", changes_table(result), "## Depth events", zone_events.table(details["zones"]),
                        "## Energy of a change", change_energy.table(details["energy"])))
