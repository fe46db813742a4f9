#!/usr/bin/env python3
"""Train what the contexts of packets start from, and write firmware/codec/{gray,view}_packet_prior.c.

    TSR_BUILD=build/release packet_prior.py DATA [--without PREFIX]

The pictures are those of picture_prior.py. Each is sent in packets of PACKET_LEN bytes, once in each of the ways of KINDS;
what each context is asked in one packet is one stream of bits, every EVERY-th packet counts. The prior of a context is the
pair of probability and count that codes its streams in the fewest bits. --without leaves out the pictures whose
folder's name begins so, to measure on them. Packets are cut where the present prior fills them, so training again ends at
slightly other numbers. Needs a C compiler, NumPy and OpenCV.

SPDX-License-Identifier: Apache-2.0
"""
import argparse
import ctypes
import pathlib
import sys
import tempfile

import numpy as np

import picture_prior
import prior_training
from prior_training import CODEC, TRAIN

sys.path.insert(0, str(prior_training.ROOT / "tests/support"))
import packet_library  # noqa: E402
import view_library  # noqa: E402

PACKET_LEN = 90
EVERY = 5
BITS_MAX = 1 << 20
CONTEXTS = {"gray": 243, "view": 392}
# Each table and what it is trained on: nears of gray images; cap and coarseness of views.
KINDS = {"gray": ([(0,)], [(1,), (2,), (4,)], [(8,)]), "view": ([(7, False), (5, False)], [(7, True)])}


def streams(library, name, picture, how):
    """What is asked in each packet that counts."""
    if name == "view":
        picture = view_library.prefilter(picture, how[0])
    sender = packet_library.Sender(library, name, picture, how)
    contexts_of = getattr(library, f"prior_trace_{name}_contexts")
    contexts_of.restype = packet_library.ANY
    contexts = packet_library.ANY(contexts_of(packet_library.pointer(sender.state)))
    trace, result = np.zeros(BITS_MAX, np.uint32), []
    while sender.more:
        library.prior_trace_start(contexts, packet_library.pointer(trace), ctypes.c_size_t(trace.size))
        sender.next(PACKET_LEN)
        result.append(trace[:library.prior_trace_count()].copy())
    return result[::EVERY]


def table(name, priors):
    """The C file."""
    what = {"gray": "gray images: lossless, of one near, by activity", "view": "prefiltered views: exact, coarse"}[name]
    comment = f" * What the contexts of packets start from, of {what}.\n * tools/train/packet_prior.py writes this file.\n"
    body = ",\n    ".join(f"{{{prior_training.rows_of(prior, 5)}}}" for prior in priors)
    array = f"tsr_{name}_packet_prior[{len(priors)}][TSR_{name.upper()}_CONTEXT_COUNT]"
    return prior_training.source(f"{body},\n", comment, f"{name}_row.h", array)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--without", default="", metavar="PREFIX")
    arguments = parser.parse_args()
    pictures = list(picture_prior.pictures(arguments.data, arguments.without))
    with tempfile.TemporaryDirectory() as folder:
        traced = (path for name in KINDS for path in CODEC.glob(f"{name}*.c"))
        library = prior_training.build(pathlib.Path(folder), traced, (), TRAIN / "packet_trace.c")
        for name, tables in KINDS.items():
            priors = []
            for ways in tables:
                asked = [one for picture in pictures for how in ways for one in streams(library, name, picture, how)]
                prior, cost = prior_training.fit(library, asked, CONTEXTS[name])
                print(f"{name} {ways}: {len(asked)} packets, {sum(map(len, asked))} adaptive bits, coded in {cost:.0f}")
                priors.append(prior)
            (CODEC / f"{name}_packet_prior.c").write_text(table(name, priors), "utf-8")


if __name__ == "__main__":
    main()
