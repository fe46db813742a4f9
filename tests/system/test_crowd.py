"""A crowd runs on frames that a scene was rendered to, shared; the same seed gives the same bytes; what cannot be is refused."""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, emulate, results, stored_maps

SCENE = """name = "tank"
duration_s = 14

[scene]
kind = "tank"

[pairs]
count = 2
width = 96
height = 72
"""
CROWD = """name = "crowd"
duration_s = 30

[recorded]
site = "frames/site.toml"
pause_s = 60

[pairs]
count = 12
start_within_s = 12
"""


def run(*arguments):
    return subprocess.run([str(argument) for argument in arguments], capture_output=True, text=True)


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    crowd = folder / "crowd.toml"
    crowd.write_text(CROWD)

    def refuse(expected, *options):
        result = run(BUILD / "bin/tarsier-emulator", crowd, "--out", folder / "refused", *options)
        lines = result.stderr.strip().splitlines()
        check(result.returncode == 2 and len(lines) == 1 and expected in lines[0], f"{options}: {result.returncode} {result.stderr}")
        check(not (folder / "refused").exists(), f"{options}: something was written")

    refuse("recorded.site: there is no ")
    (folder / "loop").symlink_to("loop")
    refuse("crowd.toml: recorded.site: ", "--set", 'recorded.site="loop/site.toml"')
    refuse("File name too long", "--set", f'recorded.site="{"n" * 300}/site.toml"')
    (folder / "scene.toml").write_text(SCENE)
    rendered = run(BUILD / "bin/tarsier", "render", folder / "scene.toml", "--out", folder / "frames")
    check(rendered.returncode == 0, rendered.stderr)

    first, again, other = (emulate(crowd, folder / name, "--seed", seed) for name, seed in (("a", "1"), ("b", "1"), ("c", "2")))
    for summary in (first, again, other):
        check(all(pair["maps_received"] >= 1 for pair in summary["pairs"]), "a pair without a map")
        check(summary["totals"]["frames_watched"] >= 12 * 15, f"{summary['totals']}")
    files = results(folder / "a")
    check(files == results(folder / "b"), "two runs of one seed differ")
    check(files["capture.pcapng"] != results(folder / "c")["capture.pcapng"], "the seed changes nothing")
    (folder / "deeper").mkdir()
    emulate(folder / "a/scenario.toml", folder / "deeper/again")
    check(results(folder / "deeper/again")["capture.pcapng"] == files["capture.pcapng"], "a run's scenario.toml gives another run")
    maps = stored_maps(folder / "a")
    check(len({digest for _, digest in maps}) > 2, "all copies see the same")

    refuse("pairs.count: 0 is outside", "--set", "pairs.count=0")
    refuse("recorded.offset_s: is not two numbers", "--set", "recorded.offset_s=[-1, 1]")
    refuse("pairs.start_within_s: is after", "--set", "pairs.start_within_s=31")
    refuse("pairs.baseline_mm: unknown field", "--set", "pairs.baseline_mm=1")
    left = folder / "frames/pair-1/left"
    (left / "000003.png").write_bytes((left / "000003.png").read_bytes()[:200])
    refuse("000003.png")
    for file in left.iterdir():
        file.unlink()
    refuse("pair-1/left")
    render = run(BUILD / "bin/tarsier", "render", crowd, "--out", folder / "refused")
    check(render.returncode == 2 and "recorded: there is no scene to render" in render.stderr, render.stderr)
    print(f"{len(files)} files equal, {len(maps)} maps")
