"""The radio medium beside ns-3's lr-wpan: packet error against SNR, CSMA throughput against contenders.

Needs libns3-dev. Contenders always have a frame for one receiver, 10 m away, and hear each other.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/target"))
import board  # noqa: E402
import progress  # noqa: E402
import radio_peers as peers  # noqa: E402

FRAMES = 10_000
SECONDS = 20
SEEDS = (1, 2, 3)
ERROR_LENS = (20, 127)
CONTEND_LENS = (60, 127)
# Name -> program and options.
RUNS = {"air": ("air_radio",), "ns3": ("ns3_radio", "cca"), "air_cca_at_end": ("air_radio", "cca=end"), "ns3_as_is": ("ns3_radio",),
        "air_no_ifs": ("air_radio", "ifs=0"), "air_capture_3": ("air_radio", "capture=3")}
COMPARED = (("whole CCA", "air", "ns3"), ("CCA at its end", "air_cca_at_end", "ns3_as_is"))


def target(name, value, unit, goal=None, how=""):
    return {"name": name, "value": round(value, 3), "unit": unit, "target": goal,
            "met": None if goal is None else abs(value) <= goal, "how": how}


def build():
    release = SOURCE / "build/release"
    board.run(["cmake", "--preset", "release", "-DTSR_TESTS=ON"], cwd=SOURCE)
    board.run(["cmake", "--build", release, "--target", "air_radio", "ns3_radio"], timeout_s=900)
    return release / "bin"


def packet_errors(programs):
    for psdu_len in ERROR_LENS:
        curves = {name: peers.packet_errors(programs, f"{name}_radio", psdu_len, FRAMES) for name in ("air", "ns3")}
        crossings = [{"packet_error": level, **{name: peers.snr_at(curve, level) for name, curve in curves.items()}}
                     for level in peers.LEVELS]
        yield {"psdu_len": psdu_len, "snr_db": peers.SNRS_DB, **curves, "crossings": crossings}


def throughputs(programs):
    for psdu_len in CONTEND_LENS:
        for contenders in peers.CONTENDERS:
            progress.tell(f"{contenders} contenders, {psdu_len} octets")
            yield {"psdu_len": psdu_len, "contenders": contenders,
                   **{name: peers.acknowledged_per_s(programs, run[0], contenders, psdu_len, SECONDS, SEEDS, *run[1:])
                      for name, run in RUNS.items()}}


def bench():
    programs = build()
    errors = list(packet_errors(programs))
    rates = list(throughputs(programs))
    targets = []
    for curve in errors:
        worst = max((row["air"] - row["ns3"] for row in curve["crossings"]), key=abs)
        targets.append(target(f"packet error, {curve['psdu_len']} octets", worst, "dB from ns-3", 0.5,
                              f"largest at {peers.LEVELS}, {FRAMES} frames a point"))
    for rate in rates:
        for name, air, ns3 in COMPARED:
            targets.append(target(f"{rate['contenders']} contenders, {rate['psdu_len']} octets, {name}",
                                  100 * (rate[air] / rate[ns3] - 1), "% from ns-3", 5,
                                  f"{len(SEEDS)} seeds, {SECONDS} s each"))
    return {"targets": targets, "details": {"packet_error": errors, "throughput": rates}}


def table(result):
    details = result["details"]
    lines = ["| packet error | " + " | ".join(f"{curve['psdu_len']} octets, Air / ns-3" for curve in details["packet_error"]) + " |",
             "|---" * (len(details["packet_error"]) + 1) + "|"]
    for i, level in enumerate(peers.LEVELS):
        cells = [f"{curve['crossings'][i]['air']:.2f} / {curve['crossings'][i]['ns3']:.2f} dB" for curve in details["packet_error"]]
        lines.append(f"| {100 * level:g} % | " + " | ".join(cells) + " |")
    lines += ["", "| PSDU | contenders | Air | ns-3, whole CCA | difference | Air, CCA at its end | ns-3.37 as it is | difference | "
              "Air without IFS | Air, capture 3 dB |", "|---|---|---|---|---|---|---|---|---|---|"]
    for rate in details["throughput"]:
        cells = [f"{rate[air]:.1f} | {rate[ns3]:.1f} | {100 * (rate[air] / rate[ns3] - 1):+.1f} %" for _, air, ns3 in COMPARED]
        lines.append(f"| {rate['psdu_len']} | {rate['contenders']} | {' | '.join(cells)} | "
                     f"{rate['air_no_ifs']:.1f} | {rate['air_capture_3']:.1f} |")
    return "\n".join(lines)
