"""A sweep runs a scenario once for each value: its table is that of the runs' own summaries, a run is the one that --set makes, what does not fit is refused before the first, and a signal leaves the runs until then."""
# SPDX-License-Identifier: Apache-2.0
import csv
import json
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_page import page_data
from run_site import BUILD, check, emulate, results

EMULATOR = BUILD / "bin/tarsier-emulator"
SCENARIO = """name = "sweep"
duration_s = 12

[scene]
kind = "tank"
light_drift = 0

[pairs]
count = 1
width = 96
height = 72
disparities = 24

[[zone]]
name = "level"
rectangle = [40, 30, 20, 20]
changed_by_m = 0.05
every_s = 1
"""


def run(scenario, out, *options):
    words = [EMULATOR, scenario, "--out", out, "--quiet", *options]
    return subprocess.run([str(word) for word in words], capture_output=True, text=True)


def sweep(scenario, out, *options):
    """Runs it; returns the table's rows as dictionaries of text, and what was printed."""
    result = run(scenario, out, *options)
    check(result.returncode == 0 and result.stderr == "", f"{options}: {result.returncode} {result.stderr}")
    return table(out), result.stdout


def table(out):
    with (out / "sweep.csv").open(newline="") as lines:
        return list(csv.DictReader(lines))


def lower_median(values):
    return statistics.median_low(values) if values else None


def expected(summary):
    """The figures of a run, from its summary.json alone."""
    nodes, totals = summary["nodes"], summary["totals"]
    errors = [one["error"] for pair in summary["pairs"] for one in pair["maps"] if one["error"] is not None]
    events = [event["latency_s"] for event in summary["events"]]
    figures = {name: totals[name] for name in ("frames_watched", "frames_woken", "maps_made", "maps_withheld", "maps_lost", "maps_received", "air_bytes", "air_lost",
                                               "shortest_life_days", "median_life_days")}
    return figures | {
        "virtual_time_s": summary["virtual_time_s"], "nodes": len(nodes),
        "latency_s_median": totals["latency_s"].get("median"), "latency_s_p95": totals["latency_s"].get("p95"),
        "events_received": len(events), "events_lost": sum(node["events_lost"] for node in nodes), "event_latency_s_median": lower_median(events),
        "active_mj_per_map": totals["active_mj_per_map"],
        "node_active_mj": statistics.mean(node["active_mj"] for node in nodes),
        "node_energy_mj_total": statistics.mean(node["energy_mj"]["total"] for node in nodes),
        "node_mean_power_uw": statistics.mean(node["battery"]["mean_power_uw"] for node in nodes),
        "error_mean_px": statistics.mean(error["mean_px"] for error in errors), "error_median_px": lower_median([error["median_px"] for error in errors]),
        "error_median_mm": lower_median([error["median_mm"] for error in errors]),
        "matched": sum(error["matched_pixels"] for error in errors) / sum(error["truth_pixels"] for error in errors),
        "correct": totals["correct_median"]}


def check_row(row, out):
    summary = json.loads((out / row["folder"] / "summary.json").read_text())
    for name, value in expected(summary).items():
        cell = row[name]
        same = cell == "" if value is None else abs(float(cell) - value) <= 0.0005 + 1e-9 * abs(value)
        check(same, f"{row['folder']}: {name} is {cell}, not {value}")
    check(row["stopped"] == "false", f"{row}")
    return summary


def check_product(folder, scenario):
    out = folder / "out"
    rows, printed = sweep(scenario, out, "--sweep", "pairs.count=1,2", "--sweep", 'pairs.boards="one","two"', "--seed", "5", "--set", "duration_s=14")
    swept = [(row["pairs.count"], row["pairs.boards"], row["folder"]) for row in rows]
    check(swept == [("1", "one", "runs/1"), ("1", "two", "runs/2"), ("2", "one", "runs/3"), ("2", "two", "runs/4")], f"{swept}")
    check(list(rows[0])[:3] == ["pairs.count", "pairs.boards", "stopped"], f"columns {list(rows[0])}")
    summaries = [check_row(row, out) for row in rows]
    check([len(summary["nodes"]) for summary in summaries] == [2, 3, 3, 5], "other nodes than the values say")
    check(all(summary["seed"] == 5 for summary in summaries), "--seed was lost")
    check(all(int(row["maps_received"]) >= 1 for row in rows) and any(int(row["events_received"]) > 0 for row in rows), f"nothing happened: {rows}")
    for row in rows:
        line = next(line for line in printed.splitlines() if line.endswith(row["folder"]))
        check(line.split() == [cell for cell in row.values() if cell], f"printed {line}, in the table {row}")
    check("4 of 4 runs" in printed, printed)
    data = page_data(out)
    check(data["columns"] == list(rows[0]) and len(data["rows"]) == data["planned"] == 4 and data["swept"] == 2, "the page has another table")

    emulate(scenario, folder / "alone", "--seed", "5", "--set", "duration_s=14", "--set", "pairs.count=2", "--set", 'pairs.boards="one"')
    check(results(folder / "alone") == results(out / "runs/3"), "a run of a sweep is not the run that --set makes")

    rows, _ = sweep(scenario, out, "--sweep", "seed=7,8")
    check([row["seed"] for row in rows] == ["7", "8"] and [check_row(row, out)["seed"] for row in rows] == [7, 8], f"{rows}")
    check(sorted(path.name for path in (out / "runs").iterdir()) == ["1", "2"], "runs of the sweep before are still there")
    return len(expected(summaries[0]))


def check_refusals(folder, scenario):
    """One line, before anything is run or written, and what was there stays."""
    kept = folder / "kept"
    sweep(scenario, kept, "--sweep", "seed=1")
    before = results(kept / "runs/1")
    site = folder / "site.toml"
    site.write_text('[site]\nname = "s"\n')
    for mention, what, *options in (
            ("--sweep 'pairs.baseline_mm=-3': pairs.baseline_mm: -3 is outside", scenario, "--sweep", "pairs.baseline_mm=60,-3"),
            ("--sweep 'pairs.disparities=25': ", scenario, "--sweep", "pairs.disparities=24,25"),
            ("--sweep 'pairs.count=1' 'pairs.angle_deg=89.5': ", scenario, "--sweep", "pairs.count=1", "--sweep", "pairs.angle_deg=0,89.5"),
            ("--sweep 'pairs.lens=1': pairs.lens: unknown field", scenario, "--sweep", "pairs.lens=1"),
            ("--sweep 'pairs.boards=one,two': TOML: ", scenario, "--sweep", "pairs.boards=one,two"),
            ("--sweep 'pairs.count': is not", scenario, "--sweep", "pairs.count"),
            ("seed is swept and also set", scenario, "--sweep", "seed=1,2", "--seed", "3"),
            ("pairs.count is swept and also set", scenario, "--sweep", "pairs.count=1,2", "--set", " pairs.count = 3"),
            ("pairs.count is swept and also set", scenario, "--sweep", "pairs.count=1,2", "--set", '"pairs" . \'count\' = 3'),
            ("--set '[pairs.count=2,seed=5]':1: TOML", scenario, "--set", "[pairs.count=2,seed=5]"),
            ("seed is swept twice", scenario, "--sweep", "seed=1,2", "--sweep", "seed=3"),
            ("makes more than 1000 runs", scenario, "--sweep", "seed=" + ",".join(map(str, range(1001)))),
            ("--set 'pairs.count=0': pairs.count: 0 is outside", scenario, "--sweep", "seed=1,2", "--set", "pairs.count=0"),
            ("--speed: 'fast' is neither", scenario, "--sweep", "seed=1,2", "--speed", "fast"),
            ("--sweep: is for scenarios", site, "--sweep", "seed=1,2")):
        for out in (folder / "refused", kept):
            result = run(what, out, *options)
            lines = result.stderr.strip().splitlines()
            check(result.returncode == 2 and len(lines) == 1 and mention in lines[0], f"{options}: {result.returncode} {result.stderr}")
            check(result.stdout == "", f"{options}: {result.stdout}")
    check(not (folder / "refused").exists(), "something was written")
    check(results(kept / "runs/1") == before and (kept / "sweep.csv").exists(), "a refused sweep took the results of the one before")
    foreign = folder / "foreign"
    (foreign / "runs").mkdir(parents=True)
    result = run(scenario, foreign, "--sweep", "seed=1")
    check(result.returncode == 2 and "holds runs" in result.stderr, result.stderr)


def check_signal(folder, scenario):
    """The second run waits for the wall clock, so it is under way when the signal comes."""
    out = folder / "stopped"
    words = [EMULATOR, scenario, "--out", out, "--sweep", "duration_s=10,1000,11", "--speed", "20"]
    emulator = subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (out / "runs/2/unfinished/sink.db").exists():
        check(emulator.poll() is None, f"ended early: {emulator.stderr}")
        time.sleep(0.05)
    time.sleep(0.5)
    emulator.send_signal(signal.SIGINT)
    printed, _ = emulator.communicate(timeout=120)
    check(emulator.returncode == 128 + signal.SIGINT, f"exit status {emulator.returncode}")
    rows = table(out)
    check([(row["duration_s"], row["stopped"]) for row in rows] == [("10", "false"), ("1000", "true")], f"{rows}")
    check_row(rows[0], out)
    check("2 of 3 runs" in printed and "stopped by a signal" in printed, printed)
    check(json.loads((out / "runs/2/summary.json").read_text())["stopped"], "the run's own summary does not tell")
    data = page_data(out)
    check(data["planned"] == 3 and len(data["rows"]) == 2, "the page does not tell what is missing")


def check_edited(folder, scenario):
    """All runs are of the file as it was when the sweep began."""
    edited, out = folder / "edited.toml", folder / "edited"
    text = scenario.read_text()
    edited.write_text(text)
    words = [EMULATOR, edited, "--out", out, "--quiet", "--sweep", "duration_s=10,11", "--speed", "20"]
    emulator = subprocess.Popen([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while not (out / "runs/1/sink.db").exists():
        check(emulator.poll() is None, "ended early")
        time.sleep(0.05)
    edited.write_text(text + "[nonsense]\n")
    _, told = emulator.communicate(timeout=120)
    check(emulator.returncode == 0 and len(table(out)) == 2, f"{emulator.returncode} {told}")


def check_speed(folder, scenario):
    """Paced by the wall clock: as long as it must take, and the same bytes."""
    emulate(scenario, folder / "free")
    begin = time.monotonic()
    paced = emulate(scenario, folder / "paced", "--speed", "5")
    wall_s = time.monotonic() - begin
    check(results(folder / "free") == results(folder / "paced"), "--speed changes results")
    check(wall_s >= paced["virtual_time_s"] / 5, f"{paced['virtual_time_s']} s of virtual time in {wall_s} s at five times real time")
    result = run(scenario, folder / "fast", "--speed", "1e5")
    late = re.search(r"did not keep up with --speed: ([0-9.]+) s late at worst, ([0-9.]+) s at the end", result.stdout)
    told = late is None or 0 <= float(late[2]) <= float(late[1])
    check(result.returncode == 0 and told and results(folder / "fast") == results(folder / "free"), result.stdout)


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    scenario = folder / "scenario.toml"
    scenario.write_text(SCENARIO)
    figures = check_product(folder, scenario)
    check_refusals(folder, scenario)
    check_signal(folder, scenario)
    check_edited(folder, scenario)
    check_speed(folder, scenario)
    print(f"{figures} figures of each run are those of its summary")
