"""From what a codec's contexts are asked to the prior with which that costs the fewest bits.

For picture_prior.py, view_prior.py and packet_prior.py. Needs a C compiler and NumPy.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import pathlib
import subprocess
import sys

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
TRAIN = ROOT / "tools/train"
CODEC = ROOT / "firmware/codec"
LAYERS = ("base", "codec", "vision")
BITS_MAX = 1 << 22


def build(folder, traced, plain, trace):
    """A library: the traced sources and what they share with their questions recorded, trace, and plain ones."""
    includes = [f"-I{TRAIN}", *(f"-I{ROOT}/firmware/{layer}/include" for layer in LAYERS)]
    compile_one = ["cc", "-O2", "-fPIC", "-std=c11", *includes, "-c"]
    shared = (CODEC / "range_port.c", CODEC / "frame.c", *CODEC.glob("packet*.c"))
    for source in (*traced, *shared):
        subprocess.run([*compile_one, "-Dtsr_range_encode_bit=prior_trace_bit", source], cwd=folder, check=True)
    for source in (*plain, CODEC / "range.c", *(ROOT / "firmware/base").glob("*.c"), TRAIN / "prior_trace.c", trace):
        subprocess.run([*compile_one, source], cwd=folder, check=True)
    subprocess.run(["cc", "-shared", "-o", "trace.so", *folder.glob("*.o"), "-lm"], cwd=folder, check=True)
    library = ctypes.CDLL(str(folder / "trace.so"))
    library.prior_fit.restype = ctypes.c_uint16
    library.prior_trace_count.restype = ctypes.c_size_t
    return library


def trace(function, picture, *arguments):
    """Calls it with the picture and the arguments; what was asked: 2 * context + bit, in order."""
    asked, count = np.zeros(BITS_MAX, np.uint32), ctypes.c_size_t()
    height, width = picture.shape
    function.restype = ctypes.c_size_t
    if not function(picture.ctypes.data_as(ctypes.c_void_p), width, height, *arguments,
                    asked.ctypes.data_as(ctypes.c_void_p), ctypes.c_size_t(BITS_MAX), ctypes.byref(count)):
        sys.exit("the codec refused a picture")
    return asked[:count.value].copy()


def fit(library, asked_of, context_count):
    """The prior of each context, and what it costs in bits."""
    by_context = []
    for asked in asked_of:
        order = np.argsort(asked >> 1, kind="stable")
        by_context.append(((asked[order] & 1).astype(np.uint8),
                           np.searchsorted(asked[order] >> 1, np.arange(context_count + 1))))
    prior, total, cost = [], 0.0, ctypes.c_double()
    for context in range(context_count):
        parts = [bits[at[context]:at[context + 1]] for bits, at in by_context]
        parts = [part for part in parts if len(part)]
        bits = np.concatenate([*parts, np.zeros(1, np.uint8)])
        begins = np.cumsum([0, *map(len, parts)]).astype(np.uintp)
        prior.append(library.prior_fit(bits.ctypes.data_as(ctypes.c_void_p), begins.ctypes.data_as(ctypes.c_void_p),
                                       ctypes.c_size_t(len(parts)), ctypes.byref(cost)) if parts else 0x8000)
        total += cost.value if parts else 0
    return prior, total


def rows_of(prior, indent=4):
    rows = [", ".join(f"0x{value:04x}" for value in prior[i:i + 14]) for i in range(0, len(prior), 14)]
    return (",\n" + " " * indent).join(rows)


def source(body, comment, header, name):
    """C source; name is the array with its size."""
    return (f"/*\n{comment} *\n * SPDX-License-Identifier: Apache-2.0\n */\n#include \"{header}\"\n\n"
            f"const uint16_t {name} = {{\n    {body}}};\n")


def table(prior, comment, header, name):
    return source(rows_of(prior), comment, header, name)
