"""Baseline nodes in a scene: their files, their energy recomputed from the tables of the run, and what is refused."""
# SPDX-License-Identifier: Apache-2.0
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, emulate

SCENARIO = pathlib.Path(os.environ["TSR_SOURCE"]) / "emulator/scenarios/bedroom.toml"
ONE_BOARD = ("--set", 'pairs.boards="one"', "--set", "duration_s=30")
# docs/energy.md: mW of the radio's receiver, of the processor and of a camera at work; us of a capture.
RECEIVE_MW, CPU_MW, CAMERA_MW, CAPTURE_US = 6.53 * 3.0, 52e-3 * 64 * 3.0, 2.0, 35_000
CHANGE_INSTRUCTIONS, CYCLES, MHZ = 6.0, 1.3, 64
OCTET_US, PHY_HEADER = 32, 6


def rows_of(file):
    with open(file, newline="", encoding="utf-8") as text:
        return list(csv.DictReader(text))


def near(a, b, relative, absolute=0.0):
    return abs(a - b) <= absolute + relative * abs(b)


def active_mj(node, links):
    """docs/energy.md, equation (3), from nodes.csv and links.csv."""
    heard = [link for link in links if link["to"] == node["id"]]
    heard_us = sum(OCTET_US * (int(link["received_bytes"]) + PHY_HEADER * int(link["received"])) for link in heard)
    radio = sum(float(node[f"energy_mj_radio_{state}"]) for state in ("transmit", "assess", "acknowledge"))
    cpu = float(node["energy_mj_cpu_run"])
    watching_us = float(node["work_change_units"]) * CHANGE_INSTRUCTIONS * CYCLES / MHZ
    captures = sum(float(node[f"energy_mj_camera_{state}"]) for state in ("start", "expose", "read"))
    watching_mj = int(node["frames_watched"]) * CAMERA_MW * CAPTURE_US / 1e6
    return radio + RECEIVE_MW * heard_us / 1e6 + cpu - CPU_MW * watching_us / 1e6 + captures - watching_mj


def nodes_of(summary, out):
    """nodes.csv with the units of work, which have no columns."""
    rows = rows_of(out / "nodes.csv")
    for row, node in zip(rows, summary["nodes"], strict=True):
        row["work_change_units"] = node["work"].get("change", {"units": 0})["units"]
    return rows


def check_energy(summary, out):
    links = rows_of(out / "links.csv")
    for node in nodes_of(summary, out):
        expected = active_mj(node, links)
        check(near(float(node["active_mj"]), expected, 0.005, 0.02), f"{node['name']}: {node['active_mj']} mJ, not {expected}")
        check(float(node["active_mj"]) < float(node["energy_mj_total"]), f"{node['name']}: more than all")
    totals = summary["totals"]
    total = sum(node["active_mj"] for node in summary["nodes"])
    check(near(totals["active_mj"], total, 1e-4), f"{totals['active_mj']} mJ in all, not {total}")
    check(near(totals["active_mj_per_map"], total / totals["maps_received"], 1e-3), "the energy of a map is another")


def check_pictures(summary, out, views):
    check(summary["baseline"] == {"views": views, "jpeg_quality": 50}, f"baseline: {summary['baseline']}")
    maps = rows_of(out / "maps.csv")
    files = {file.name: file.stat().st_size for file in (out / "pictures").iterdir()}
    check(len(maps) > 0 and len(files) == 2 * len(maps), f"{len(files)} files of {len(maps)} captures")
    for row in maps:
        left = pathlib.Path(row["file"]).name
        check(files[left] == int(row["reference_bytes"]), f"{left}: another length")
        check(files[left.replace("left", "right")] == int(row["map_bytes"]), f"{left}: its right one has another length")
        check((out / row["file"]).read_bytes()[:2] == b"\xff\xd8", f"{left}: no JPEG")
    check("data:image/jpeg" in (out / "index.html").read_text("utf-8"), "no picture on the page")


def refuse(words, *mentions):
    with tempfile.TemporaryDirectory() as out:
        done = subprocess.run([BUILD / "bin/tarsier-emulator", *words, "--out", pathlib.Path(out) / "out"], capture_output=True, text=True)
        left = list(pathlib.Path(out).rglob("*"))
    check(done.returncode == 2 and done.stderr.count("\n") == 1, f"{words}: {done.returncode} {done.stderr}")
    check(all(mention in done.stderr for mention in mentions), f"{words}: {done.stderr}")
    check(not left, f"{words}: left {left}")


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    maps = emulate(SCENARIO, folder / "maps", *ONE_BOARD)
    check_energy(maps, folder / "maps")
    changes = emulate(SCENARIO, folder / "changes", *ONE_BOARD, "--baseline", "changes")
    check_energy(changes, folder / "changes")
    check_pictures(changes, folder / "changes", "changes")
    again = emulate(SCENARIO, folder / "again", *ONE_BOARD, "--baseline", "changes", "--threads", "1")
    check({**again, "wall_time_s": 0} == {**changes, "wall_time_s": 0}, "the same seed gives another run")
    zone = ("--set", 'zone=[{name="z",rectangle=[0,0,9,9],changed_by_m=1}]')
    for left_out, options in ((True, zone), (True, (*zone, "--sweep", "seed=1")), (False, ())):
        words = [BUILD / "bin/tarsier-emulator", SCENARIO, "--out", folder / "zone", "--set", "duration_s=10", *ONE_BOARD[:2], "--baseline", "changes", *options]
        told = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=True).stdout
        check(("zones are left out" in told) == left_out, f"{options}: {told}")
    stream = emulate(SCENARIO, folder / "stream", *ONE_BOARD, "--baseline", "stream")
    check_pictures(stream, folder / "stream", "stream")
    check(maps["baseline"] is None, "maps are no baseline")
    for name, summary in (("maps", maps), ("changes", changes), ("stream", stream)):
        totals = summary["totals"]
        print(f"{name}: {totals['maps_received']} delivered, {totals['active_mj_per_map']} mJ each, {json.dumps(totals['latency_s'])}")

refuse([SCENARIO, "--baseline", "changes", "--set", 'pairs.boards="two"'], "pair 1", "two boards")
refuse([SCENARIO, "--baseline", "changes", "--sweep", 'pairs.boards="one","two"'], "two boards")
refuse([SCENARIO, "--baseline", "jpeg"], "--baseline", "jpeg")
