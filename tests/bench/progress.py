"""What a benchmark is doing, for who watches a terminal. Not a benchmark by itself.

SPDX-License-Identifier: Apache-2.0
"""
import sys


def tell(what):
    """Replaces the line told before; an empty one clears it."""
    if sys.stderr.isatty():
        print(f"\r\033[K{what}", end="", file=sys.stderr, flush=True)
