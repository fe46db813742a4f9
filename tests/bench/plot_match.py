"""Draw docs/match_time.png, the thesis's claims H1 and H2, from what tools/bench match --json printed.

    python3 tests/bench/plot_match.py MATCH.json OUT.png

Needs python3-matplotlib.

SPDX-License-Identifier: Apache-2.0
"""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

CURVES = (("ssd", "ssd, portable C", "#b4451f", "s"), ("raw", "raw, portable C", "#1f77b4", "o"),
          ("sad, fastest kernel", "sad, vector kernel", "#2a8a57", "^"))


DISPARITIES = ((32, "none", ":"), (128, "full", "-"))  # D, how its points are filled and its line is drawn


def draw(cases, axes):
    for name, label, colour, marker in CURVES:
        for disparities, fill, style in DISPARITIES:
            points = sorted((case["width"] * case["height"] / 1e3, case["ms"][name]) for case in cases
                            if case["disparities"] == disparities)
            x, y = zip(*points)
            slope = sum(a * b for a, b in points) / sum(a * a for a in x)
            axes[0].plot(x, y, marker, color=colour, markersize=5, fillstyle=fill, label=f"{label}, D = {disparities}")
            axes[0].plot((0, x[-1]), (0, slope * x[-1]), style, color=colour, linewidth=0.8)
    axes[0].set_xlabel("thousand pixels")
    axes[0].set_ylabel("ms a map")
    axes[0].set_title("H1: is time linear in pixels?  Lines through 0", fontsize=10)
    axes[0].legend(frameon=False, fontsize=8)
    widths = sorted({case["width"] for case in cases})
    for width in widths:
        rows = sorted((case["disparities"], case["ms"]["ssd"] / case["ms"]["raw"]) for case in cases
                      if case["width"] == width)
        axes[1].plot(*zip(*rows), "o-", markersize=3, linewidth=0.8, label=f"{width} px wide")
    axes[1].axhline(1, color="black", linewidth=0.6)
    axes[1].set_ylim(0.5, 1.5)
    axes[1].set_xlabel("disparities")
    axes[1].set_ylabel("time of ssd / time of raw")
    axes[1].set_title("H2: is raw (SAD) faster than ssd?  Above 1: yes", fontsize=10)
    axes[1].legend(frameon=False, fontsize=8)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        cases = json.load(file)["details"]["claims"]
    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    draw(cases, axes)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=100)


main()
