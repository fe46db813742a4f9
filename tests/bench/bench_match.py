"""The matcher: Cortex-M4 instructions, speed beside OpenCV's StereoBM, memory, and quality on pairs with ground truth.

Pairs come from TSR_DATA (by default ../shared/data beside the source tree); without them there is no quality. One
(pixel, disparity) is counted for every pixel of the map and every disparity searched, the left border included.

SPDX-License-Identifier: Apache-2.0
"""
import json
import os
import pathlib

import work_table  # finds tests/target
import board
import pictures

ALOE = pictures.OPENCV_PICTURES
RATIOS = {"avx2 sad": {160: 3.5, 320: 4.5, 640: 5}, "sse2 sad": {160: 2.5, 320: 2.5, 640: 2.5}}
# Mode -> the workbench's run of it, and instructions per pixel and disparity by width.
M4 = {"sad": ("match", {160: 10.0, 320: 8.2}), "sad8": ("match_sad8", {160: 8.5, 320: 7.0}),
      "census": ("match_census", {}), "smooth": ("match_smooth", {})}
# (mode, figure) -> goal at 160x120 and 320x240, and whether less is better.
QUALITY = {("sad refined", "correct1"): ((0.75, 0.77), False), ("sad refined", "bad1"): ((0.108, 0.085), True),
           ("smooth refined", "correct1"): ((0.83, 0.82), False), ("smooth refined", "bad1"): ((0.070, 0.054), True),
           ("smooth dense", "correct1"): ((0.87, 0.88), False)}
RAM = ((160, 120, 32, 45), (320, 240, 48, 172))  # KB of 1000 bytes, both frames and the map


def target(name, value, unit, goal, less, how):
    met = None if goal is None else (value <= goal if less else value >= goal)
    return {"name": name, "value": round(value, 3), "unit": unit, "target": goal, "met": met, "how": how}


def run_peers():
    release = board.SOURCE / "build/release"
    board.run(["cmake", "--preset", "release", "-DTSR_TESTS=ON"], cwd=board.SOURCE)
    board.run(["cmake", "--build", release, "--target", "match_peers"], timeout_s=900)
    program = next(path for path in release.rglob("match_peers") if path.is_file())
    data = pathlib.Path(os.environ.get("TSR_DATA", board.SOURCE.parent / "shared/data"))
    words = [program, ALOE / "aloeL.jpg", ALOE / "aloeR.jpg"] + ([data] if any(data.glob("mb*")) else [])
    return json.loads(board.run(words, timeout_s=900))


def instructions():
    for name, shape, rows in work_table.measure()[:2]:
        for mode, (work, goals) in M4.items():
            yield target(f"M4, {mode}, {name}, D = {shape[2]}", work_table.match_per_output(shape, rows, work),
                         "instructions per px disparity", goals.get(shape[0]), True,
                         "QEMU plugin, exact, from start to map")


def memory():
    for width, height, disparities, goal in RAM:
        window = 9
        pair = 2 * width * (height + window // 2 + 1)  # TSR_MATCH_PAIR_LEN
        scratch = width * (disparities + 5) + 4 * disparities + 8  # TSR_MATCH_SCRATCH_LEN
        yield target(f"RAM, sad, {width}x{height}, D = {disparities}", (pair + scratch) / 1000, "KB", goal, True,
                     "pair layout and scratch")


def bench():
    peers = run_peers()
    targets = list(instructions()) + list(memory())
    for case in peers["times"]:
        size = f"{case['width']}x{case['height']}, D = {case['disparities']}"
        for name, ratio in case["ratio"].items():
            if name != "StereoBM":
                targets.append(target(f"{name}, {size}", ratio, "times StereoBM's speed",
                                      RATIOS.get(name, {}).get(case["width"]), False, "medians, one process, one thread"))
    for i, case in enumerate(peers["quality"]):
        for name, figures in case["mean"].items():
            for figure, value in figures.items():
                goal, less = QUALITY.get((name, figure), ((None, None), False))
                targets.append(target(f"{name}, {case['width']}x{case['height']}: {figure}", value, "", goal[i], less,
                                      f"mean of {len(case['pairs'])} pairs"))
    return {"targets": targets, "details": peers}
