"""The matcher's kernels compiled for AArch64: NEON gives the portable kernel's bits. Runs in QEMU's user mode.

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import re
import shutil
import tempfile

import board

COMPILER = "aarch64-linux-gnu-gcc"
EMULATOR = "qemu-aarch64"
UNITY = pathlib.Path(os.environ.get("UNITY_DIR") or board.SOURCE / ".deps/unity")
TIMEOUT_S = 300


def test():
    for tool in (COMPILER, EMULATOR):
        if shutil.which(tool) is None:
            raise board.Missing(f"{tool} is not installed")
    if not (UNITY / "src/unity.c").exists():
        raise board.Missing(f"no Unity sources in {UNITY}; run tools/setup test")
    layers = [board.SOURCE / "firmware" / layer for layer in ("base", "vision")]
    sources = [source for layer in layers for source in sorted(layer.glob("*.c"))]
    sources += [board.SOURCE / "tests/property/test_vision_kernels.c", UNITY / "src/unity.c"]
    includes = [f"-I{layer / 'include'}" for layer in layers] + [f"-I{UNITY / 'src'}"]
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder, "kernels")
        board.run([COMPILER, "-std=c11", "-O2", "-ffp-contract=off", "-fno-strict-aliasing", "-static", *includes,
                   *sources, "-o", program])
        text = board.run([EMULATOR, program], timeout_s=TIMEOUT_S)
    print(text)
    assert re.search(r"replay: .*\bneon\b", text), "the NEON kernel was not among those that ran"
    summary = re.search(r"(\d+) Tests 0 Failures", text)
    assert summary is not None and summary[1] != "0", "no test was run"


board.main("target/test_kernels_aarch64", test)
