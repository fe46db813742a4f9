"""Draw docs/scenes.png: one view of each virtual scene and its true depth.

  python3 tests/bench/plot_scenes.py OUT.png      needs python3-matplotlib

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import subprocess
import sys
import tempfile

import matplotlib
import matplotlib.image
import numpy as np

SOURCE = pathlib.Path(__file__).resolve().parents[2]
TARSIER = SOURCE / "build/release/bin/tarsier"
# Scene, pair and frame that show something, of a minute in steps of three seconds.
SHOWN = (("house", 1, 12), ("car", 2, 8), ("bedroom", 4, 9), ("street", 4, 17), ("tank", 1, 10))
WIDTH, HEIGHT = 320, 240


def read_pfm(file):
    """Infinity is the sky."""
    with open(file, "rb") as stream:
        stream.readline()
        width, height = (int(word) for word in stream.readline().split())
        stream.readline()
        return np.frombuffer(stream.read(), "<f4").reshape(height, width)[::-1]


def shown(scene, pair, frame):
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out"
        settings = ("pairs.count=4", f"pairs.width={WIDTH}", f"pairs.height={HEIGHT}", "duration_s=60")
        subprocess.run([TARSIER, "render", SOURCE / f"emulator/scenarios/{scene}.toml", "--period-ms", "3000", "--out", out,
                        *(word for setting in settings for word in ("--set", setting))], check=True, stdout=subprocess.DEVNULL)
        view = matplotlib.image.imread(out / f"pair-{pair}/left/{frame:06d}.png")
        depth = read_pfm(out / f"pair-{pair}/depth/{frame:06d}.pfm")
    near, far = np.percentile(depth[np.isfinite(depth)], (1, 99))
    nearness = np.clip((1 / depth - 1 / far) / (1 / near - 1 / far), 0, 1)
    return np.repeat(view[..., None], 3, 2), matplotlib.colormaps["inferno"](nearness)[..., :3]


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    columns = [np.vstack(shown(*one)) for one in SHOWN]
    matplotlib.image.imsave(sys.argv[1], np.hstack(columns))
    return 0


if __name__ == "__main__":
    sys.exit(main())
