"""The program in docs/library.md compiles with the firmware's sources and prints what the page says.

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
page = (SOURCE / "docs/library.md").read_text("utf-8")
program = re.search(r"```c\n(.*?)```", page, re.DOTALL)[1]
promised = re.search(r"It prints `([^`]*)`", page)[1]
with tempfile.TemporaryDirectory() as folder:
    source, binary = pathlib.Path(folder) / "example.c", pathlib.Path(folder) / "example"
    source.write_text(program, "utf-8")
    command = ["cc", "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{SOURCE}/firmware/vision/include",
               f"-I{SOURCE}/firmware/base/include", "-o", binary, source, BUILD / "firmware/libtsr_vision.a",
               BUILD / "firmware/libtsr_base.a"]
    built = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=60)
    if built.returncode != 0:
        sys.exit(f"docs/library.md does not compile: {built.stderr}")
    printed = subprocess.run([str(binary)], capture_output=True, text=True, timeout=10).stdout.strip()
    if printed != promised:
        sys.exit(f"docs/library.md promises '{promised}', the program prints '{printed}'")
print(f"docs/library.md: {printed}")
