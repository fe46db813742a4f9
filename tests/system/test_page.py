"""The page of a run holds the run's data, in itself and small, and says the same as summary.json and the tables; also of a run that was stopped."""
# SPDX-License-Identifier: Apache-2.0
import csv
import json
import pathlib
import re
import signal
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_page import PAGE_SCENARIO, page_data
from run_site import check, emulate, start_emulator

PAGE_BYTES_MAX = 5_000_000


def rows_of(file):
    with file.open(newline="") as lines:
        return list(csv.reader(lines))


def same(cell, value):
    """A cell of a CSV table and one of the page's."""
    if value is None:
        return cell == ""
    if isinstance(value, bool):
        return cell == str(value).lower()
    return cell == value if isinstance(value, str) else float(cell) == value


def check_tables(out, data):
    for name in ("nodes", "links", "maps"):
        header, *lines = rows_of(out / f"{name}.csv")
        table = data[name]
        check(table["of"] == len(lines) == len(table["rows"]), f"{name}: {len(lines)} lines, {table['of']} in the page")
        check(header == table["columns"], f"{name}: other columns in the page")
        for cells, values in zip(lines, table["rows"]):
            check(all(map(same, cells, values)), f"{name}: {cells} is not {values}")


def check_numbers(out, summary, data):
    links = [dict(zip(data["links"]["columns"], row)) for row in data["links"]["rows"]]
    nodes = [dict(zip(data["nodes"]["columns"], row)) for row in data["nodes"]["rows"]]
    for node, told in zip(nodes, summary["nodes"]):
        check(node["name"] == told["name"] and node["energy_mj_total"] == told["energy_mj"]["total"], f"{node} is not {told}")
        sent = sum(link["frames"] for link in links if link["from"] == node["id"])
        acknowledged = sum(link["acknowledgements"] for link in links if link["to"] == node["id"])
        check(sent + acknowledged == told["air"]["frames"], f"{node['name']}: links and air differ")
        told_losses = told["air"]["lost_by"]
        check(sum(told_losses.values()) == told["air"]["lost"] == node["air_lost"], f"{node['name']}: losses {told_losses}")
    for link in links:
        causes = sum(value for name, value in link.items() if name.startswith("lost_by_"))
        check(causes == link["frames"] - link["received"], f"{link}: lost frames without a cause")
    totals = data["summary"]["totals"]
    check(totals["air_lost"] == sum(totals["air_lost_by"].values()) > 0, f"losses {totals['air_lost_by']}")
    check(totals == summary["totals"], "other totals in the page")
    check(sum(entry["bytes"] for entry in totals["traffic"]) == totals["air_bytes"], "bytes of kinds and hops do not add up")
    maps = [dict(zip(data["maps"]["columns"], row)) for row in data["maps"]["rows"]]
    latencies = sorted(entry["latency_s"] for entry in maps)
    check(len(maps) >= 4 and totals["latency_s"]["median"] == latencies[(len(maps) - 1) // 2], f"latencies {latencies}")
    check(all(entry["commit_time_s"] > entry["capture_time_s"] and entry["error_correct"] > 0.3 for entry in maps), f"{maps}")
    fates = [fate for *_, fate in data["episodes"]["rows"]]
    check(fates.count("committed") == totals["maps_received"] == sum(data["timeline"]["committed"]), f"{fates}")
    check(fates.count("withheld") == totals["maps_withheld"], f"{fates}")
    check(sum(data["timeline"]["looks"]) >= totals["frames_watched"], "frames watched are missing")
    check(any("level" in what for _, what in data["events"]), f"the scene tells {data['events']}")
    return maps


def check_gallery(out, data):
    shown = data["gallery"]
    check(len(shown) == data["gallery_of"] >= 4, f"{len(shown)} maps of {data['gallery_of']}")
    for entry in shown:
        for key in ("reference", "map", "truth", "error"):
            check(entry[key].startswith("data:image/png;base64,iVBOR"), f"no {key} of {entry['pair']}")
        name = entry["numbers"]["file"].removesuffix(".pfm")
        check((out / f"{name}-error.png").exists(), f"no error picture of {name}")


def check_events(summary, data):
    """Zones, their events, faults and settings are those of the summary."""
    told, events = data["zone_events"], summary["events"]
    keys = ("capture_time_s", "node", "zone", "kind", "depth_m", "area_percent", "latency_s", "true_depth_m")
    check(told["of"] == len(events) >= 3 and told["rows"] == told["newest"] == [[event[key] for key in keys] for event in events], "other events in the page")
    check(all(abs(event["depth_m"] / event["true_depth_m"] - 1) < 0.1 for event in events), f"depths and their truth: {events}")
    check(all(entry["zones"] == [["surface", 40, 36, 18, 12]] and entry["size"] == [96, 72] for entry in data["gallery"]), "zones of the gallery")
    check(data["faults_of"] == len(summary["faults"]) == 1 and data["summary"]["faults"] == summary["faults"], "other faults in the page")
    expected = {"scenario": "page.toml", "seed": 4, "set": ["scene.clutter=0.5"], "baseline": None}
    check(data["summary"]["settings"] == summary["settings"] == expected, f"settings {summary['settings']}")


def check_self_contained(file):
    text = file.read_text()
    check(file.stat().st_size < PAGE_BYTES_MAX, f"{file.stat().st_size} bytes")
    check(not re.search(r"https?://|@import|<link|<iframe|\bfetch\(|XMLHttpRequest", text), "the page asks others")
    for address in re.findall(r'(?:src|href)="([^"]*)"', text):
        check(address.startswith(("data:", "${")), f"the page asks for {address}")
    check("TARSIER-" not in text, "a mark was not replaced")


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    scenario = folder / "page.toml"
    scenario.write_text(PAGE_SCENARIO)
    out = folder / "out"
    summary = emulate(scenario, out, "--seed", "4", "--set", "scene.clutter=0.5")
    data = page_data(out)
    check(data["summary"]["stopped"] is False and data["summary"]["settled"], "the run did not end")
    check_tables(out, data)
    maps = check_numbers(out, summary, data)
    check_gallery(out, data)
    check_events(summary, data)
    check(str(folder) not in (out / "index.html").read_text() + (out / "summary.json").read_text(), "a folder of this machine is told")
    check_self_contained(out / "index.html")

    part = folder / "part"
    emulator = start_emulator(scenario, part, "--set", "duration_s=3000")
    time.sleep(3)
    emulator.send_signal(signal.SIGINT)
    check(emulator.wait(timeout=120) == 128 + signal.SIGINT, f"exit status {emulator.returncode}")
    data = page_data(part)
    check(data["summary"]["stopped"] and data["summary"]["virtual_time_s"] < data["played_s"], "the page does not tell that the run was stopped")
    check(json.loads((part / "summary.json").read_text())["stopped"], "the summary does not either")
    check_tables(part, data)
    check_self_contained(part / "index.html")
    print(f"{len(maps)} maps, {(out / 'index.html').stat().st_size} bytes; stopped at {data['summary']['virtual_time_s']:.1f} s")
