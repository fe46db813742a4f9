"""Calls of the tarsier command on coded maps, and a map for them.

SPDX-License-Identifier: Apache-2.0
"""
import json
import subprocess

import numpy as np
from run_site import BUILD, check

TARSIER = BUILD / "bin/tarsier"
RNG = np.random.default_rng(11)


def run(command, *words):
    return subprocess.run([TARSIER, command, *map(str, words)], capture_output=True, text=True, timeout=60)


def run_json(command, *words):
    done = run(command, *words, "--json")
    check(done.returncode == 0, f"{command} {words}: {done.stderr}")
    return json.loads(done.stdout)


def refuse(what, command, *words, mentions, left=()):
    done = run(command, *words)
    lines = done.stderr.strip().splitlines()
    check(done.returncode == 2, f"{what}: exit status {done.returncode}: {done.stderr}")
    check(len(lines) == 1 and done.stdout == "", f"{what}: {done.stdout}{done.stderr}")
    for mention in mentions:
        check(mention in lines[0], f"{what}: does not name {mention}: {lines[0]}")
    for path in left:
        check(not path.exists() and not list(path.parent.glob(f".{path.name}*")), f"{what}: left {path} behind")
    print(f"{what}: {lines[0]}")


def scene(height=60, width=80, largest=30):
    """px, sixteenths: a slope, a box in front of it, pixels without a match."""
    y, x = np.mgrid[:height, :width]
    values = np.round(16 * (2 + x / 9 + y / 13)) / 16
    values[height // 4:height // 2, width // 3:width // 2] = largest
    values[RNG.random(values.shape) < 0.02] += 1 / 16
    values[:, :4] = np.inf
    values[RNG.random(values.shape) < 0.05] = np.inf
    return values


def quantised(values, step, disparities):
    """docs/math.md, eq. (19)."""
    return np.where(np.isfinite(values), np.minimum(np.floor(values / step + 0.5) * step, disparities - 1), np.inf)
