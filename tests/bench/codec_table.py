"""The codecs beside each other as Markdown, from what `tools/bench codec --json` printed.

SPDX-License-Identifier: Apache-2.0
"""
NAMES = {"one stream": "tarsier, one stream", "packets of 90 B": "tarsier, packets of 90 B",
         "near-lossless": "tarsier, near-lossless (one step off at most)"}


def bits(value):
    return f"{value:.3f}" if value is not None else ""


def rows(columns, by_name):
    """Header and rows; by_name: {name: [cell]}"""
    lines = ["| " + " | ".join(["bits per pixel", *columns]) + " |", "|---|" + "---:|" * len(columns)]
    return lines + ["| " + " | ".join([NAMES.get(name, name), *cells]) + " |" for name, cells in by_name.items()]


def maps(found):
    steps = list(found)
    names = found[steps[0]]
    return rows([f"{step}, 160 / 320 px wide" for step in steps],
                {name: [" / ".join(bits(value) for value in found[step][name].values()) for step in steps] for name in names})


def by_width(found):
    widths = list(next(iter(found.values())))
    return rows([f"{width} px wide" for width in widths],
                {name: [bits(value) for value in cells.values()] for name, cells in found.items()})


def table(result):
    found = result["details"]["bits_per_pixel"]
    parts = [("Maps", maps(found["maps"])), ("A wing's view", by_width(found["views"])),
             ("Reference images at an SSIM of .90", by_width(found["pictures"]))]
    return "\n\n".join(f"**{title}**\n\n" + "\n".join(lines) for title, lines in parts)
