"""The matcher's kernels on Cortex-M4 (DSP) and Cortex-M55 (MVE, DSP) against the portable one, and on the M55 the
matcher's unit tests, which test_unit_on_board.py runs on the M4.

SPDX-License-Identifier: Apache-2.0
"""
import re

import board

KERNELS = "test_vision_kernels"
# Board -> the kernels it must have, and what to run there.
BOARDS = {board.DEFAULT: (("dsp",), (KERNELS,)),
          board.M55: (("mve", "dsp"), (KERNELS, "test_vision_match", "test_vision_smooth"))}
TIMEOUT_S = 600


def test():
    board.need_tools()
    if not (board.UNITY / "src/unity.c").exists():
        raise board.Missing(f"no Unity sources in {board.UNITY}; run tools/setup test")
    for machine, (kernels, names) in BOARDS.items():
        bin_folder = board.build(*(f"board_unit_{name}" for name in names), machine=machine)
        for name in names:
            code, text = board.run_image(bin_folder / f"board_unit_{name}.elf", timeout_s=TIMEOUT_S, machine=machine)
            summary = re.search(r"(\d+) Tests (\d+) Failures", text)
            assert code == 0 and summary is not None and summary[2] == "0" and summary[1] != "0", \
                f"{machine}, {name}: {text}"
            missing = [kernel for kernel in kernels if name == KERNELS and f", {kernel}" not in text]
            assert not missing, f"{machine}, {name}: does not run {', '.join(missing)}: {text}"
            print(f"{machine}, {name}: {summary[1]} tests")


board.main("target/test_kernels_cortex_m", test)
