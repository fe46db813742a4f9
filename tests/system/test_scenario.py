"""A virtual scene runs the whole chain, its recording plays the same, and what cannot be is refused by line."""
# SPDX-License-Identifier: Apache-2.0
import csv
import pathlib
import resource
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, emulate, stored_maps

# Still until the level rises; without noise and control a capture does not depend on those before it.
SCENARIO = """name = "still"
seed = 3
duration_s = 12

[scene]
kind = "tank"
light_drift = 0

[pairs]
count = 2

[camera]
noise = false
exposure_control = false
"""


def run(*arguments):
    return subprocess.run([str(argument) for argument in arguments], capture_output=True, text=True)


def refused(program, file, text, expected):
    file.write_text(text)
    result = run(BUILD / "bin" / program[0], *program[1:], file, "--out", file.parent / "refused")
    lines = result.stderr.strip().splitlines()
    check(result.returncode == 2 and len(lines) == 1 and expected in lines[0], f"{program}: {result.returncode} {result.stderr}")
    check(not (file.parent / "refused").exists(), "something was written")


def check_scenario_again(folder, scenario):
    """What a run leaves runs again, from wherever it stands: the same bytes on air."""
    options = ("--set", "scene.level_step_m=0.3", "--set", "pairs.count=1", "--seed", "11")
    first = emulate(scenario, folder / "set", *options)
    again = emulate(folder / "set/scenario.toml", folder / "again")
    plain = emulate(scenario, folder / "plain")
    captures = [(folder / name / "capture.pcapng").read_bytes() for name in ("set", "again", "plain")]
    check(captures[0] == captures[1] != captures[2], "scenario.toml of a run gives another run")
    check((folder / "set/scenario.toml").read_bytes() == (folder / "again/scenario.toml").read_bytes(), "its own scenario.toml differs")
    check(first["settings"] == {"scenario": "moving.toml", "seed": 11, "set": ["scene.level_step_m=0.3", "pairs.count=1"], "baseline": None}, f"{first['settings']}")
    check(again["settings"]["set"] == [] and again["seed"] == 11 and plain["seed"] == 3, f"{again['settings']}")
    emulate(folder / "again/scenario.toml", folder / "again")
    check((folder / "again/capture.pcapng").read_bytes() == captures[0], "a run in the folder of its own scenario is another one")


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    scenario = folder / "scenario.toml"
    scenario.write_text(SCENARIO)
    live = emulate(scenario, folder / "live")
    check(all(pair["maps_received"] == 1 and pair["maps"][0]["error"]["correct"] > 0.7 for pair in live["pairs"]), f"{live['pairs']}")

    for threads in (1, 3):
        result = run(BUILD / "bin/tarsier", "render", scenario, "--out", folder / f"frames{threads}", "--threads", threads)
        check(result.returncode == 0, result.stderr)
    files = sorted(file.relative_to(folder / "frames1") for file in (folder / "frames1").rglob("*.*"))
    check(len(files) > 100, f"{len(files)} files")
    for file in files:
        one, other = folder / "frames1" / file, folder / "frames3" / file
        check(one.is_dir() or one.read_bytes() == other.read_bytes(), f"{file} depends on the number of threads")
    moving = folder / "moving.toml"
    moving.write_text(SCENARIO.split("[camera]")[0].replace("duration_s = 12", "duration_s = 40"))
    summaries = [emulate(moving, folder / f"threads{threads}", "--threads", str(threads)) for threads in (1, 4)]
    for summary in summaries:
        del summary["wall_time_s"]
    check(summaries[0] == summaries[1] and stored_maps(folder / "threads1") == stored_maps(folder / "threads4"),
          "the result depends on the number of threads")
    played = emulate(folder / "frames1/site.toml", folder / "played")
    check(stored_maps(folder / "live") == stored_maps(folder / "played"), "the recording gives other maps")
    check([pair["maps"][0]["error"] for pair in live["pairs"]] == [pair["maps"][0]["error"] for pair in played["pairs"]], "other errors")

    truths = sorted((folder / "frames3/pair-2/truth").iterdir())
    for file in truths:
        header, pixels = file.read_bytes().split(b"-1.0\n", 1)
        file.write_bytes(header + b"-1.0\n" + struct.pack("<f", float("inf")) * (len(pixels) // 4))
    blind = emulate(folder / "frames3/site.toml", folder / "blind")
    judged = played["pairs"][0]["maps"][0]["error"]
    check([pair["maps"][0]["error"] for pair in blind["pairs"]] == [judged, None], f"a truth without pixels: {blind['pairs']}")
    totals = blind["totals"]
    check(totals["error_median_px"]["count"] == 1 and totals["correct_median"] == judged["correct"], f"{totals}")
    with (folder / "blind/maps.csv").open(newline="") as lines:
        cells = {row["node"]: [row[name] for name in row if name.startswith("error_")] for row in csv.DictReader(lines)}
    check(all(cells[str(blind["pairs"][0]["lead"])]) and not any(cells[str(blind["pairs"][1]["lead"])]), f"{cells}")

    check_scenario_again(folder, moving)
    again = run(BUILD / "bin/tarsier", "render", scenario, "--out", folder / "frames1")
    check(again.returncode == 2 and "is there already" in again.stderr, again.stderr)
    for program in (("tarsier-emulator",), ("tarsier", "render")):
        bad = folder / "bad.toml"
        refused(program, bad, SCENARIO + "lens = 1\n", "bad.toml:15: camera.lens: unknown field")
        refused(program, bad, SCENARIO.replace("duration_s = 12", "duration_s = -12"), "bad.toml:3: duration_s: -12 is outside")
        refused(program, bad, SCENARIO.replace("count = 2", "distance_m = 1.25\nheights_m = [0.8, 0.8]"), "is inside the basin")
        refused(program, bad, SCENARIO.replace("count = 2", "angle_deg = -3"), "bad.toml:10: pairs.angle_deg: -3 is outside 0..89.9")
    def limited():
        resource.setrlimit(resource.RLIMIT_AS, (1 << 32, 1 << 32))

    large = subprocess.run([str(BUILD / "bin/tarsier-emulator"), str(scenario), "--out", str(folder / "refused"), "--set", "pairs.count=500",
                            "--set", "pairs.width=640", "--set", "pairs.height=480"], capture_output=True, text=True, preexec_fn=limited)
    check(large.returncode == 2 and "scenario.toml: pairs: 500 pairs need 2" in large.stderr and "there are 4.3 GB" in large.stderr, large.stderr)
    check(not (folder / "refused").exists(), "something was written")
    odd = run(BUILD / "bin/tarsier-emulator", scenario, "--set", "pairs.count=none", "--out", folder / "refused")
    check(odd.returncode == 2 and "--set 'pairs.count=none'" in odd.stderr, odd.stderr)
    print(f"{len(files)} files equal, {live['totals']['maps_received']} maps equal live and played")
