"""What tarsier-node.elf may be made of, and how large: no allocation, no floating point, no printf, no recursion, limits.

SPDX-License-Identifier: Apache-2.0
"""
import re
import subprocess
import tempfile

import footprint
from footprint import board
import memory_report
import site_run

# Limits of a lead, 160x120 and 32 disparities, with AES in software.
FLASH_MAX = 64 * 1024
RAM_MAX = 128 * 1024  # with the stack; the linker script refuses more
STACK_SPARE_MIN = 1024  # left of the reserved stack below the call graph's bound, for a board's interrupts
NODE_MAX = 6 * 1024  # struct tsr_node

FORBIDDEN_SYMBOLS = {
    "allocation": r"_?(malloc|free|calloc|realloc|sbrk|memalign)(_r)?",
    "floating point": r"__aeabi_(f|d|cf|cd|i2[fd]|ui2[fd]|l2[fd]|ul2[fd])\w*|__(add|sub|mul|div|fix|float)\w*[sd]f\w*",
    "formatted output": r"_?(v|s|sn|vsn|f|vf|i|si|sni|fi)*printf(_r)?",
}
FLOAT_INSTRUCTION = re.compile(r"\tv(add|sub|mul|div|mla|mls|fma|fms|neg|abs|sqrt|cmp|cvt)\w*\.(f|s|u)\d")


def check_symbols(image):
    symbols = [line.split()[-1] for line in board.run(["arm-none-eabi-nm", image]).splitlines()]
    assert "tsr_node_step" in symbols and "mbedtls_internal_aes_encrypt" in symbols, "the image is not the node"
    for what, pattern in FORBIDDEN_SYMBOLS.items():
        found = sorted(symbol for symbol in symbols if re.fullmatch(pattern, symbol))
        assert not found, f"{what} is linked: {', '.join(found)}"
    code = board.run(["arm-none-eabi-objdump", "-d", "--no-show-raw-insn", image])
    floats = sorted({line.strip() for line in code.splitlines() if FLOAT_INSTRUCTION.search(line)})
    assert not floats, f"floating-point instructions: {floats[:3]}"
    print(f"{len(symbols)} symbols: no allocation, no floating point, no formatted output")


def check_limits(bin_folder):
    totals = footprint.totals(bin_folder)
    bound, chain = footprint.stack_bound()
    _, types = memory_report.plans()
    with tempfile.TemporaryDirectory(prefix="tsr") as work:
        painted = site_run.run(work)[0]["stack_used"]
    print(memory_report.footprint_tables(bin_folder, painted))
    assert totals["flash"] <= FLASH_MAX, f"flash: {totals['flash']} of {FLASH_MAX} bytes"
    assert totals["ram"] <= RAM_MAX, f"RAM: {totals['ram']} of {RAM_MAX} bytes"
    assert bound + STACK_SPARE_MIN <= totals["stack"], f"stack: {bound} of {totals['stack']} bytes: {chain}"
    assert painted <= bound, f"stack: {painted} bytes used, but the call graph says {bound}: it misses a call"
    assert types["tsr_node"] <= NODE_MAX, f"struct tsr_node: {types['tsr_node']} of {NODE_MAX} bytes"


def check_linker_refuses(ram):
    """With less RAM than it needs the image does not link: the limit in the linker script works."""
    command = board.run(["ninja", "-C", board.BOARD_BUILD, "-t", "commands", footprint.IMAGE]).splitlines()[-1]
    with tempfile.TemporaryDirectory() as work:
        smaller, changes = re.subn(r"tsr_ram_len=\w+", f"tsr_ram_len={ram - 1}", command)
        smaller = re.sub(r"-o \S+", f"-o {work}/small.elf", re.sub(r"-Map=\S+", f"-Map={work}/small.map", smaller))
        assert changes == 1, f"no RAM limit in: {command}"
        done = subprocess.run(["sh", "-c", smaller], cwd=board.BOARD_BUILD, capture_output=True, text=True, timeout=60,
                              check=False)
    assert done.returncode != 0 and "overflowed" in done.stderr, f"it links with {ram - 1} bytes of RAM: {done.stderr}"


def test():
    bin_folder = board.build()
    check_symbols(bin_folder / f"{footprint.IMAGE}.elf")
    check_limits(bin_folder)
    check_linker_refuses(footprint.totals(bin_folder)["ram"])


board.main("budget/test_image", test)
