"""docs/memory.md shows what is measured: the same tables, every number within 5 %.

SPDX-License-Identifier: Apache-2.0
"""
import memory_report
from footprint import board


def test():
    different = memory_report.differences(memory_report.documented(), memory_report.tables())
    assert not different, ("docs/memory.md is old; run python3 tests/budget/memory_report.py --write\n" +
                           "\n".join(different))


board.main("budget/test_memory_document", test)
