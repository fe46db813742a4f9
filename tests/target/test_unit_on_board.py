"""The Unity tests of tests/unit compiled for and run on the Cortex-M4.

A test that includes stdio.h or another header of files is named and left out: there are no system calls behind them.

SPDX-License-Identifier: Apache-2.0
"""
import re

import board

TIMEOUT_S = 120


def test():
    bin_folder = board.build()
    sources = sorted((board.SOURCE / "tests/unit").glob("test_*.c"))
    targets = board.run(["ninja", "-C", board.BOARD_BUILD, "-t", "targets", "all"])
    if "board_unit_" not in targets:
        raise board.Missing("Unity's sources are not there; run tools/setup test")
    failed, tests = [], 0
    for source in sources:
        target = f"board_unit_{source.stem}"
        if re.search(r"#include <(stdio|dirent|unistd|sys/\w+)\.h>", source.read_text("utf-8")):
            print(f"{source.stem}: uses files, host only")
            continue
        board.build(target)
        code, text = board.run_image(bin_folder / f"{target}.elf", timeout_s=TIMEOUT_S)
        summary = re.search(r"(\d+) Tests (\d+) Failures", text)
        if code != 0 or summary is None or summary[2] != "0" or summary[1] == "0":
            failed.append(source.stem)
            print(text)
            continue
        tests += int(summary[1])
        print(f"{source.stem}: {summary[1]} tests")
    assert not failed, f"on the board: {', '.join(failed)}"
    assert tests > 0, "no Unity test was run"


board.main("target/test_unit_on_board", test)
