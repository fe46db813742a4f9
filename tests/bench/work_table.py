"""Measured instructions per unit of work, and the emulator's table of them. Not a benchmark by itself.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import re
import sys
import tempfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/target"))
import board  # noqa: E402
import pictures  # noqa: E402

ENERGY_SOURCE = SOURCE / "emulator/src/energy.cpp"
BASELINE_SOURCE = SOURCE / "emulator/include/tsr/emulator/baseline.h"
CALIBRATION_TURNS = {"calibration_1000": 1000, "calibration_2000": 2000}

# The kinds of enum tsr_work_kind in its order, the workbench's measurements whose mean each is, and the unit.
KINDS = {
    "change": (("change_still",), "pixel"),
    "match": (("match",), "row of work x width x disparity"),
    "median": (("median",), "pixel"),
    "measure": (("zone",), "pixel"),
    "compare": (("quantise", "similarity"), "pixel"),
    "map_encode": (("map_encode",), "pixel"),
    "view_filter": (("view_prefilter", "view_compare"), "pixel"),
    "view_encode": (("view_encode",), "pixel"),
    "reference_encode": (("picture_encode",), "pixel"),
    "view_decode": (("view_decode",), "pixel"),
    "seal": (("seal_message", "open_message", "seal_frame", "open_frame"), "byte"),
    "copy": (("copy",), "byte"),
}


def cases(work, with_data):
    """Aloe in both sizes, and TSR_DATA's pairs if asked, below the folder work."""
    return pictures.aloe_cases(work) + (pictures.data_cases(work) if with_data else [])


def count(name, image, shape, folder, machine=board.DEFAULT):
    """[(work, units, instructions)] of one case, by a counter that counts."""
    rows = board.count_work(image, shape, folder, machine=machine)
    counts = {work: instructions for work, _, instructions in rows if work in CALIBRATION_TURNS}
    if counts["calibration_2000"] - counts["calibration_1000"] != 1000:
        raise board.BoardError(f"{name}: the counter does not count: {counts}")
    return rows


def measure(with_data=False, machine=board.DEFAULT):
    """[(case, shape, [(work, units, instructions)])] of Aloe in both sizes, and of TSR_DATA's pairs if asked."""
    image = board.build("tarsier-workbench", machine=machine) / "tarsier-workbench.elf"
    with tempfile.TemporaryDirectory() as work:
        return [(name, shape, count(name, image, shape, folder, machine))
                for name, folder, shape in cases(work, with_data)]


def per_unit(rows):
    return {work: count / units for work, units, count in rows if work not in CALIBRATION_TURNS}


def mean(values):
    values = list(values)
    return sum(values) / len(values)


def measured_table(measured):
    """{kind: instructions per unit}, the mean over the kind's measurements and the Aloe cases."""
    cases = [per_unit(rows) for name, _, rows in measured if name.startswith("aloe ")]
    return {kind: mean(case[work] for case in cases for work in works) for kind, (works, _) in KINDS.items()}


def emulator_table():
    """{kind: instructions per unit} of emulator/src/energy.cpp."""
    numbers = re.search(r"kInstructions = \{([^}]*)\}", ENERGY_SOURCE.read_text("utf-8"))
    values = [float(value) for value in numbers[1].split(",")]
    if len(values) != len(KINDS) + 1 or values[0] != 0:
        raise board.BoardError(f"{ENERGY_SOURCE}: the table does not have the kinds of work that are measured")
    return dict(zip(KINDS, values[1:]))


def emulator_jpeg():
    """Instructions per pixel of baseline nodes."""
    return float(re.search(r"kInstructionsPerPixel = ([0-9.]+)", BASELINE_SOURCE.read_text("utf-8"))[1])


def match_per_output(shape, rows, work="match"):
    """Instructions per pixel and disparity of the map, prefilter and warm-up rows included."""
    width, height, disparities = shape
    return next(count for name, _, count in rows if name == work) / (width * height * disparities)
