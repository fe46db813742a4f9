"""Asks tsr::Air with the firmware's MAC (air_radio) and ns-3's lr-wpan (ns3_radio) the same.

SPDX-License-Identifier: Apache-2.0
"""
import json
import subprocess

LEVELS = (0.9, 0.5, 0.1, 0.01)  # packet error at which the curves are compared
SNRS_DB = [i / 4 for i in range(-14, 9)]
CONTENDERS = (2, 5, 10, 20)


class NoPeer(Exception):
    """ns-3 is not here, or a program fails."""


def ask(programs, name, *words):
    command = [programs / name, *map(str, words)]
    try:
        run = subprocess.run(command, capture_output=True, text=True, timeout=600, check=True)
    except (OSError, subprocess.SubprocessError) as error:
        raise NoPeer(f"{name}: {error}: {getattr(error, 'stderr', '')}") from error
    return json.loads(run.stdout)


def packet_errors(programs, name, psdu_len, frames):
    """Part of the frames lost at each of SNRS_DB."""
    answer = ask(programs, name, "per", psdu_len, frames, *SNRS_DB)
    return [1 - received / frames for received in answer["received"]]


def snr_at(errors, level):
    """Where a falling curve crosses a level, dB, by linear interpolation."""
    for i in range(1, len(errors)):
        if errors[i] <= level < errors[i - 1]:
            return SNRS_DB[i - 1] + (errors[i - 1] - level) / (errors[i - 1] - errors[i]) * (SNRS_DB[i] - SNRS_DB[i - 1])
    raise NoPeer(f"no packet error of {level} in the curve")


def acknowledged_per_s(programs, name, contenders, psdu_len, seconds, seeds, *options):
    """Acknowledged frames a second, all contenders together."""
    acked = sum(ask(programs, name, "contend", contenders, psdu_len, seconds, seed, *options)["acked"] for seed in seeds)
    return acked / (seconds * len(seeds))
