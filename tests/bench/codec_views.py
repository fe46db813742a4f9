"""A wing's views: bytes, and what they cost of the map. Not a benchmark by itself: tools/bench codec.

`loss` is what is lost of the correct pixels of mode sad's map against exchanging the gray view (measure_view.py).

SPDX-License-Identifier: Apache-2.0
"""
import statistics

import codec_peers
import measure_view
import stereo_pairs
import view_library
from progress import tell

TRIALS = 4  # objects a pair
BYTES_GOAL = {("first", 160): 6500, ("next", 160): 1500}  # (kind, width) -> bytes at no more than LOSS_GOAL
LOSS_GOAL = 0.005  # of the correct pixels
CAP = 7
NEXT = "an object in a tenth of the view, noise sigma 1 in every capture"


def measure(folders):
    """{width: {view: {"bytes": mean, "loss": mean, "worst": of a pair}}}, and the peers' bytes under "peers"."""
    found = {}
    for width, height, disparities in stereo_pairs.CASES:
        pairs = [stereo_pairs.load(one, width, height) + (disparities,) for one in folders]
        found[width] = {}
        for coarse, name in ((False, "exact"), (True, "coarse")):
            tell(f"views, {width} px wide, {name}")
            for kind, (sizes, losses) in (("first", measure_view.first_views(pairs, coarse, CAP)),
                                          ("next", measure_view.next_views(pairs, coarse, TRIALS,
                                                                           measure_view.NOISE_SIGMA))):
                found[width][f"{kind}, {name}"] = {"bytes": statistics.mean(sizes), "loss": float(statistics.mean(losses)),
                                                   "worst": float(max(losses))}
        found[width]["peers"] = peers([pair[1] for pair in pairs])
    return found


def peers(views):
    """Mean bytes {of what: {codec: bytes}} of the filtered view, losslessly, and of the gray one."""
    filtered = [codec_peers.lossless(view_library.prefilter(view, CAP)) for view in views]
    gray = [{"tarsier": view_library.code_gray(view, 0)[0], **codec_peers.lossless(view)} for view in views]
    return {name: {codec: statistics.mean(one[codec] for one in each) for codec in each[0]}
            for name, each in (("filtered", filtered), ("gray", gray))}


def targets(found, target):
    for width, views in found.items():
        for name, figures in views.items():
            if name == "peers":
                continue
            yield target(f"views, {name}, {width} px wide", figures["bytes"], "B",
                         BYTES_GOAL.get((name.split(",")[0], width)), NEXT if name.startswith("next") else "")
            yield target(f"views, {name}, loss of correct, {width} px wide", figures["loss"], "of the pixels with truth",
                         LOSS_GOAL, f"worst pair {figures['worst']:+.4f}")
        yield target(f"views, first, exact, {width} px wide, over JPEG XL",
                     views["first, exact"]["bytes"] / views["peers"]["filtered"]["JPEG XL e9"], "of JPEG XL e9's bytes",
                     how="the same filtered views")


def bits_per_pixel(found):
    """{view or codec: {width: bits}}"""
    rows = {}
    for width, views in found.items():
        bits = 8 / (width * width * 3 / 4)
        for name, figures in views.items():
            if name != "peers":
                rows.setdefault(f"tarsier, {name}", {})[width] = bits * figures["bytes"]
        for what, sizes in views["peers"].items():
            for codec, size in sizes.items():
                rows.setdefault(f"{codec}, {what} view", {})[width] = bits * size
    return rows
