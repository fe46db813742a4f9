"""The maps' part of bench_codec.py: bytes in every way beside JPEG XL's, with priors of the other families.

SPDX-License-Identifier: Apache-2.0
"""
import statistics
import sys

import board
import codec_library
import codec_peers
import map_library
import measure_view
import numpy as np
import stereo_pairs
import vision_library
from progress import tell

RELEASE = board.SOURCE / "build/release"
STEPS = {"whole pixels": 4, "1/2 px": 3, "1/4 px": 2, "1/8 px": 1, "1/16 px": 0}
PEERS_STEPS = ("whole pixels", "1/2 px", "1/4 px")
PAIR_QUALITY = 50  # of the two JPEGs that a map stands for
PACKET_LEN = 90
NOISE_SIGMA = 1.0
SEQUENCES = 2  # objects a pair and size
# (what, step) -> most bytes over JPEG XL's of the same map, lossless
GOALS = {("one stream", "whole pixels"): 0.60, ("one stream", "1/2 px"): 0.65, ("packets of 90 B", "whole pixels"): 0.68,
         ("near-lossless", "whole pixels"): 0.33}
TEMPORAL_GOAL = 0.65
LATER_ALONE, LATER_AGAINST = "later map alone", "later map against the earlier"
LATER_HELD, LATER_LOSS = "later map held to the earlier", "later map held, loss of correct"


class Maps:
    """{(family, name, width): ...}: maps, sequences of (earlier map, later map, truth of the later one), disparities."""

    def __init__(self, folders):
        self.alone, self.sequences, self.disparities = {}, {}, {}
        rng = np.random.default_rng(7)
        for i, folder in enumerate(folders):
            for width, height, disparities in stereo_pairs.CASES:
                key = (folder.name.split("_")[0], folder.name, width)
                pair = stereo_pairs.load(folder, width, height)
                patch = stereo_pairs.load(folders[(i + 3) % len(folders)], width, height)[0]
                self.disparities[key] = disparities
                self.alone[key] = self.match(pair[0], pair[1], disparities)
                self.sequences[key] = []
                for _ in range(SEQUENCES):
                    changed = measure_view.paste(pair, patch, disparities, rng, rng.uniform(0.1, 0.3))
                    earlier, later = (self.match(*(measure_view.noisy(view, rng, NOISE_SIGMA) for view in captured[:2]),
                                                 disparities) for captured in (pair, changed))
                    self.sequences[key].append((earlier, later, changed[2]))

    def match(self, left, right, disparities):
        return vision_library.refine(vision_library.match(left, right, disparities), ("median3",))

    def quantised(self, disparity_map, key, step_log2):
        return map_library.quantise(disparity_map, self.disparities[key], step_log2)

    def families(self):
        return sorted({key[0] for key in self.alone})


def make_training_maps(data, folder):
    """As the shipped prior's."""
    board.run([sys.executable, board.SOURCE / "tools/train/map_maps.py", data, folder], timeout_s=900)


def train(training, family, work):
    """The codec with a prior learned as the shipped one, but not from this family's pictures."""
    chosen = work / family
    for kind in ("maps", "sequences"):
        (chosen / kind).mkdir(parents=True)
        for path in (training / kind).iterdir():
            if not path.name.startswith(family):
                (chosen / kind / path.name).symlink_to(path)
    source = work / f"{family}.c"
    board.run([RELEASE / "bin/tarsier", "train-prior", chosen / "maps", chosen / "sequences", "-o", source], timeout_s=900)
    return codec_library.build(source, work / f"{family}.so")


def labels_of(disparity_map, step_log2):
    """Labels from 1, 0 for no match, as other codecs get a map."""
    return np.where(disparity_map == 65535, 0, 1 + (disparity_map >> step_log2).astype(int))


def lens_of(maps, key, codec, step_log2, all_peers):
    """Bytes of one map in every way, each decoded and compared."""
    disparities = maps.disparities[key]
    quantised = maps.quantised(maps.alone[key], key, step_log2)
    stream = codec.encode(quantised, disparities, step_log2)
    packets = codec.packets(quantised, disparities, step_log2, PACKET_LEN)
    near = codec.encode(quantised, disparities, step_log2, near=1)
    seen = codec.decode(near, quantised.shape)
    valid = quantised != 65535
    assert (codec.decode(stream, quantised.shape) == quantised).all(), key
    assert (codec.decode_packets(packets[::-1], quantised.shape, disparities, step_log2) == quantised).all(), key
    assert ((seen != 65535) == valid).all() and (abs(seen.astype(int) - quantised)[valid] <= 1 << step_log2).all(), key
    result = {"one stream": stream.size, "packets of 90 B": sum(packet.size for packet in packets),
              "near-lossless": near.size}
    labels = labels_of(quantised, step_log2)
    result |= codec_peers.lossless(labels) if all_peers else {"JPEG XL e9": codec_peers.lossless_xl(labels)}
    return {**result, **later_lens(maps, key, codec, step_log2)}


def later_lens(maps, key, codec, step_log2):
    """Bytes of the later maps of its sequences alone, against the earlier and held to it; correct pixels lost by that."""
    result = dict.fromkeys((LATER_ALONE, LATER_AGAINST, LATER_HELD, LATER_LOSS), 0)
    for *captured, truth in maps.sequences[key]:
        earlier, later = (maps.quantised(one, key, step_log2) for one in captured)
        held, _ = map_library.hold(later, earlier)
        result[LATER_ALONE] += codec.encode(later, maps.disparities[key], step_log2).size
        for name, sent in ((LATER_AGAINST, later), (LATER_HELD, held)):
            data = codec.encode(sent, maps.disparities[key], step_log2, reference=earlier)
            assert (codec.decode(data, sent.shape, earlier) == sent).all(), key
            result[name] += data.size
        correct = [stereo_pairs.judge(one, truth)["correct"] for one in (later, held)]
        result[LATER_LOSS] += (correct[0] - correct[1]) / len(maps.sequences[key])
    return result


def measure(maps, codecs):
    """{(step, width): {way: mean bytes}}"""
    found = {}
    for step, step_log2 in STEPS.items():
        for width in sorted({key[2] for key in maps.alone}):
            tell(f"maps, {step}, {width} px wide")
            each = [lens_of(maps, key, codecs[key[0]], step_log2, step in PEERS_STEPS) for key in maps.alone
                    if key[2] == width]
            found[step, width] = {way: statistics.mean(one[way] for one in each) for way in each[0]}
    return found


def bits_per_pixel(found, pairs):
    """{step: {way or codec: {width: bits per pixel}}}, two gray JPEGs in the place of the map among them."""
    rows = {step: {} for step in PEERS_STEPS}
    for (step, width), lens in found.items():
        for way, size in {**lens, f"two gray JPEGs, quality {PAIR_QUALITY}": pairs[width]}.items():
            if step in rows and not way.startswith("later"):
                rows[step].setdefault(way, {})[width] = 8 * size / (width * width * 3 / 4)
    return rows


def pair_bytes(folders):
    """{width: mean bytes of both views as JPEGs}"""
    return {width: statistics.mean(sum(codec_peers.jpeg(view, PAIR_QUALITY)[0]
                                       for view in stereo_pairs.load(folder, width, height)[:2]) for folder in folders)
            for width, height, _ in stereo_pairs.CASES}


def targets(found, target):
    for step in STEPS:
        rows = {width: lens for (name, width), lens in found.items() if name == step}
        total = {way: sum(lens[way] for lens in rows.values()) for way in next(iter(rows.values()))}
        for where, lens in [*((f"{width} px wide", lens) for width, lens in rows.items()), ("both sizes", total)]:
            for way in ("one stream", "packets of 90 B", "near-lossless"):
                yield target(f"maps, {step}, {way}, {where}", lens[way] / lens["JPEG XL e9"], "of JPEG XL e9's bytes",
                             GOALS.get((way, step)) if lens is total else None,
                             "mean bytes over mean bytes, headers counted")
            for name, goal in ((LATER_HELD, TEMPORAL_GOAL), (LATER_AGAINST, None)):
                yield target(f"maps, {step}, {name}, {where}", lens[name] / lens[LATER_ALONE], "of the bytes alone",
                             goal if lens is total and step in ("whole pixels", "1/2 px") else None,
                             "an object in 10 .. 30 % of the view, noise sigma 1 in every capture")
            if lens is not total:
                yield target(f"maps, {step}, {LATER_LOSS}, {where}", lens[LATER_LOSS], "of the pixels with a truth")
        for width, lens in rows.items():
            yield target(f"maps, {step}, size, {width} px wide", 8 * lens["one stream"] / (width * width * 3 / 4),
                         "bits per pixel", how=f"JPEG XL {8 * lens['JPEG XL e9'] / (width * width * 3 / 4):.3f}")
