"""The whole chain with the firmware on the Cortex-M4: a lead, its wing and a gateway in QEMU, UART0 to a real sink.

The lead watches, wakes its wing, gets its view, matches, codes, seals and sends; the sink must have committed a map
that equals, pixel for pixel, what the host computes from the same two pictures, and have exported it restored.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import sqlite3
import struct
import sys
import tempfile

import board
import pictures
import site_run

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import codec_decoder  # noqa: E402

SHAPE = pictures.SIZES["160x120"]
INVALID_Q4 = 0xffff
STEP_LOG2 = 3  # of firmware/app/mps2_an386.c and of the workbench


def expected_map(work):
    """What the host makes of the same pictures, the right one as the wing sends it."""
    host = board.build_on_host("workbench-host")
    left, right = (pictures.read_pgm(path)[2] for path in site_run.views(work / "scene"))
    folder = pictures.write_case(work / "host", bytes(len(left)), left, right)
    board.run([host, *SHAPE], cwd=folder)
    data = (folder / "lead_map.out").read_bytes()
    return list(struct.unpack(f"<{len(data) // 2}H", data))


def stored_map(work):
    """The disparities that the sink has committed."""
    (coded,), = sqlite3.connect(work / "sink.db").execute("SELECT coded_map FROM map").fetchall()
    decoder, rows = codec_decoder.decode_map(coded)
    assert decoder.step_log2 == STEP_LOG2, decoder.step_log2
    return [value for row in rows for value in row]


def restored(stored):
    """What the sink exports of it, px."""
    import numpy
    import restore_reference
    rows = numpy.array(stored, numpy.uint16).reshape(SHAPE[1], SHAPE[0])
    values = restore_reference.restore(rows, STEP_LOG2).ravel().tolist()
    return [float("inf") if value == INVALID_Q4 else value / 16 for value in values]


def test():
    with tempfile.TemporaryDirectory(prefix="tsr") as folder:
        work = pathlib.Path(folder)
        counters, maps = site_run.run(work)
        print(counters)
        assert len(maps) == 1, f"the sink has {len(maps)} maps"
        assert counters["maps_sent"] == 1
        found, expected = stored_map(work), expected_map(work)
        different = sum(a != b for a, b in zip(found, expected))
        valid = sum(value != INVALID_Q4 for value in expected)
        assert len(found) == len(expected) and different == 0, f"{different} pixels differ"
        assert site_run.read_pfm(maps[0]) == restored(found), "the exported map is not the restored one"
        assert valid > len(expected) // 2, "too few pixels have a disparity: the pictures test nothing"
        print(f"one map of {len(found)} pixels, {valid} with a disparity, equal")


board.main("target/test_node_to_sink", test)
