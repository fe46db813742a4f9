"""The matcher: instructions on Cortex-M4 and M55, speed beside OpenCV's StereoBM, memory, quality on pairs with truth.

Pairs come from TSR_DATA (by default ../shared/data beside the source tree); without them there is no quality. One
(pixel, disparity) is counted for every pixel of the map and every disparity searched, the left border included.

SPDX-License-Identifier: Apache-2.0
"""
import json
import os
import pathlib
import statistics

import work_table  # finds tests/target
import board
import pictures

ALOE = pictures.OPENCV_PICTURES
RATIOS = {"avx2 sad": {160: 3.5, 320: 4.5, 640: 5}, "sse2 sad": {160: 2.5, 320: 2.5, 640: 2.5}}
# Board -> its core, and by mode the most instructions per pixel and disparity at 160x120 and 320x240.
BOARDS = {board.DEFAULT: ("M4", {"sad": (10.0, 8.2), "sad8": (8.5, 7.0), "smooth": (40.0, None)}),
          board.M55: ("M55", {"sad": (6.5, 4.8)})}
WORKS = {"sad": "match", "sad8": "match_sad8", "census": "match_census", "smooth": "match_smooth", "raw": "match_raw",
         "ssd": "match_ssd"}
# (mode, figure) -> goal at 160x120 and 320x240, and whether less is better.
QUALITY = {("sad refined", "correct1"): ((0.75, 0.77), False), ("sad refined", "bad1"): ((0.108, 0.085), True),
           ("smooth refined", "correct1"): ((0.83, 0.82), False), ("smooth refined", "bad1"): ((0.070, 0.054), True),
           ("smooth dense", "correct1"): ((0.87, 0.88), False)}
BETTER_THAN_SGBM = ("bad0.5", "median_error_px")  # of sad and smooth, refined
RAM = {("sad", 160, 32): 45, ("sad", 320, 48): 172, ("smooth", 160, 32): 96, ("smooth", 320, 48): 256}  # KiB


def target(name, value, unit, goal, less, how):
    met = None if goal is None else (value <= goal if less else value >= goal)
    return {"name": name, "value": round(value, 3), "unit": unit, "target": goal, "met": met, "how": how}


def run_programs():
    """What match_peers and match_claims measure."""
    release = board.SOURCE / "build/release"
    board.run(["cmake", "--preset", "release", "-DTSR_TESTS=ON"], cwd=board.SOURCE)
    board.run(["cmake", "--build", release, "--target", "match_peers", "match_claims"], timeout_s=900)
    data = pathlib.Path(os.environ.get("TSR_DATA", board.SOURCE.parent / "shared/data"))
    pair = [ALOE / "aloeL.jpg", ALOE / "aloeR.jpg"]
    peers = [release / "bin/match_peers", *pair] + ([data] if any(data.glob("mb*")) else [])
    return (json.loads(board.run(peers, timeout_s=900)),
            json.loads(board.run([release / "bin/match_claims", *pair], timeout_s=900)))


def instructions():
    for machine, (core, goals) in BOARDS.items():
        for i, (name, shape, rows) in enumerate(work_table.measure(machine=machine)[:2]):
            for mode, work in WORKS.items():
                yield target(f"{core}, {mode}, {name}, D = {shape[2]}", work_table.match_per_output(shape, rows, work),
                             "instructions per px disparity", goals[mode][i] if mode in goals else None, True,
                             "QEMU plugin, exact, from start to map")


def memory(cases):
    for case in cases:
        for mode, size in case["bytes"].items():
            yield target(f"RAM, {mode}, {case['width']}x{case['height']}, D = {case['disparities']}", size / 1024, "KiB",
                         RAM.get((mode, case["width"], case["disparities"])), True, "pair layout and scratch")


def speed(cases):
    for case in cases:
        for name, ratio in case["ratio"].items():
            if name != "StereoBM":
                yield target(f"{name}, {case['width']}x{case['height']}, D = {case['disparities']}", ratio,
                             "times StereoBM's speed", RATIOS.get(name, {}).get(case["width"]), False,
                             "medians, one process, one thread")


def quality(cases):
    for i, case in enumerate(cases):
        size, how = f"{case['width']}x{case['height']}", f"mean of {len(case['pairs'])} pairs"
        for name, figures in case["mean"].items():
            for figure, value in figures.items():
                goals, less = QUALITY.get((name, figure), ((None, None), False))
                yield target(f"{name}, {size}: {figure}", value, "", goals[i], less, how)
        for name in ("sad refined", "smooth refined"):
            for figure in BETTER_THAN_SGBM:
                ratio = case["mean"][name][figure] / case["mean"]["StereoSGBM"][figure]
                yield target(f"{name}, {size}: {figure} over StereoSGBM's", ratio, "", 1.0, True, how)


def claims(cases):
    """H1: how much of the variance of time is linear in pixels, for the D where it is least. H2: time of ssd over raw."""
    for mode in cases[0]["ms"]:
        explained = []
        for disparities in sorted({case["disparities"] for case in cases}):
            same = [case for case in cases if case["disparities"] == disparities]
            pixels = [case["width"] * case["height"] for case in same]
            explained.append(statistics.correlation(pixels, [case["ms"][mode] for case in same]) ** 2)
        yield target(f"H1: least R^2 of time of {mode} against pixels", min(explained), "", None, False,
                     f"of {len(explained)} disparity counts, {len(cases)} cases in all")
    ratio = statistics.median(case["ms"]["ssd"] / case["ms"]["raw"] for case in cases)
    yield target("H2: time of ssd over raw, portable kernel", ratio, "", None, False, "median")


def bench():
    peers, claimed = run_programs()
    targets = [*instructions(), *memory(peers["memory"]), *speed(peers["times"]), *quality(peers["quality"]),
               *claims(claimed)]
    return {"targets": targets, "details": {**peers, "claims": claimed}}
