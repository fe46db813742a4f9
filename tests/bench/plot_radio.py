"""Draw docs/radio.png from what tools/bench radio --json printed.

    python3 tests/bench/plot_radio.py RADIO.json OUT.png

Needs python3-matplotlib.

SPDX-License-Identifier: Apache-2.0
"""
import json
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

COLOURS = {20: "#2a8a57", 127: "#b4451f", 60: "#2a8a57"}


def draw_errors(curves, axes):
    for curve in curves:
        colour = COLOURS[curve["psdu_len"]]
        axes.plot(curve["snr_db"], curve["air"], "-", color=colour, label=f"Air, {curve['psdu_len']} octets")
        axes.plot(curve["snr_db"], curve["ns3"], "o", color=colour, fillstyle="none", markersize=5,
                  label=f"ns-3, {curve['psdu_len']} octets")
    axes.set_yscale("log")
    axes.set_ylim(1e-3, 1.2)
    axes.set_xlabel("SNR, dB")
    axes.set_ylabel("packet error")
    axes.legend(frameon=False, fontsize=8)


def draw_rates(rates, axes):
    for psdu_len in sorted({rate["psdu_len"] for rate in rates}):
        rows = [rate for rate in rates if rate["psdu_len"] == psdu_len]
        contenders = [row["contenders"] for row in rows]
        for name, style, label in (("air", "-", "Air"), ("ns3", "o", "ns-3, whole CCA"),
                                   ("air_cca_at_end", ":", "Air, CCA at its end"), ("ns3_as_is", "x", "ns-3.37 as it is")):
            axes.plot(contenders, [row[name] for row in rows], style, color=COLOURS[psdu_len], fillstyle="none",
                      markersize=6, label=f"{label}, {psdu_len} octets")
    axes.set_ylim(bottom=0)
    axes.set_xlabel("contenders")
    axes.set_ylabel("acknowledged frames a second")
    axes.legend(frameon=False, fontsize=8)


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        details = json.load(file)["details"]
    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    draw_errors(details["packet_error"], axes[0])
    draw_rates(details["throughput"], axes[1])
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=100)


main()
