"""tarsier train-prior: its source compiles and holds what it learned, the same maps give the same; bad input is refused."""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, skip

try:
    import numpy as np
except ImportError:
    skip("test_tarsier_train_prior", "python3-numpy is not installed")
import map_quality

TARSIER = BUILD / "bin/tarsier"
SOURCE = pathlib.Path(os.environ["TSR_SOURCE"])
RNG = np.random.default_rng(13)
# docs/codec.md, 2.8: tables of 6 kinds and contexts, alone, near, in packets; then what a reference adds.
NUMBERS = 6 * 5 * 64 + 3 * 274 + 6 * 3 * 64 + 274


def train(*words):
    return subprocess.run([TARSIER, "train-prior", *map(str, words)], capture_output=True, text=True, timeout=120)


def refuse(what, *words, mentions, left=None):
    done = train(*words)
    lines = done.stderr.strip().splitlines()
    check(done.returncode == 2, f"{what}: exit status {done.returncode}: {done.stderr}")
    check(len(lines) == 1 and done.stdout == "", f"{what}: {done.stdout}{done.stderr}")
    for mention in mentions:
        check(mention in lines[0], f"{what}: does not name {mention}: {lines[0]}")
    check(left is None or not left.exists() and not list(left.parent.glob(f".{left.name}*")), f"{what}: left {left}")
    print(f"{what}: {lines[0]}")


def scene(shift=0):
    y, x = np.mgrid[:40, :60]
    values = np.round(16 * (3 + (x + y) / 14)) / 16
    values[10:25, 20 + shift:35 + shift] = 12
    values[RNG.random(values.shape) < 0.05] = np.inf
    return values


def matcher_crc(text):
    return re.search(r"\.matcher_crc = (0x[0-9a-f]{4}),", text)[1]


def learns(folder):
    maps, out = folder / "maps", folder / "prior.c"
    (maps / "camera").mkdir(parents=True)
    map_quality.write_pfm(maps / "b.pfm", scene())
    values = scene(8)
    map_quality.write_png(maps / "a.png", np.where(np.isfinite(values), 256 * values, 0).astype(np.uint16))
    (maps / "notes.txt").write_text("not a map")
    for number, shift in enumerate((0, 2, 9)):
        map_quality.write_pfm(maps / f"camera/{number}.pfm", scene(shift))
    done = train(maps, "-o", out, "--id", 7)
    check(done.returncode == 0 and "2 maps alone, 2 after another" in done.stdout, done)
    print(done.stdout.strip())
    text = out.read_text()
    shipped = (SOURCE / "firmware/codec/map_prior.c").read_text()
    check(".id = 7," in text and matcher_crc(text) == matcher_crc(shipped), "id or fingerprint")
    bare = text[text.index(".weights"):]
    check(len(re.findall(r"-?\d+,", bare)) == NUMBERS, "another number of numbers")
    check(len(re.findall(r"-?\d+,", shipped[shipped.index(".weights"):])) == NUMBERS, "the shipped prior's numbers")
    words = ["cc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion", "-Werror", "-c", out, "-o", folder / "prior.o",
             *(f"-I{SOURCE}/firmware/{part}" for part in ("codec", "codec/include", "base/include"))]
    built = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=60)
    check(built.returncode == 0, built.stderr)

    again = folder / "again.c"
    check(train(maps, "-o", again, "--id", 7).returncode == 0 and again.read_text() == text, "the same maps, another prior")
    check(train(maps, "-o", again).returncode == 0 and again.read_text() == text.replace(".id = 7,", ".id = 1,"), "id")
    check(train(maps, "-o", again, "--id", 7, "--step", 1, "--step", 0.0625).returncode == 0, "steps")
    check(again.read_text() != text, "other steps, the same prior")
    done = train(maps / "camera", "-o", again)
    check("3 maps alone, 0 after another" in done.stdout, done)

    far = scene()
    far[3, 4] = 100
    (folder / "far/camera").mkdir(parents=True)
    map_quality.write_pfm(folder / "far/camera/0.pfm", far)
    map_quality.write_pfm(folder / "far/camera/1.pfm", scene())
    done = train(folder / "far", "-o", again)
    check(done.returncode == 0 and "0 maps alone, 1 after another" in done.stdout, f"disparities of the map before: {done}")


def bad_input(folder):
    maps, out = folder / "maps", folder / "bad.c"
    empty, mixed, cut, single = (folder / name for name in ("empty", "mixed", "cut", "single"))
    for path in (empty, mixed / "camera", cut, single / "camera"):
        path.mkdir(parents=True)
    map_quality.write_pfm(mixed / "camera/0.pfm", scene())
    map_quality.write_pfm(mixed / "camera/1.pfm", scene()[1:])
    map_quality.write_pfm(single / "camera/0.pfm", scene())
    (cut / "a.pfm").write_bytes((maps / "b.pfm").read_bytes()[:-5])
    for name in ("loop", "nowhere", "pipe"):
        (folder / name).mkdir()
        map_quality.write_pfm(folder / name / "a.pfm", scene())
    (folder / "loop/b.pfm").symlink_to("b.pfm")
    (folder / "nowhere/b.png").symlink_to("none.png")
    os.mkfifo(folder / "pipe/b.pfm")

    def refuse_folder(what, path, *words, mentions):
        refuse(what, path, "-o", out, *words, mentions=mentions, left=out)

    refuse("no folder", "-o", out, mentions=["DIR"], left=out)
    refuse("no output", maps, mentions=["--out"])
    refuse("output without a name", maps, "-o", "", mentions=["--out", "empty"])
    refuse("output over a map", maps, "-o", maps / "b.pfm", mentions=["b.pfm", "--out", ".c"])
    refuse("nowhere to write", maps, "-o", folder / "no/where.c", mentions=["where.c"])
    refuse_folder("not there", folder / "none", mentions=["none", "folder"])
    refuse_folder("a map, not its folder", maps / "b.pfm", mentions=["b.pfm", "folder"])
    refuse_folder("an empty folder", empty, mentions=["empty", "no map"])
    refuse("an empty folder beside another", maps, empty, "-o", out, mentions=["empty", "no map"], left=out)
    refuse_folder("a sequence of one", single, mentions=["single", "no two"])
    refuse_folder("a sequence of two sizes", mixed, mentions=["camera/1.pfm", "size", "0.pfm"])
    refuse_folder("a truncated map", cut, mentions=["a.pfm"])
    refuse_folder("a link to itself", folder / "loop", mentions=["loop/b.pfm", "symbolic links"])
    refuse_folder("a link to nothing", folder / "nowhere", mentions=["nowhere/b.png"])
    refuse_folder("a pipe", folder / "pipe", mentions=["pipe/b.pfm", "not a regular file"])
    for option, wrong in (("--step", ("0.3", "0", "wide", "")), ("--id", ("0", "16", "-1", "first"))):
        for value in wrong:
            refuse_folder(f"{option} {value}", maps, f"{option}={value}", mentions=[option])


with tempfile.TemporaryDirectory() as name:
    learns(pathlib.Path(name))
    bad_input(pathlib.Path(name))
