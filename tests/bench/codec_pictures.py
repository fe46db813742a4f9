"""Reference images at one likeness, beside JPEG and others. Not a benchmark by itself: tools/bench codec.

For each left view of the pairs and each codec the bytes at an SSIM (docs/math.md, (89)) of .90. The shipped prior has seen these views.

SPDX-License-Identifier: Apache-2.0
"""
import statistics

import codec_peers
import measure_reference
import stereo_pairs
from progress import tell

SSIM_GOAL = 0.90
STEPS = range(63, -1, -1)  # from the poorest
PEER = "JPEG, optimised"
RATIO_GOAL = 0.75  # of the peer's bytes


def measure(folders):
    """{width: {codec: [bytes of each view]}}"""
    coders = {"tarsier": (measure_reference.code, STEPS), **codec_peers.LOSSY}
    found = {}
    for width, height, _ in stereo_pairs.CASES:
        found[width] = {name: [] for name in coders}
        for folder in folders:
            tell(f"pictures, {width} px wide, {folder.name}")
            picture = stereo_pairs.load(folder, width, height)[0]
            for name, (code, levels) in coders.items():
                found[width][name].append(codec_peers.bytes_at(SSIM_GOAL, picture, code, levels, measure_reference.ssim))
    return found


def targets(found, target):
    every = []
    for width, sizes in found.items():
        ratios = [ours / peer for ours, peer in zip(sizes["tarsier"], sizes[PEER])]
        every += ratios
        yield target(f"pictures, SSIM .90, {width} px wide", statistics.mean(ratios), f"of {PEER}'s bytes",
                     how=f"mean ratio, worst view {max(ratios):.3f}; mean bytes {statistics.mean(sizes['tarsier']):.0f}")
    yield target("pictures, SSIM .90, both sizes", statistics.mean(every), f"of {PEER}'s bytes", RATIO_GOAL,
                 "mean ratio over the views; libjpeg-turbo, quality by bisection")


def bits_per_pixel(found):
    """{codec: {width: bits}}"""
    names = next(iter(found.values()))
    return {name: {width: 8 * statistics.mean(sizes[name]) / (width * width * 3 / 4) for width, sizes in found.items()}
            for name in names}
