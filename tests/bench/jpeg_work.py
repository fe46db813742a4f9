"""Instructions and bytes of a view as JPEG on the Cortex-M4, tests/target/jpeg. Not a benchmark by itself.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import tempfile

import work_table
from work_table import board, mean

SCAN = 0xDA  # ITU-T T.81, table B.1: behind this segment the picture's bits begin
END_LEN = 2  # EOI
SIDES = ("left", "right")


def header_len(data):
    """Bytes of a JPEG file that are not the picture's: markers, tables and the end."""
    at = 2
    while data[at + 1] != SCAN:
        at += 2 + int.from_bytes(data[at + 2:at + 4], "big")
    return at + 2 + int.from_bytes(data[at + 2:at + 4], "big") + END_LEN


def read_view(folder, side, rows):
    units, instructions = next((units, instructions) for work, units, instructions in rows if work == f"jpeg_{side}")
    data = (pathlib.Path(folder) / f"{side}.jpg").read_bytes()
    return {"units": units, "instructions": instructions, "per_unit": round(instructions / units, 3),
            "bytes": len(data), "header_bytes": header_len(data)}


def measure(with_data=False):
    """{case: {jpeg_left, jpeg_right: what it takes}} of the cases of work_table.measure()."""
    board.need_libjpeg()
    image = board.build("tarsier-jpeg") / "tarsier-jpeg.elf"
    found = {}
    with tempfile.TemporaryDirectory() as work:
        for name, folder, shape in work_table.cases(work, with_data):
            rows = work_table.count(name, image, shape, folder)
            found[name] = {f"jpeg_{side}": read_view(folder, side, rows) for side in SIDES}
    return found


def targets(measured):
    """The mean over the views of Aloe, as in the table of the other kinds, and the range over all."""
    def values(begin):
        return [view["instructions"] / view["units"] for name, views in measured.items() if name.startswith(begin)
                for view in views.values()]
    how = "whole JPEG files, gray, quality 50, libjpeg-turbo's portable C with -O2"
    for name, value, over in (("jpeg", mean(values("aloe ")), "mean over the views of Aloe in both sizes"),
                              ("jpeg, smallest", min(values("")), "of all views in details"),
                              ("jpeg, largest", max(values("")), "of all views in details")):
        yield {"name": name, "value": round(value, 3), "unit": "instructions per pixel of a view", "target": None,
               "met": None, "how": f"{how}; {over}"}
