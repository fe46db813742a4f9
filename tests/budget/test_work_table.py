"""The emulator's table of instructions per unit of work is what the Cortex-M4 needs, within 5 %.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "bench"))
import jpeg_work  # noqa: E402
import work_table  # noqa: E402
from work_table import board  # noqa: E402

TOLERANCE = 0.05


def test():
    measured, used = work_table.measured_table(work_table.measure()), work_table.emulator_table()
    try:
        measured["jpeg"] = next(jpeg_work.targets(jpeg_work.measure()))["value"]
        used["jpeg"] = work_table.emulator_jpeg()
    except board.Missing as missing:
        print(f"jpeg not compared: {missing}")
    for kind, value in measured.items():
        print(f"{kind:12} {value:9.3f} measured, {used[kind]:7g} in the emulator")
    far = [kind for kind, value in measured.items() if abs(value - used[kind]) > TOLERANCE * value]
    line = ", ".join(f"{value:.3g}" for value in measured.values())
    assert not far, f"the emulator's table differs in {', '.join(far)}; measured: {{0, {line}}}"


board.main("budget/test_work_table", test)
