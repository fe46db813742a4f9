"""Draw docs/map_steps.png, error of a map against its bytes, from what tests/bench/step_curve.py printed.

    python3 tests/bench/plot_steps.py CURVE.json OUT.png

Needs python3-matplotlib.

SPDX-License-Identifier: Apache-2.0
"""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

CURVES = (("rms_px", "as decoded", "#b4451f", "s", "none"), ("restored_rms_px", "restored", "#2a8a57", "o", "full"))
STYLES = {"sad": "-", "smooth": ":"}
SENT = 0.5  # px, the product's step


def draw(points, axes):
    for mode, style in STYLES.items():
        rows = [point for point in points if point["mode"] == mode]
        for key, label, colour, marker, fill in CURVES:
            axes.plot([row["bytes"] / 1e3 for row in rows], [row[key] for row in rows], marker, linestyle=style,
                      color=colour, markersize=5, fillstyle=fill, linewidth=0.8, label=f"{mode}, {label}")
        if mode == "sad":
            for row in rows:
                part = round(1 / row["step_px"])
                axes.annotate(f"1/{part} px" if part > 1 else "1 px", (row["bytes"] / 1e3, row["restored_rms_px"]),
                              (2, -13) if part > 1 else (7, 2), textcoords="offset points", fontsize=8,
                              fontweight="bold" if row["step_px"] == SENT else "normal")
    axes.set_xlabel("kB a map, mean of the pairs")
    axes.set_ylabel("rms error of right matches, px")
    axes.set_ylim(bottom=0.2)
    axes.set_xlim(0, 1.12 * max(row["bytes"] for row in points) / 1e3)
    axes.set_title(f"{points[0]['width']}x{points[0]['height']}", fontsize=10)
    axes.legend(frameon=False, fontsize=8)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        points = json.load(file)
    widths = sorted({point["width"] for point in points})
    figure, axes = plt.subplots(1, len(widths), figsize=(10, 4), squeeze=False)
    for width, one in zip(widths, axes[0]):
        draw([point for point in points if point["width"] == width], one)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=100)


main()
