"""The matcher on the Cortex-M55 with MVE: the kernels against the portable one, and the matcher's unit tests.

SPDX-License-Identifier: Apache-2.0
"""
import re

import board

NAMES = ("test_vision_kernels", "test_vision_match", "test_vision_smooth")
TIMEOUT_S = 600


def test():
    board.need_tools()
    if not (board.UNITY / "src/unity.c").exists():
        raise board.Missing(f"no Unity sources in {board.UNITY}; run tools/setup test")
    bin_folder = board.build(*(f"board_unit_{name}" for name in NAMES), machine=board.M55)
    for name in NAMES:
        code, text = board.run_image(bin_folder / f"board_unit_{name}.elf", timeout_s=TIMEOUT_S, machine=board.M55)
        summary = re.search(r"(\d+) Tests (\d+) Failures", text)
        assert code == 0 and summary is not None and summary[2] == "0" and summary[1] != "0", f"{name}: {text}"
        assert name != "test_vision_kernels" or ", mve" in text, f"{name} does not run the kernel mve: {text}"
        print(f"{name}: {summary[1]} tests")


board.main("target/test_kernels_m55", test)
