"""The measured tables of docs/memory.md. Not a test.

  python3 tests/budget/memory_report.py            print them
  python3 tests/budget/memory_report.py --write    put them into docs/memory.md, between its two marks

SPDX-License-Identifier: Apache-2.0
"""
import re
import sys
import tempfile

import footprint
from footprint import board
import site_run

DOCUMENT = footprint.SOURCE / "docs/memory.md"
BEGIN, END = "<!-- tables: begin -->\n", "<!-- tables: end -->\n"
REGIONS = ("pair", "message", "last map", "change", "held view", "scratch")
TOLERANCE = 0.05


def plans():
    """([(role, (width, height, disparities), total, [length of each region])], {type: bytes}) on the Cortex-M4."""
    image = board.build("tarsier-memory-plan") / "tarsier-memory-plan.elf"
    code, text = board.run_image(image)
    if code != 0:
        raise board.BoardError(f"{image}: exit {code}: {text}")
    found, types = [], {}
    for words in map(str.split, text.splitlines()):
        if words[0] == "sizeof":
            types[words[1]] = int(words[2])
        else:
            numbers = list(map(int, words[1:]))
            found.append((words[0], tuple(numbers[:3]), numbers[3], numbers[5::2]))
    return found, types


def number(value):
    return f"{value:,}" if value else "-"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|---" + "|---:" * (len(head) - 1) + "|"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def arena_tables():
    found, types = plans()
    text = ""
    for shape in sorted({shape for _, shape, _, _ in found}):
        rows = [[role, *map(number, lengths), number(total), number(total + types["tsr_node"])]
                for role, this, total, lengths in found if this == shape]
        text += f"{shape[0]}x{shape[1]}, D = {shape[2]}, bytes:\n\n"
        text += table(("role", *REGIONS, "arena", "arena + tsr_node"), rows) + "\n"
    text += table(("type", "bytes"), [(f"`struct {name}`", number(length)) for name, length in types.items()])
    return text


def footprint_tables(bin_folder, painted):
    sizes, totals = footprint.sizes(bin_folder), footprint.totals(bin_folder)
    stacks = footprint.stack_by_layer()
    rows = []
    for owner in sorted(sizes, key=lambda name: (name not in footprint.LAYERS, name)):
        depth = stacks.get(owner, (0,))[0]
        rows.append((owner, number(sizes[owner]["flash"]), number(sizes[owner]["ram"]), number(depth)))
    rows.append(("image", number(totals["flash"]), number(totals["static"]), number(footprint.stack_bound()[0])))
    text = table(("part", "flash", "static RAM", "deepest stack"), rows)
    chain = " > ".join(f"`{footprint.short(name)}`" for name in footprint.stack_bound()[1])
    return text + f"""
RAM of the image: {totals['static']:,} static + {totals['stack']:,} of stack = {totals['ram']:,} of 131,072 bytes.
Stack: at most {footprint.stack_bound()[0]:,} bytes by the call graph, {painted:,} found in the paint after a whole map.
The deepest chain: {chain}.
"""


def tables():
    with tempfile.TemporaryDirectory(prefix="tsr") as work:
        counters, _ = site_run.run(work)
    return f"{arena_tables()}\n{footprint_tables(board.build(), counters['stack_used'])}"


def documented():
    text = DOCUMENT.read_text("utf-8")
    return text[text.index(BEGIN) + len(BEGIN):text.index(END)].strip("\n") + "\n"


def differences(documented_text, measured_text):
    """Lines of the document whose words differ, or whose numbers differ by more than the tolerance."""
    pattern = re.compile(r"\d[\d,]*")
    old, new = ([line for line in text.splitlines() if line and not line.startswith("The deepest")]
                for text in (documented_text, measured_text))
    if len(old) != len(new):
        return [f"{len(old)} lines documented, {len(new)} measured"]
    found = []
    for before, after in zip(old, new):
        pairs = zip(pattern.findall(before), pattern.findall(after))
        far = any(abs(a - b) > TOLERANCE * max(a, b)
                  for a, b in ((int(x.replace(",", "")), int(y.replace(",", ""))) for x, y in pairs))
        if far or pattern.sub("", before) != pattern.sub("", after):
            found.append(f"documented: {before}\n  measured: {after}")
    return found


def main():
    text = tables()
    if "--write" in sys.argv:
        whole = DOCUMENT.read_text("utf-8")
        head, tail = whole[:whole.index(BEGIN) + len(BEGIN)], whole[whole.index(END):]
        DOCUMENT.write_text(f"{head}\n{text}\n{tail}", "utf-8")
    else:
        print(text)


if __name__ == "__main__":
    main()
