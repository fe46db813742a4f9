"""A scenario's zones in the emulator, its sink's events against the truth of every look. Not a benchmark by itself.

SPDX-License-Identifier: Apache-2.0
"""
import bisect
import csv
import pathlib
import subprocess
import tempfile

# A zone of N percent is certainly entered with half as much again, and certainly not with less than ends an event.
SURE, NONE = 1.5, 0.5
AREA = 0.10  # area_percent's default


def read_csv(text):
    return list(csv.DictReader(text.splitlines()))


def run(programs, scenario, settings, zones=None):
    """(events, {(node, zone): [(time_us, share, depth_m or None)]}, watch period in us) of a scenario file's text."""
    with tempfile.TemporaryDirectory() as work:
        file = pathlib.Path(work) / "scenario.toml"
        file.write_text(scenario.read_text("utf-8") + (zones or ""), "utf-8")
        words = [word for setting in settings for word in ("--set", setting)]
        out = pathlib.Path(work) / "out"
        subprocess.run([programs / "tarsier-emulator", file, *words, "--quiet", "--out", out], check=True, capture_output=True)
        truth = subprocess.run([programs / "scene_zones", file, *settings], check=True, capture_output=True, text=True).stdout
        events = read_csv((out / "events.csv").read_text("utf-8"))
    looks = {}
    for row in read_csv(truth):
        depth_m = float(row["depth_m"]) if row["depth_m"] else None
        looks.setdefault((int(row["node"]), row["zone"]), []).append((int(row["time_us"]), float(row["share"]), depth_m))
    return events, looks


def doorways(programs, scenario, settings):
    return subprocess.run([programs / "scene_doorways", scenario, *settings], check=True, capture_output=True, text=True).stdout


def entries(looks, period_us):
    """[(first, last)]: stretches in which somebody is in the zone, from when it certainly began to when it certainly ended."""
    found, first, sure = [], None, False
    for time_us, share, _ in looks:
        if first is None and share >= AREA:
            first, sure = time_us, False
        if first is not None:
            sure = sure or share >= SURE * AREA
            if share < NONE * AREA:
                if sure:
                    found.append((first, time_us - period_us))
                first = None
    return found + ([(first, looks[-1][0])] if first is not None and sure else [])


def share_near(looks, time_us):
    """The largest true share at the looks around a time."""
    at = bisect.bisect([look[0] for look in looks], time_us)
    return max(share for _, share, _ in looks[max(0, at - 2):at + 2])


def judge_entries(events, looks, period_us, settle_us):
    """Caught: a 'begun' within the stretch or a look after it, if not begun already. False: a 'begun' with nobody there."""
    total = caught = false = 0
    latencies_us = []
    for (node, zone), seen in looks.items():
        begun = [int(event["capture_time_us"]) for event in events
                 if int(event["node"]) == node and event["zone"] == zone and event["kind"] == "begun"]
        for first, last in entries(seen, period_us):
            if first < settle_us:
                continue
            total += 1
            hits = [time for time in begun if first - period_us <= time <= last + period_us]
            caught += 1 if hits else 0
            latencies_us += [max(0, hits[0] - first)] if hits else []
        false += sum(1 for time in begun if time >= settle_us and share_near(seen, time) < NONE * AREA)
    return {"entries": total, "caught": caught, "false": false, "latencies_us": latencies_us}
