"""The programs in docs/library.md compile with the firmware's sources and print what the page says.

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
BUILD = pathlib.Path(os.environ.get("TSR_BUILD", SOURCE / "build/release"))
LAYERS = ("vision", "codec", "base")  # upper ones first, for the linker


def check(program, promised):
    with tempfile.TemporaryDirectory() as folder:
        source, binary = pathlib.Path(folder) / "example.c", pathlib.Path(folder) / "example"
        source.write_text(program, "utf-8")
        command = ["cc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror",
                   *(f"-I{SOURCE}/firmware/{layer}/include" for layer in LAYERS), "-o", binary, source,
                   *(BUILD / f"firmware/libtsr_{layer}.a" for layer in LAYERS)]
        built = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=60)
        if built.returncode != 0:
            sys.exit(f"docs/library.md does not compile: {built.stderr}")
        done = subprocess.run([str(binary)], capture_output=True, text=True, timeout=10)
        if done.stdout.strip() != promised or done.returncode != 0:
            sys.exit(f"docs/library.md promises '{promised}', the program prints '{done.stdout.strip()}'")
    print(f"docs/library.md: {promised}")


page = (SOURCE / "docs/library.md").read_text("utf-8")
programs, promises = re.findall(r"```c\n(.*?)```", page, re.DOTALL), re.findall(r"It prints `([^`]*)`", page)
if len(programs) != 2 or len(promises) != 2:
    sys.exit(f"docs/library.md: {len(programs)} programs and {len(promises)} promises, expected 2")
for one in zip(programs, promises):
    check(*one)
