"""The codecs: bytes beside those of others, what views cost of a map, instructions on a Cortex-M4, memory.

Maps are this project's matcher's (mode sad, 3x3 median) of the pairs in TSR_DATA (by default ../shared/data beside the source
tree), at 160x120 and 320x240; each is coded with a prior trained without the pictures of its own set. Views and pictures are
coded with the shipped priors. Needs python3-opencv and cjxl and djxl (libjxl-tools), which tools/setup does not install; with pillow-jpls
(pip) JPEG-LS is measured too. --table prints the codecs beside each other, for docs/performance.md.

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import shutil
import statistics
import sys
import tempfile

import work_table  # finds tests/target
import board
from progress import tell

RELEASE = board.SOURCE / "build/release"
os.environ.setdefault("TSR_BUILD", str(RELEASE))
sys.path.insert(0, str(board.SOURCE / "tests/support"))

STEPS = {"whole pixels": 4, "1/2 px": 3, "1/4 px": 2, "1/8 px": 1, "1/16 px": 0}
PEERS_STEPS = ("whole pixels", "1/2 px", "1/4 px")
PAIR_QUALITY = 50  # of the two JPEGs that a map stands for
TRAINED_STEPS = ("1", "0.5", "0.25")
PACKET_LEN = 90
NOISE_SIGMA = 1.0
SEQUENCES = 2  # objects a pair and size
# (what, step) -> most bytes over JPEG XL's of the same map, lossless
GOALS = {("one stream", "whole pixels"): 0.60, ("one stream", "1/2 px"): 0.65, ("packets of 90 B", "whole pixels"): 0.68,
         ("near-lossless", "whole pixels"): 0.33}
TEMPORAL_GOAL = 0.65
INSTRUCTIONS_GOAL = 130
STATE_GOAL, PRIOR_GOAL = 6 * 1024, 6 * 1024


def target(name, value, unit, goal=None, how=""):
    return {"name": name, "value": round(value, 4), "unit": unit, "target": goal,
            "met": None if goal is None else value <= goal, "how": how}


def build():
    board.run(["cmake", "--preset", "release", "-DTSR_TESTS=ON"], cwd=board.SOURCE)
    board.run(["cmake", "--build", RELEASE, "--target", "tarsier", "tsr_firmware"], timeout_s=900)


class Maps:
    """Every map once: {(family, name, width): map}, and sequences {(...): (earlier, later)}."""

    def __init__(self, data):
        import numpy as np
        import measure_view
        import stereo_pairs
        import vision_library
        self.np, self.vision = np, vision_library
        self.alone, self.turned, self.smooth, self.sequences, self.disparities = {}, {}, {}, {}, {}
        rng = np.random.default_rng(7)
        folders = stereo_pairs.folders(data)
        for i, folder in enumerate(folders):
            for width, height, disparities in stereo_pairs.CASES:
                key = (folder.name.split("_")[0], folder.name, width)
                pair = stereo_pairs.load(folder, width, height)
                patch = stereo_pairs.load(folders[(i + 3) % len(folders)], width, height)[0]
                self.disparities[key] = disparities
                self.alone[key] = self.match(pair[0], pair[1], disparities)
                self.turned[key] = self.match(pair[0][::-1].copy(), pair[1][::-1].copy(), disparities)
                self.smooth[key] = vision_library.refine(
                    vision_library.match(pair[0], pair[1], disparities, mode=vision_library.MODES["smooth"]),
                    ("median5", "speckle"))
                self.sequences[key] = []
                for _ in range(SEQUENCES):
                    changed = measure_view.paste(pair, patch, disparities, rng, rng.uniform(0.1, 0.3))
                    self.sequences[key].append([self.match(*(measure_view.noisy(view, rng, NOISE_SIGMA)
                                                             for view in captured[:2]), disparities)
                                                for captured in (pair, changed)])

    def match(self, left, right, disparities):
        return self.vision.refine(self.vision.match(left, right, disparities), ("median3",))

    def quantised(self, disparity_map, key, step_log2):
        import map_library
        return map_library.quantise(disparity_map, self.disparities[key], step_log2)

    def families(self):
        return sorted({key[0] for key in self.alone})


def train(maps, family, work):
    """The codec with a prior learned from the other families."""
    import codec_library
    import map_quality
    folder = work / family
    for name, kind in (("alone", maps.alone), ("turned", maps.turned), ("smooth", maps.smooth)):
        for key, disparity_map in kind.items():
            if key[0] != family:
                write_map(map_quality, folder / name / f"{key[1]}_{key[2]}.pfm", disparity_map, maps.np)
    for key, sequences in maps.sequences.items():
        for i, sequence in enumerate(sequences if key[0] != family else []):
            for j, disparity_map in enumerate(sequence):
                write_map(map_quality, folder / f"sequences/{key[1]}_{key[2]}_{i}/{j}.pfm", disparity_map, maps.np)
    source = work / f"{family}.c"
    board.run([RELEASE / "bin/tarsier", "train-prior", *sorted(folder.iterdir()), "-o", source, "--step",
               *TRAINED_STEPS], timeout_s=900)
    return codec_library.build(source, work / f"{family}.so")


def write_map(map_quality, path, disparity_map, np):
    path.parent.mkdir(parents=True, exist_ok=True)
    map_quality.write_pfm(path, np.where(disparity_map == 65535, np.inf, disparity_map / 16.0))


def labels_of(np, disparity_map, step_log2):
    """Labels from 1, 0 for no match, as other codecs get a map."""
    return np.where(disparity_map == 65535, 0, 1 + (disparity_map >> step_log2).astype(int))


def lens_of(maps, key, codec, step_log2, all_peers):
    """Bytes of one map in every way, each decoded and compared."""
    import codec_peers
    np, disparities = maps.np, maps.disparities[key]
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
    labels = labels_of(np, quantised, step_log2)
    result |= codec_peers.lossless(labels) if all_peers else {"JPEG XL e9": codec_peers.lossless_xl(labels)}
    alone = against = 0
    for earlier, later in (map(lambda one: maps.quantised(one, key, step_log2), pair) for pair in maps.sequences[key]):
        data = codec.encode(later, disparities, step_log2, reference=earlier)
        assert (codec.decode(data, later.shape, earlier) == later).all(), key
        against += data.size
        alone += codec.encode(later, disparities, step_log2).size
    return {**result, "later map alone": alone, "later map against the earlier": against}


def map_bytes(maps, codecs):
    """{(step, width): {way: mean bytes}}"""
    found = {}
    for step, step_log2 in STEPS.items():
        for width in sorted({key[2] for key in maps.alone}):
            tell(f"maps, {step}, {width} px wide")
            each = [lens_of(maps, key, codecs[key[0]], step_log2, step in PEERS_STEPS) for key in maps.alone
                    if key[2] == width]
            found[step, width] = {way: statistics.mean(one[way] for one in each) for way in each[0]}
    return found


def map_bits(found, pairs):
    """{step: {way or codec: {width: bits per pixel}}}, two gray JPEGs in the place of the map among them."""
    rows = {step: {} for step in PEERS_STEPS}
    for (step, width), lens in found.items():
        for way, size in {**lens, f"two gray JPEGs, quality {PAIR_QUALITY}": pairs[width]}.items():
            if step in rows and not way.startswith("later"):
                rows[step].setdefault(way, {})[width] = 8 * size / (width * width * 3 / 4)
    return rows


def pair_bytes(folders):
    """{width: mean bytes of both views as JPEGs}"""
    import codec_peers
    import stereo_pairs
    return {width: statistics.mean(sum(codec_peers.jpeg(view, PAIR_QUALITY)[0]
                                       for view in stereo_pairs.load(folder, width, height)[:2]) for folder in folders)
            for width, height, _ in stereo_pairs.CASES}


def map_targets(found):
    for step in STEPS:
        rows = {width: lens for (name, width), lens in found.items() if name == step}
        total = {way: sum(lens[way] for lens in rows.values()) for way in next(iter(rows.values()))}
        for where, lens in [*((f"{width} px wide", lens) for width, lens in rows.items()), ("both sizes", total)]:
            for way in ("one stream", "packets of 90 B", "near-lossless"):
                yield target(f"maps, {step}, {way}, {where}", lens[way] / lens["JPEG XL e9"], "of JPEG XL e9's bytes",
                             GOALS.get((way, step)) if lens is total else None,
                             "mean bytes over mean bytes, headers counted")
            yield target(f"maps, {step}, against the earlier map, {where}",
                         lens["later map against the earlier"] / lens["later map alone"], "of the bytes alone",
                         TEMPORAL_GOAL if lens is total and step in ("whole pixels", "1/2 px") else None,
                         "an object in 10 .. 30 % of the view, noise sigma 1 in every capture")
        for width, lens in rows.items():
            yield target(f"maps, {step}, size, {width} px wide", 8 * lens["one stream"] / (width * width * 3 / 4),
                         "bits per pixel", how=f"JPEG XL {8 * lens['JPEG XL e9'] / (width * width * 3 / 4):.3f}")


def instructions():
    cases = [(shape, work_table.per_unit(rows)) for name, shape, rows in work_table.measure(with_data=True)
             if not name.startswith("aloe ")]
    for work, name in (("map_encode_whole", "encode, whole pixels"), ("map_decode_whole", "decode, whole pixels"),
                       ("map_encode", "encode, 1/2 px"), ("map_decode", "decode, 1/2 px")):
        yield target(f"Cortex-M4, maps, {name}", statistics.mean(units[work] for _, units in cases),
                     "instructions per pixel", INSTRUCTIONS_GOAL if "whole" in work else None,
                     f"mean of {len(cases)} pairs at 160x120, QEMU plugin")
    for work in ("view_encode", "view_decode", "view_encode_next", "view_decode_next", "picture_encode", "picture_decode"):
        codec, *what = work.split("_")
        yield target(f"Cortex-M4, {codec}s, {', '.join(what)}", statistics.mean(units[work] for _, units in cases),
                     "instructions per pixel", how="views coarse, pictures of the node's step")


def memory():
    sizes = {}
    for line in board.run(["arm-none-eabi-nm", "-S", board.BOARD_BUILD / "bin/tarsier-workbench.elf"]).splitlines():
        words = line.split()
        if len(words) == 4:
            sizes[words[3]] = int(words[1], 16)
    for width in (160, 320):
        scratch = 2 * 3 * (width + 5)
        yield target(f"RAM, maps, {width} px wide", max(sizes["map_encoder"], sizes["map_decoder"]) + scratch, "B",
                     STATE_GOAL, "state and rows of labels")
    yield target("flash, the maps' prior", sizes["tsr_map_prior"] + sizes["tsr_map_reference_prior"], "B", PRIOR_GOAL,
                 "alone and near-lossless, and against a reference")


def table(result):
    import codec_table
    return codec_table.table(result)


def bench():
    data = pathlib.Path(os.environ.get("TSR_DATA", board.SOURCE.parent / "shared/data"))
    if not any(data.glob("mb*")):
        raise board.BoardError(f"{data}: no pairs (mb*/)")
    if shutil.which("cjxl") is None or shutil.which("djxl") is None:
        raise board.BoardError("cjxl, djxl: not installed (package libjxl-tools)")
    tell("build")
    build()
    import codec_pictures
    import codec_views
    import stereo_pairs
    folders = stereo_pairs.folders(data)
    views, pictures = codec_views.measure(folders), codec_pictures.measure(folders)
    tell("match")
    maps = Maps(data)
    with tempfile.TemporaryDirectory() as name:
        codecs = {}
        for family in maps.families():
            tell(f"train without {family}")
            codecs[family] = train(maps, family, pathlib.Path(name))
        found = map_bytes(maps, codecs)
    tell("instructions")
    return {"targets": [*map_targets(found), *codec_views.targets(views, target), *codec_pictures.targets(pictures, target),
                        *instructions(), *memory()],
            "details": {"mean_bytes": {f"{step}, {width}": lens for (step, width), lens in found.items()}, "views": views,
                        "bits_per_pixel": {"maps": map_bits(found, pair_bytes(folders)),
                                           "views": codec_views.bits_per_pixel(views),
                                           "pictures": codec_pictures.bits_per_pixel(pictures)}}}
