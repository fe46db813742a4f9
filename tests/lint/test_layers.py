"""Layers include downward only, whatever the include paths would allow."""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import re
import sys

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)

# Folder -> modules of tsr/<module>/ it may include; docs/architecture.md has the same table.
FIRMWARE = {"base", "vision", "codec", "wire", "net", "node"}
RULES = {
    "firmware/base": {"base"},
    "firmware/vision": {"vision", "base"},
    "firmware/codec": {"codec", "base"},
    "firmware/wire": {"wire", "base"},
    "firmware/net": {"net", "base", "wire", "hal"},
    "firmware/node": FIRMWARE | {"hal"},
    "firmware/app": FIRMWARE | {"hal"},
    "hal/include": {"hal", "base"},
    "hal/recorded": {"hal", "base", "host"},
    "hal/air": {"hal", "base"},
    "hal/mps2": {"hal", "base"},
    "tools/host": {"host", "base", "vision", "codec", "wire"},
    "tools/scene": {"scene", "base", "host"},
    "tools/scenario": {"scenario", "scene", "host", "base"},
    "tools/tarsier": {"stage", "stereo", "coding", "scenario", "scene", "host", "base", "codec", "wire", "vision"},
    "tools/train": {"codec", "base", "vision"},
    "emulator": {"emulator", "node", "hal", "scenario", "scene", "host", "base", "wire"},
    "sink": {"sink", "host", "base", "codec", "wire"},
}
# What freestanding C11 and a small libc give; the firmware needs no more.
FIRMWARE_SYSTEM = {"stdbool.h", "stddef.h", "stdint.h", "string.h", "limits.h"}
# The intrinsics of an instruction set, in its kernels or vector operations.
INTRINSICS = re.compile(r"firmware/vision/(match_mve_\w+\.[ch]: arm_(mve|acle)|change_sse2\.h: emmintrin|vector_(sse2|avx2|neon)\.h: (emmintrin|immintrin|arm_neon))\.h")
# Shared headers that hold another layer's subject would hide an upward include.
HAL_BACKENDS = {"hal/recorded": "recorded", "hal/air": "air", "hal/mps2": "mps2"}


def rule_of(file):
    path = file.relative_to(SOURCE).as_posix()
    for folder, allowed in RULES.items():
        if path.startswith(folder + "/"):
            return folder, allowed
    return None, None


def faults_of(file):
    folder, allowed = rule_of(file)
    if folder is None:
        yield f"{file.relative_to(SOURCE)}: no layer owns this folder"
        return
    for bracket, name in INCLUDE.findall(file.read_text()):
        if name.startswith("tsr/"):
            module = name.split("/")[1]
            if module not in allowed:
                yield f"{file.relative_to(SOURCE)}: {folder} may not include {name}"
        elif folder.startswith("firmware/") and folder != "firmware/app" and bracket == "<":
            if name not in FIRMWARE_SYSTEM and not INTRINSICS.fullmatch(f"{file.relative_to(SOURCE)}: {name}"):
                yield f"{file.relative_to(SOURCE)}: firmware may not include <{name}>"


files = [file for top in ("firmware", "hal", "tools", "emulator", "sink")
         for ending in ("*.c", "*.h", "*.cpp") for file in sorted((SOURCE / top).rglob(ending))]
faults = [fault for file in files for fault in faults_of(file)]
print("\n".join(faults) or f"{len(files)} files keep to their layers")
sys.exit(1 if faults or len(files) < 50 else 0)
