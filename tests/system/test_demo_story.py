"""The demo's story, judged from summary.json: watched, withheld, received, none lost, and near the truth."""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, emulate, make_scene

MEDIAN_PX_MAX = 0.4  # at 160x120, over pixels with ground truth and a match
OBJECT_S = 60  # the object enters

with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    summary = emulate(make_scene("test_demo_story", folder / "scene"), folder / "out")
    check(summary["settled"], "something was still under way at the end")
    for pair in summary["pairs"]:
        name = pair["name"]
        check(pair["maps_withheld"] >= 1, f"{name}: {pair['maps_withheld']} maps withheld")
        check(pair["maps_received"] >= 2, f"{name}: {pair['maps_received']} maps received")
        check(pair["maps_received"] == pair["maps_sent"], f"{name}: sent and received differ")
        check(pair["maps_lost"] == 0, f"{name}: {pair['maps_lost']} maps lost")
        check(pair["maps_made"] == pair["maps_withheld"] + pair["maps_sent"], f"{name}: maps do not add up")
        check(pair["frames_woken"] == 3, f"{name}: {pair['frames_woken']} wakes for three events")
        check(pair["frames_watched"] >= 50, f"{name}: only {pair['frames_watched']} frames watched")
        check(pair["maps"][-1]["capture_time_s"] >= OBJECT_S, f"{name}: no map of the object")
        for entry in pair["maps"]:
            median = entry["error"]["median_px"]
            print(f"{name}: map at {entry['capture_time_s']:.1f} s, median error {median} px")
            check(median <= MEDIAN_PX_MAX, f"{name}: median error {median} px")
            check(entry["error"]["matched_pixels"] >= entry["error"]["truth_pixels"] // 2, f"{name}: sparse map")
    for node in summary["nodes"]:
        drops = {cause: count for cause, count in node["dropped"].items() if cause not in
                 ("frame_repeated",) and count > 0}  # a repetition follows every lost acknowledgement
        check(not drops, f"node {node['id']} dropped {drops}")
    for name in ("cloud.ply", "capture.pcapng", "index.html", "sink.json"):
        check((folder / "out" / name).stat().st_size > 0, f"{name} is empty")
