"""Killing tarsier-sink at random moments loses no map and adds none.

Replay one seed with: TSR_SEED=N python3 tests/system/test_sink_kill.py
"""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import random
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, child_named, emulate, kill_quietly, make_scene, start_emulator, stored_maps

# A killed sink forgets half messages. With many more kills a node is still sending when the scene changes again, and
# then captures at another moment than in a calm run.
KILLS_MAX = 12
RUNS = 24 if os.environ.get("TSR_TEST_ALL") == "1" else 6


def run_with_kills(site, out, seed):
    """Kill the sink whenever a random pause of 1 to 250 ms has passed; returns the number of kills."""
    chance = random.Random(seed)
    emulator = start_emulator(site, out)
    kills = 0
    # A sink that never lives long enough to answer would stall virtual time for ever.
    while emulator.poll() is None:
        time.sleep(chance.uniform(0.001, 0.250))
        sink = child_named(emulator.pid, "tarsier-sink")
        if sink is not None and kills < KILLS_MAX and kill_quietly(sink):
            kills += 1
    check(emulator.returncode == 0, f"seed {seed}: the emulator ended with {emulator.returncode}")
    return kills


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    site = make_scene("test_sink_kill", folder / "scene")
    emulate(site, folder / "calm")
    calm = sorted(stored_maps(folder / "calm"))
    check(len(calm) >= 4, f"a calm run stores {len(calm)} maps")
    first = int(os.environ.get("TSR_SEED", "1"))
    for seed in range(first, first + (1 if "TSR_SEED" in os.environ else RUNS)):
        kills = run_with_kills(site, folder / "killed", seed)
        killed = sorted(stored_maps(folder / "killed"))
        print(f"seed {seed}: {kills} kills, {len(killed)} maps")
        check(kills > 0, f"seed {seed}: the sink was never killed")
        check(killed == calm, f"seed {seed}: other maps than in a calm run")
