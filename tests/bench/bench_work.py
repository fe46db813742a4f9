"""Cortex-M4 instructions of each kind of work, exact, by the QEMU plugin tests/target/icount.c.

Instructions, not cycles: QEMU models no pipeline, no flash wait states and no cache.

SPDX-License-Identifier: Apache-2.0
"""
import sys

import jpeg_work
import work_table

HOW = "mean over the kind's measurements on the Aloe pair at 160x120 and 320x240, between two markers"
PROTOTYPE_MATCH = 12.45  # SAD 9x9, D = 32, 160x120, DSP instructions and an assembly core, of the laboratory prototype


def bench():
    measured = work_table.measure(with_data=True)
    used = work_table.emulator_table()
    targets = []
    for kind, value in work_table.measured_table(measured).items():
        targets.append({"name": kind, "value": round(value, 3), "unit": f"instructions per {work_table.KINDS[kind][1]}",
                        "target": used[kind], "met": abs(value - used[kind]) <= 0.05 * used[kind],
                        "how": f"{HOW}; target: within 5 % of the emulator's table"})
    for name, shape, rows in measured[:2]:
        value = work_table.match_per_output(shape, rows)
        small = shape[0] == 160
        targets.append({"name": f"matcher, {name}, D = {shape[2]}", "value": round(value, 2),
                        "unit": "instructions per pixel and disparity of the map",
                        "target": PROTOTYPE_MATCH if small else None,
                        "met": value <= PROTOTYPE_MATCH if small else None,
                        "how": "all instructions from start to last row; target: the hand-scheduled prototype"})
    details = {name: {work: {"units": units, "instructions": count, "per_unit": round(count / units, 3)}
                      for work, units, count in rows} for name, _, rows in measured}
    try:
        jpeg = jpeg_work.measure(with_data=True)
    except work_table.board.Missing as missing:
        print(f"tools/bench work: jpeg left out: {missing}", file=sys.stderr)
        return {"targets": targets, "details": details}
    targets += jpeg_work.targets(jpeg)
    for name, views in jpeg.items():
        details[name] |= views
    return {"targets": targets, "details": details}
