"""Faults of a scenario: all kinds in one run, in summary and page, twice the same; the sink is really killed."""
# SPDX-License-Identifier: Apache-2.0
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_page import page_data
from run_site import check, emulate

# Nodes 1 to 3 are binocular, 4 is the gateway; the camera of 3 fails and node 2 dies.
SCENARIO = """
name = "faults"
duration_s = 24
[scene]
kind = "tank"
level_step_m = 0.2
level_rate_m_s = 0.05
[pairs]
count = 3
width = 96
height = 72
disparities = 24
"""
FAULTS = """
[[fault]]
at_s = 0
kind = "clock drift"
node = 1
ppm = 100
[[fault]]
at_s = 8
kind = "link loss"
node = 1
for_s = 2
[[fault]]
at_s = 9
kind = "camera failure"
node = 3
for_s = 4
[[fault]]
at_s = 10.5
kind = "sink restart"
[[fault]]
at_s = 12
kind = "gateway restart"
for_s = 1
counter_start = 100000
[[fault]]
at_s = 12.5
kind = "brown-out"
node = 1
for_s = 1.25
counter_start = 100000
[[fault]]
at_s = 15
kind = "reboot"
node = 3
counter_start = 100000
[[fault]]
at_s = 18
kind = "death"
node = 2
"""


def results(out):
    summary = json.loads((out / "summary.json").read_text())
    del summary["wall_time_s"]
    return summary, {name: (out / name).read_bytes() for name in ("capture.pcapng", "sink.json", "cloud.ply")}


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    (folder / "calm.toml").write_text(SCENARIO)
    (folder / "faults.toml").write_text(SCENARIO + FAULTS)
    calm = emulate(folder / "calm.toml", folder / "calm")
    emulate(folder / "faults.toml", folder / "first")
    emulate(folder / "faults.toml", folder / "second")
    summary, files = results(folder / "first")
    check((summary, files) == results(folder / "second"), "two runs of one seed differ")
    check(calm["faults"] == [] and calm["sink_restarts"] == 0, "a calm run tells of faults")

    kinds = [fault["kind"] for fault in summary["faults"]]
    check(kinds == ["clock drift", "link loss", "camera failure", "sink restart", "gateway restart", "brown-out", "reboot", "death"],
          f"the summary tells of {kinds}")
    check(summary["faults"][4]["node"] == 4, "the gateway's restart does not name the gateway")
    check(summary["sink_restarts"] == 1, f"the sink was started again {summary['sink_restarts']} times")
    nodes = {node["id"]: node for node in summary["nodes"]}
    check([nodes[i]["lives"] for i in (1, 2, 3, 4)] == [2, 1, 2, 2], "other lives than faults")
    check(nodes[3]["captures_failed"] >= 3, "the camera did not fail")
    check(nodes[2]["energy_mj"]["radio"]["receive"] < 0.8 * nodes[3]["energy_mj"]["radio"]["receive"], "the dead node goes on listening")

    for pair in summary["pairs"]:
        times = [entry["capture_time_s"] for entry in pair["maps"]]
        check(pair["maps_sent"] <= pair["maps_received"], f"{pair['name']}: acknowledged maps are not there")
        last = {1: 13.75, 2: 0, 3: 15}[pair["lead"]]
        check(times[-1] > last, f"{pair['name']}: no map after {last} s: {times}")
        check(pair["lead"] != 2 or times[-1] < 18, "a dead node made a map")
        # Ground truth of the moment that the drifting clock means.
        check(all(entry["error"]["correct"] > 0.3 for entry in pair["maps"]), f"{pair['name']}: other truth than picture")

    check(page_data(folder / "first")["summary"]["faults"] == summary["faults"], "the page tells of other faults")
    written = (folder / "first/site.toml").read_text()
    check(written.count("[[fault]]") == 8, "site.toml lost faults")
    print(f"{len(kinds)} kinds of fault, {summary['totals']['maps_received']} maps; without faults {calm['totals']['maps_received']}")
