"""The same seed gives the same bytes whatever compiled the programs, and with any number of threads: gcc and clang, -O0 and -O3.

Only with tools/test --all: it builds three times what a run needs, in build/compare.
"""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, skip

SOURCE = pathlib.Path(os.environ["TSR_SOURCE"])
PROGRAMS = ("tarsier", "tarsier-emulator", "tarsier-sink")
COMPILERS = {"gcc": ("gcc", "g++"), "clang": ("clang", "clang++")}
# Beside the release build, which is the system's compiler at -O3.
OTHERS = (("clang", "-O3"), ("gcc", "-O0"), ("clang", "-O0"))
# The scenario files, shortened; a zone of the tank needs its pair and its picture as they are.
SMALL = ("pairs.count=2", "pairs.width=96", "pairs.height=72")
SCENARIOS = {"house": SMALL, "car": SMALL, "bedroom": SMALL, "street": SMALL, "tank": ()}
DURATION = "duration_s=12"
# All that computes with fractions or draws and is off in the scenario files: lenses, jitter, two boards' clocks, fading.
HARSH = """name = "harsh"
duration_s = 14

[scene]
kind = "street"
people = 3
sun_hours = 1

[pairs]
count = 2
boards = "two"
width = 80
height = 64
baseline_mm = 600

[camera]
distortion = [-0.1, 0.02, 0.001, -0.001]
rolling_shutter_ms = 12
jitter_us = 500

[radio]
shadowing_db = 4
fading_db = 3

[[fault]]
at_s = 3
kind = "clock drift"
node = 1
ppm = 80

[[fault]]
at_s = 9
kind = "reboot"
node = 2
"""
CROWD = """name = "crowd"
duration_s = 14

[recorded]
site = "frames/site.toml"
area_m = [60, 40]

[pairs]
count = 10
start_within_s = 8
"""
# Other ways to run one of them: what is sent is JPEG, and a run for each value.
MODES = {"jpeg": ("bedroom", ("--set", 'pairs.boards="one"', "--baseline", "changes")),
         "sweep": ("tank", ("--sweep", "pairs.baseline_mm=100,140"))}
# SQLite's file, times of day, and keys, which do not depend on what is computed.
NOT_COMPARED = ("sink.db", "sink.log", "keys.toml", "tarsier-run")


def run(*words):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True)
    check(done.returncode == 0, f"{words}: {done.stdout[-2000:]}{done.stderr[-2000:]}")


def build(compiler, optimisation):
    folder = SOURCE / "build/compare" / f"{compiler}{optimisation}"
    c_compiler, cpp_compiler = COMPILERS[compiler]
    run("cmake", "-S", SOURCE, "-B", folder, "-G", "Ninja", f"-DCMAKE_C_COMPILER={c_compiler}", f"-DCMAKE_CXX_COMPILER={cpp_compiler}",
        f"-DCMAKE_C_FLAGS={optimisation}", f"-DCMAKE_CXX_FLAGS={optimisation}")
    run("cmake", "--build", folder, "-j", "2", "--target", *PROGRAMS)
    return folder / "bin"


def contents(folder):
    """By name, but for how long it took and where it lies."""
    found = {}
    for file in sorted(folder.rglob("*")):
        if file.is_file() and file.name not in NOT_COMPARED:
            content = file.read_bytes().replace(bytes(folder.parent), b"")
            if file.name in ("summary.json", "index.html"):
                content = re.sub(rb'"wall_time_s": ?[0-9.e-]+', b"", content)
            found[f"{folder.name}/{file.relative_to(folder)}"] = content
    return found


def shortened(name):
    """The words that run a scenario file."""
    settings = (DURATION, *SCENARIOS[name])
    return [SOURCE / f"emulator/scenarios/{name}.toml", *(word for setting in settings for word in ("--set", setting))]


def bytes_of(programs, folder, threads):
    """All that scenes, a rendering, a crowd that sees it, a baseline and a sweep give."""
    folder.mkdir()
    (folder / "harsh.toml").write_text(HARSH)
    (folder / "crowd.toml").write_text(CROWD)
    run(programs / "tarsier", "render", folder / "harsh.toml", "--threads", threads, "--out", folder / "frames")
    found = contents(folder / "frames")
    runs = {name: shortened(name) for name in SCENARIOS}
    runs.update({name: [folder / f"{name}.toml"] for name in ("harsh", "crowd")})
    runs.update({name: [*shortened(scenario), *options] for name, (scenario, options) in MODES.items()})
    for name, words in runs.items():
        run(programs / "tarsier-emulator", *words, "--threads", threads, "--quiet", "--out", folder / name)
        found.update(contents(folder / name))
        check(any(re.match(f"{name}/(runs/1/)?(maps|pictures)/", file) for file in found),
              f"{name}: no map came, so nothing is compared")
    return found


def compare(what, found, expected):
    check(found.keys() == expected.keys(), f"{what}: other files: {sorted(found.keys() ^ expected.keys())[:9]}")
    different = [name for name, content in expected.items() if found[name] != content]
    check(not different, f"{what}: {len(different)} of {len(expected)} files differ: {different[:9]}")
    print(f"{what}: {len(expected)} files equal", flush=True)


if os.environ.get("TSR_TEST_ALL") != "1":
    skip("test_same_everywhere", "builds three times more; only with tools/test --all")
if not all(shutil.which(program) for pair in COMPILERS.values() for program in pair):
    skip("test_same_everywhere", "gcc and clang are not both installed")
with tempfile.TemporaryDirectory() as scratch:
    scratch = pathlib.Path(scratch)
    wanted = bytes_of(BUILD / "bin", scratch / "release", 1)
    compare("release, 3 threads", bytes_of(BUILD / "bin", scratch / "threads", 3), wanted)
    for other in OTHERS:
        compare(" ".join(other), bytes_of(build(*other), scratch / "".join(other), 2), wanted)
