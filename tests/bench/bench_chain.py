"""The demo's run, from two boards' frames to the sink's cloud: bytes, energy, error and time, from its summary.json.

Bytes, energy and errors are those of the emulator's models (docs/energy.md); seconds are this machine's.

SPDX-License-Identifier: Apache-2.0
"""
import json
import pathlib
import statistics
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/target"))
import board  # noqa: E402
import pictures  # noqa: E402

RUNS = 3
PROGRAMS = ("tarsier", "tarsier-emulator", "tarsier-sink")


def build():
    release = SOURCE / "build/release"
    if not (release / "build.ninja").exists():
        board.run(["cmake", "--preset", "release"], cwd=SOURCE)
    board.run(["cmake", "--build", release, "--target", *PROGRAMS], timeout_s=900)
    return release / "bin"


def run_once(programs, scene, out):
    try:
        subprocess.run([programs / "tarsier-emulator", scene / "site.toml", "--out", out, "--quiet"], check=True,
                       timeout=600, capture_output=True, text=True)
    except subprocess.SubprocessError as error:
        raise board.BoardError(f"tarsier-emulator: {error}: {getattr(error, 'stderr', '')}") from error
    return json.loads((pathlib.Path(out) / "summary.json").read_text("utf-8"))


def target(name, value, unit, goal=None, met=None, how="summary.json of one run"):
    return {"name": name, "value": value, "unit": unit, "target": goal, "met": met, "how": how}


def pair_targets(pair, node):
    maps = pair["maps"]
    name = pair["name"]
    yield target(f"{name}: maps the sink has", pair["maps_received"], "maps", pair["maps_sent"],
                 pair["maps_received"] == pair["maps_sent"] and pair["maps_lost"] == 0,
                 "target: every map that was sent")
    if maps:
        yield target(f"{name}: coded map", statistics.median(entry["map_bytes"] for entry in maps), "B",
                     how="median over its maps")
        yield target(f"{name}: coded reference image",
                     statistics.median(entry["reference_bytes"] for entry in maps), "B", how="median over its maps")
    errors = [entry["error"] for entry in maps if entry["error"] is not None]
    for key, unit in (("correct", "of pixels with ground truth"), ("bad_1", "of matched pixels"),
                      ("bad_half", "of matched pixels"), ("median_px", "px"), ("median_depth_percent", "%")):
        if errors:
            yield target(f"{name}: {key}", round(statistics.mean(error[key] for error in errors), 4), unit,
                         how="mean over its maps; the scene is built from one picture pair")
    yield target(f"{name}: lead's energy", node["energy_mj"]["total"], "mJ", how="emulator's model, whole run")
    yield target(f"{name}: lead's processor", node["energy_mj"]["cpu"]["run"], "mJ", how="emulator's model, whole run")


def bench():
    programs = build()
    with tempfile.TemporaryDirectory() as work:
        scene = pictures.demo_scene(work)
        summaries = [run_once(programs, scene, pathlib.Path(work) / f"run{i}") for i in range(RUNS)]
    seconds = [summary.pop("wall_time_s") for summary in summaries]
    summary = summaries[0]
    nodes = {node["id"]: node for node in summary["nodes"]}
    targets = [target("same results in every run", all(other == summary for other in summaries), "", True,
                      all(other == summary for other in summaries), f"summary.json of {RUNS} runs, without wall time"),
               target("settled, nothing lost", summary["settled"] and summary["totals"]["maps_lost"] == 0, "", True,
                      summary["settled"] and summary["totals"]["maps_lost"] == 0),
               target("bytes on air", summary["totals"]["air_bytes"], "B"),
               target("energy of all nodes", summary["totals"]["energy_mj"], "mJ", how="emulator's model, whole run"),
               target("virtual time", summary["virtual_time_s"], "s"),
               target("wall time", round(statistics.median(seconds), 3), "s",
                      how=f"median of {RUNS} runs, sink included")]
    for pair in summary["pairs"]:
        targets += pair_targets(pair, nodes[pair["lead"]])
    return {"targets": targets, "details": {"wall_time_s": seconds, "summary": summary}}
