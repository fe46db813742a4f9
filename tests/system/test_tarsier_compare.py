"""tarsier compare: its figures are those of tests/support/map_quality.py, and bad input is refused with one line."""
# SPDX-License-Identifier: Apache-2.0
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, skip

try:
    import numpy as np
except ImportError:
    skip("test_tarsier_compare", "python3-numpy is not installed")
import map_quality

TARSIER = BUILD / "bin/tarsier"
TOLERANCE = 1e-6
RNG = np.random.default_rng(5)


def compare(*words):
    return subprocess.run([TARSIER, "compare", *map(str, words)], capture_output=True, text=True, timeout=60)


def flat(figures):
    return {f"{name} {part}".strip(): value for name, group in figures.items()
            for part, value in (group.items() if isinstance(group, dict) else [("", group)])}


def expect_figures(what, wanted, *words):
    run = compare(*words, "--json")
    check(run.returncode == 0, f"{what}: {run.stderr}")
    got, wanted = flat(json.loads(run.stdout)), flat(wanted)
    check(got.keys() == wanted.keys(), f"{what}: {sorted(got)}")
    for name, value in wanted.items():
        near = got[name] == value if value is None or got[name] is None else abs(got[name] - value) <= TOLERANCE
        check(near, f"{what}: {name} is {got[name]}, not {value}")
    print(f"{what}: correct within 1 px {got['correct 1']:.4f}, PSNR {got['psnr_db']}, SSIM {got['ssim']}")


def refuse(what, *words, mentions):
    run = compare(*words)
    lines = run.stderr.strip().splitlines()
    check(run.returncode == 2, f"{what}: exit status {run.returncode}: {run.stderr}")
    check(len(lines) == 1 and run.stdout == "", f"{what}: {run.stdout}{run.stderr}")
    for mention in mentions:
        check(mention in lines[0], f"{what}: does not name {mention}: {lines[0]}")
    print(f"{what}: {lines[0]}")


def scene(height, width, holes):
    """Truth with steps and unknown pixels, and a map of it with errors of every size and holes."""
    y, x = np.mgrid[:height, :width]
    truth = np.round(256 * (5 + x / 11 + 9 * (x + y > 40))) / 256
    disparity = np.round(16 * (truth + RNG.normal(0, 0.7, truth.shape))) / 16
    disparity[RNG.random(truth.shape) < 0.03] += 6
    disparity[RNG.random(truth.shape) < holes] = np.inf
    truth[RNG.random(truth.shape) < holes] = np.inf
    return np.abs(disparity), truth


def figures(folder):
    for height, width, holes in ((37, 53, 0), (37, 53, 0.2), (11, 11, 0), (8, 60, 0.3), (1, 1, 0)):
        disparity, truth = scene(height, width, holes)
        map_quality.write_pfm(folder / "map.pfm", disparity)
        map_quality.write_pfm(folder / "truth.pfm", truth)
        what = f"{width}x{height}, {holes:.0%} holes"
        expect_figures(what, map_quality.judge(disparity, truth), folder / "map.pfm", folder / "truth.pfm")
        expect_figures(what + ", range 64", map_quality.judge(disparity, truth, value_range=64), folder / "map.pfm",
                       folder / "truth.pfm", "--range", 64)
        png = np.where(np.isfinite(truth), np.round(256 * truth), 0).astype(np.uint16)
        map_quality.write_png(folder / "truth.png", png)
        expect_figures(what + ", PNG", map_quality.judge(disparity, truth), folder / "map.pfm", folder / "truth.png")
        if height > 1:
            mask = RNG.choice([0, 128, 255], truth.shape).astype(np.uint8)
            map_quality.write_png(folder / "mask.png", mask)
            expect_figures(what + ", mask", map_quality.judge(disparity, truth, mask), folder / "map.pfm",
                           folder / "truth.png", "--mask", folder / "mask.png")
    disparity, truth = scene(20, 30, 0)
    map_quality.write_pfm(folder / "truth.pfm", truth)
    expect_figures("equal maps", map_quality.judge(truth, truth), folder / "truth.pfm", folder / "truth.pfm")
    map_quality.write_pfm(folder / "map.pfm", np.full_like(truth, np.inf))
    expect_figures("nothing valid", map_quality.judge(np.full_like(truth, np.inf), truth), folder / "map.pfm",
                   folder / "truth.pfm")
    text = compare(folder / "truth.pfm", folder / "truth.pfm")
    check(text.returncode == 0 and "SSIM 1.0000" in text.stdout, f"as text: {text.stdout}{text.stderr}")


def bad_input(folder):
    disparity, truth = scene(20, 30, 0)
    good = folder / "good.pfm"
    map_quality.write_pfm(good, truth)
    map_quality.write_pfm(folder / "small.pfm", truth[:, 1:])
    map_quality.write_png(folder / "mask8.png", np.zeros((20, 30), np.uint8))
    map_quality.write_png(folder / "wide.png", np.full((20, 31), 255, np.uint8))
    map_quality.write_pfm(folder / "unknown.pfm", np.full_like(truth, np.inf))
    (folder / "cut.pfm").write_bytes(good.read_bytes()[:-7])
    map_quality.write_png(folder / "good.png", (256 * disparity).astype(np.uint16))
    (folder / "cut.png").write_bytes((folder / "good.png").read_bytes()[:80])
    (folder / "colour.pfm").write_bytes(b"PF\n1 1\n-1\n" + bytes(12))
    (folder / "text.pfm").write_text("no map")
    refuse("no map", folder / "none.pfm", good, mentions=["none.pfm"])
    refuse("a folder", folder, good, mentions=[str(folder)])
    refuse("other size", good, folder / "small.pfm", mentions=["small.pfm", "size", "29x20", "30x20"])
    refuse("mask of other size", good, good, "--mask", folder / "wide.png", mentions=["wide.png", "size"])
    refuse("mask without a pixel", good, good, "--mask", folder / "mask8.png", mentions=["good.pfm", "mask"])
    refuse("mask without a name", good, good, "--mask", "", mentions=["--mask", "empty"])
    refuse("nothing known", good, folder / "unknown.pfm", mentions=["unknown.pfm", "known"])
    refuse("truncated PFM", folder / "cut.pfm", good, mentions=["cut.pfm", "pixels"])
    refuse("truncated PNG", good, folder / "cut.png", mentions=["cut.png"])
    refuse("8-bit PNG", good, folder / "mask8.png", mentions=["mask8.png", "depth"])
    refuse("colour PFM", folder / "colour.pfm", good, mentions=["colour.pfm", "magic"])
    refuse("neither format", folder / "text.pfm", good, mentions=["text.pfm", "magic"])
    refuse("range of nothing", good, good, "--range", "0", mentions=["--range"])
    refuse("one map", good, mentions=["truth"])


with tempfile.TemporaryDirectory() as name:
    figures(pathlib.Path(name))
    bad_input(pathlib.Path(name))
