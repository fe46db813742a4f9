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

INSTRUCTIONS_GOAL = 130
STATE_GOAL, PRIOR_GOAL = 6 * 1024, 6 * 1024


def target(name, value, unit, goal=None, how=""):
    return {"name": name, "value": round(value, 4), "unit": unit, "target": goal,
            "met": None if goal is None else value <= goal, "how": how}


def build():
    board.run(["cmake", "--preset", "release", "-DTSR_TESTS=ON"], cwd=board.SOURCE)
    board.run(["cmake", "--build", RELEASE, "--target", "tarsier", "tsr_firmware"], timeout_s=900)


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


def measure_maps(data, folders):
    import codec_maps
    tell("match")
    maps = codec_maps.Maps(folders)
    with tempfile.TemporaryDirectory() as name:
        work, codecs = pathlib.Path(name), {}
        codec_maps.make_training_maps(data, work / "training")
        for family in maps.families():
            tell(f"train without {family}")
            codecs[family] = codec_maps.train(work / "training", family, work)
        return codec_maps.measure(maps, codecs)


def bench():
    data = pathlib.Path(os.environ.get("TSR_DATA", board.SOURCE.parent / "shared/data"))
    if not any(data.glob("mb*")):
        raise board.BoardError(f"{data}: no pairs (mb*/)")
    if shutil.which("cjxl") is None or shutil.which("djxl") is None:
        raise board.BoardError("cjxl, djxl: not installed (package libjxl-tools)")
    tell("build")
    build()
    import codec_maps
    import codec_pictures
    import codec_views
    import stereo_pairs
    folders = stereo_pairs.folders(data)
    views, pictures = codec_views.measure(folders), codec_pictures.measure(folders)
    found = measure_maps(data, folders)
    tell("instructions")
    return {"targets": [*codec_maps.targets(found, target), *codec_views.targets(views, target),
                        *codec_pictures.targets(pictures, target), *instructions(), *memory()],
            "details": {"mean_bytes": {f"{step}, {width}": lens for (step, width), lens in found.items()}, "views": views,
                        "bits_per_pixel": {"maps": codec_maps.bits_per_pixel(found, codec_maps.pair_bytes(folders)),
                                           "views": codec_views.bits_per_pixel(views),
                                           "pictures": codec_pictures.bits_per_pixel(pictures)}}}
