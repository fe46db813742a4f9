"""Own frames need no site file: --pair runs the same chain."""
# SPDX-License-Identifier: Apache-2.0
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, make_scene

with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    make_scene("test_pair_option", folder / "scene")
    run = subprocess.run([BUILD / "bin/tarsier-emulator", "--pair", folder / "scene/left160", folder / "scene/right160",
                          "--focal-px", "466", "--baseline-mm", "160", "--d0", "33.7", "--out", folder / "out"],
                         capture_output=True, text=True)
    check(run.returncode == 0, run.stderr)
    pair = json.loads((folder / "out/summary.json").read_text())["pairs"][0]
    print(pair["maps_received"], "maps")
    check(pair["maps_received"] >= 2 and pair["maps_lost"] == 0, f"{pair}")
    check((folder / "out/cloud.ply").stat().st_size > 10000, "no cloud")

    # A single picture of each side is what anybody tries first: it gives a map as well.
    for side in ("left", "right"):
        (folder / side).mkdir()
        (folder / side / "000.pgm").write_bytes((folder / f"scene/{side}160/000.pgm").read_bytes())
    subprocess.run([BUILD / "bin/tarsier-emulator", "--pair", folder / "left", folder / "right", "--focal-px", "466",
                    "--baseline-mm", "160", "--out", folder / "one"], check=True, capture_output=True)
    check(json.loads((folder / "one/summary.json").read_text())["totals"]["maps_received"] == 1, "no map of one pair")
