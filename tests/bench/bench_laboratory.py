"""The laboratory: what the change detector makes of the five scenes, and how fast scenes run.

SPDX-License-Identifier: Apache-2.0
"""
import json
import pathlib
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/target"))
import board  # noqa: E402
import progress  # noqa: E402
import zone_events  # noqa: E402

SCENES = ("house", "car", "bedroom", "street", "tank")
SEEDS = (1, 2, 3)
CAUGHT_MIN, FALSE_MAX = 0.99, 0.005
# 100 nodes, one frame a second each, in the scene that has room for them.
CROWD = {"scenario": "street", "speed_min": 5,
         "settings": ("pairs.count=100", "pairs.watch_period_ms=1000", "duration_s=60", "scene.sun_hours=0.02")}


def target(name, value, unit, goal=None, met=None, how=""):
    return {"name": name, "value": round(value, 4), "unit": unit, "target": goal, "met": met, "how": how}


def build():
    release = SOURCE / "build/release"
    board.run(["cmake", "--preset", "release", "-DTSR_TESTS=ON"], cwd=SOURCE)
    board.run(["cmake", "--build", release, "--target", "scene_changes", "scene_doorways", "scene_zones",
               "tarsier-emulator", "tarsier-sink"], timeout_s=1800)
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


def crowd(programs):
    progress.tell("100 nodes in a scene")
    with tempfile.TemporaryDirectory() as out:
        settings = [word for setting in CROWD["settings"] for word in ("--set", setting)]
        board.run([programs / "tarsier-emulator", SOURCE / f"emulator/scenarios/{CROWD['scenario']}.toml", *settings, "--quiet",
                   "--out", out], timeout_s=3600)
        return json.loads((pathlib.Path(out) / "summary.json").read_text())


def bench():
    programs = build()
    rows = [changes(programs, scene, seed) for scene in SCENES for seed in SEEDS]
    zone_targets, zones = zone_events.bench(programs, SOURCE / "emulator/scenarios", target)
    summary = crowd(programs)
    speed = summary["virtual_time_s"] / summary["wall_time_s"]
    targets = [*change_targets(rows), *zone_targets,
               target("100 nodes in a virtual scene", speed, "x real time", CROWD["speed_min"], speed >= CROWD["speed_min"],
                      "one frame a second each, start and report included")]
    return {"targets": targets, "details": {"changes": rows, "zones": zones, "crowd": summary["totals"]}}


def table(result):
    lines = ["| scene | cameras x seeds | events | caught | quiet frames | false wakes |", "|---|---:|---:|---:|---:|---:|"]
    for scene in SCENES:
        rows = [row for row in result["details"]["changes"] if row["scene"] == scene]
        cells = [sum(row[field] for row in rows) for field in ("cameras", "events", "caught", "quiet", "quiet_wakes")]
        lines.append(f"| {scene} | " + " | ".join(str(cell) for cell in cells) + " |")
    return "\n".join(lines)
