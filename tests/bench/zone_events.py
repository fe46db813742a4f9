"""A scenario's zones in the emulator, its sink's events against the truth of every look. Not a benchmark by itself.

SPDX-License-Identifier: Apache-2.0
"""
import bisect
import csv
import json
import pathlib
import statistics
import subprocess
import tempfile

import progress

# A zone is certainly entered with half as much again as its area_percent; what is between that and what ends an event counts neither way.
SURE, NONE = 1.5, 0.5
AREA = 0.10  # area_percent's default
SETTLE_US = 8_000_000  # the detector settles, and the first map of all nodes comes through
PEOPLE = {"bedroom": 1_000_000, "house": 1_000_000, "car": 1_000_000, "street": 500_000}  # watch period, us
SEEDS = (1, 2, 3)
QUIET_DAY = ("bedroom", ("duration_s=21600",))  # four pairs for six hours
LEVEL_M = 0.05  # the tank's changed_by_m
CAUGHT_MIN, FALSE_A_DAY_MAX, ERROR_MAX_PERCENT, LATE_MAX_LOOKS = 0.99, 1, 2, 1


def read_csv(text):
    return list(csv.DictReader(text.splitlines()))


def run(programs, scenario, settings, zones=""):
    """(the summary's events, {(node, zone): [(time_us, share, depth_m or None)]}) of a scenario, with further zones."""
    with tempfile.TemporaryDirectory() as work:
        file = pathlib.Path(work) / "scenario.toml"
        file.write_text(scenario.read_text("utf-8") + zones, "utf-8")
        words = [word for setting in settings for word in ("--set", setting)]
        out = pathlib.Path(work) / "out"
        subprocess.run([programs / "tarsier-emulator", file, *words, "--quiet", "--out", out], check=True, capture_output=True)
        truth = subprocess.run([programs / "scene_zones", file, *settings], check=True, capture_output=True, text=True).stdout
        events = json.loads((out / "summary.json").read_text("utf-8"))["events"]
    for event in events:
        event["capture_time_us"] = round(1e6 * event["capture_time_s"])
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


def states(events, node, zone):
    """[(time_us, begun)] as the sink is told."""
    return [(event["capture_time_us"], event["kind"] == "begun") for event in events
            if event["node"] == node and event["zone"] == zone]


def knows(told, first_us, last_us):
    """When, from first on and not after last, the sink was told that the zone is entered, or knew it already; None if never."""
    before = [begun for time_us, begun in told if time_us < first_us]
    if before and before[-1]:
        return first_us
    return next((time_us for time_us, begun in told if begun and first_us <= time_us <= last_us), None)


def judge_entries(events, looks, period_us, settle_us):
    """Caught: the sink knows of it before it is over, or a look later. False: told of somebody when the zone is empty."""
    total = caught = false = 0
    latencies_us = []
    for (node, zone), seen in looks.items():
        told = states(events, node, zone)
        for first, last in entries(seen, period_us):
            if first < settle_us:
                continue
            total += 1
            when = knows(told, first, last + period_us)
            caught += when is not None
            latencies_us += [] if when is None else [when - first]
        false += sum(1 for time_us, begun in told if begun and time_us >= settle_us and share_near(seen, time_us) == 0)
    return {"entries": total, "caught": caught, "false": false, "latencies_us": latencies_us}


def judge_surface(events, looks, period_us, change_m):
    """Depth of each report against the truth, %, and how many looks after the true change it was taken."""
    errors, late = [], []
    for (node, zone), seen in looks.items():
        told = [event for event in events
                if event["node"] == node and event["zone"] == zone and event["kind"] == "measured"]
        truth = dict((time_us, depth_m) for time_us, _, depth_m in seen)
        known = None
        for event in told:
            look_us = event["capture_time_us"] // period_us * period_us
            errors.append(100 * abs(event["depth_m"] / truth[look_us] - 1))
            if known is not None:
                due = [time_us for time_us, _, depth_m in seen
                       if known[0] < time_us and abs(depth_m - known[1]) >= change_m]
                late.append((look_us - due[0]) / period_us if due else 0)
            known = (look_us, truth[look_us])
    return {"reports": len(errors), "errors_percent": errors, "late_looks": late}


def people(programs, scenarios, scene, settings):
    scenario = scenarios / f"{scene}.toml"
    events, looks = run(programs, scenario, settings, doorways(programs, scenario, settings))
    found = judge_entries(events, looks, PEOPLE[scene], SETTLE_US)
    days = sum(len(seen) for seen in looks.values()) * PEOPLE[scene] / 86_400e6
    return {"scene": scene, "settings": list(settings), "zone_days": days, **found,
            "delivery_s": [event["latency_s"] for event in events if event["latency_s"] is not None]}


def bench(programs, scenarios, target):
    """(targets, details) of depth events."""
    entered = []
    for scene in PEOPLE:
        for seed in SEEDS:
            progress.tell(f"people in {scene}, seed {seed}")
            entered.append(people(programs, scenarios, scene, (f"seed={seed}",)))
    progress.tell("a day of little")
    quiet = people(programs, scenarios, *QUIET_DAY)
    levels = []
    for seed in SEEDS:
        progress.tell(f"tank, seed {seed}")
        events, looks = run(programs, scenarios / "tank.toml", (f"seed={seed}",))
        levels.append({"seed": seed, **judge_surface(events, looks, 1_000_000, LEVEL_M)})
    total = sum(row["entries"] for row in entered)
    caught = sum(row["caught"] for row in entered) / max(1, total)
    false = (quiet["false"] + sum(row["false"] for row in entered)) / (quiet["zone_days"] + sum(row["zone_days"] for row in entered))
    errors = [error for row in levels for error in row["errors_percent"]]
    late = [looks for row in levels for looks in row["late_looks"]]
    delivery = [seconds for row in entered for seconds in row["delivery_s"]]
    targets = [
        target("depth events: entries of a zone caught", caught, f"of {total}", CAUGHT_MIN, caught >= CAUGHT_MIN,
               "one zone a pair where people pass, 10 % of it a pixel nearer than the background"),
        target("depth events: told of somebody when the zone is empty", false, "a day and zone", FALSE_A_DAY_MAX,
               false <= FALSE_A_DAY_MAX, f"in {quiet['zone_days'] + sum(row['zone_days'] for row in entered):.2f} days of zones"),
        target("depth events: from capture to commit, longest", max(delivery), "s", 1, max(delivery) <= 1,
               f"median {statistics.median(delivery):.3f} s of {len(delivery)}; a frame is 0.5 or 1 s"),
        target("depth events: tank, depth of the surface, largest error", max(errors), "%", ERROR_MAX_PERCENT,
               max(errors) <= ERROR_MAX_PERCENT, f"median {statistics.median(errors):.2f} of {len(errors)} reports"),
        target("depth events: tank, reports within a frame of the change", sum(n <= LATE_MAX_LOOKS for n in late) / len(late),
               f"of {len(late)}", 1, all(n <= LATE_MAX_LOOKS for n in late), "the change is 5 cm since the last report"),
    ]
    for row in (*entered, quiet):
        row["latencies_us"] = sorted(row["latencies_us"])[-3:]
        row["delivery_s"] = max(row["delivery_s"], default=None)
    return targets, {"entered": entered, "quiet": quiet, "levels": levels}


def table(details):
    lines = ["| scene, all seeds | entries | caught | told of nobody | days of zones | longest delivery, s |", "|---|---:|---:|---:|---:|---:|"]

    def add(name, rows):
        sums = [sum(row[key] for row in rows) for key in ("entries", "caught", "false")]
        days = sum(row["zone_days"] for row in rows)
        longest = max((row["delivery_s"] for row in rows if row["delivery_s"] is not None), default=0)
        lines.append(f"| {name} | " + " | ".join(map(str, sums)) + f" | {days:.2f} | {longest:.2f} |")
    for scene in PEOPLE:
        add(scene, [row for row in details["entered"] if row["scene"] == scene])
    add(f"{details['quiet']['scene']}, six hours", [details["quiet"]])
    lines += ["", "| tank, seed | reports | depth error, median, % | largest, % | reports within one look of the change |", "|---|---:|---:|---:|---:|"]
    for row in details["levels"]:
        errors, late = row["errors_percent"], row["late_looks"]
        within = sum(looks <= LATE_MAX_LOOKS for looks in late)
        lines.append(f"| {row['seed']} | {row['reports']} | {statistics.median(errors):.2f} | {max(errors):.2f} | {within} of {len(late)} |")
    return "\n".join(lines)
