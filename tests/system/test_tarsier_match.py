"""tarsier match on the demo's Aloe pair: its map is as good as a node's, all outputs agree, bad input is refused."""
# SPDX-License-Identifier: Apache-2.0
import json
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, make_scene, skip

try:
    import numpy as np
except ImportError:
    skip("test_tarsier_match", "python3-numpy is not installed")
import map_quality
import refine_reference
import vision_reference

TARSIER = BUILD / "bin/tarsier"


def match(*words):
    return subprocess.run([TARSIER, "match", *map(str, words)], capture_output=True, text=True, timeout=60)


def match_json(*words):
    run = match(*words, "--json")
    check(run.returncode == 0, run.stderr)
    return json.loads(run.stdout)


def judge(disparity, truth):
    run = subprocess.run([TARSIER, "compare", disparity, truth, "--json"], capture_output=True, text=True, check=True)
    return json.loads(run.stdout)


def refuse(what, *words, mentions, left=()):
    run = match(*words)
    lines = run.stderr.strip().splitlines()
    check(run.returncode == 2, f"{what}: exit status {run.returncode}: {run.stderr}")
    check(len(lines) == 1 and run.stdout == "", f"{what}: {run.stdout}{run.stderr}")
    for mention in mentions:
        check(mention in lines[0], f"{what}: does not name {mention}: {lines[0]}")
    for path in left:
        check(not path.exists() and not list(path.parent.glob(f".{path.name}*")), f"{what}: left {path} behind")
    print(f"{what}: {lines[0]}")


def read_pgm(path):
    magic, size, most, pixels = path.read_bytes().split(b"\n", 3)
    width, height = (int(number) for number in size.split())
    assert (magic, most) == (b"P5", b"255")
    return np.frombuffer(pixels, np.uint8).reshape(height, width)


def write_pgm(path, picture):
    path.write_bytes(f"P5\n{picture.shape[1]} {picture.shape[0]}\n255\n".encode() + picture.tobytes())


def real_pair(scene, folder):
    left, right = (scene / f"{side}320/000.pgm" for side in ("left", "right"))
    truth = scene / "truth320/000.pfm"
    found = match_json(left, right, "--disparities", 64, "-o", folder / "map.pfm", "--png", folder / "map_colours.png")
    check((found["width"], found["height"], found["disparities"], found["window"]) == (320, 240, 64, 9), found)
    check(found["match_scratch_bytes"] == 320 * 69 + 4 * 64 + 8 and found["refine_scratch_bytes"] == 4 * 320, found)
    disparity = map_quality.read_pfm(folder / "map.pfm")
    check(abs(found["density"] - np.isfinite(disparity).mean()) < 1e-9, found)
    wanted = map_quality.judge(disparity, map_quality.read_pfm(truth))
    got = judge(folder / "map.pfm", truth)
    check(abs(got["correct"]["1"] - wanted["correct"]["1"]) < 1e-9 and abs(got["ssim"] - wanted["ssim"]) < 1e-6, got)
    check(got["correct"]["1"] > 0.75 and got["bad"]["1"] < 0.1, f"sparse: {got}")
    check((folder / "map_colours.png").read_bytes()[:4] == b"\x89PNG", "no picture")

    match_json(left, right, "--disparities", 64, "-o", folder / "map.png")
    check(judge(folder / "map.png", truth)["correct"] == got["correct"], "the PNG is another map")
    check(judge(folder / "map.png", folder / "map.pfm")["mse_px2"] < 1e-4, "the PNG is another map")
    dense = match_json(left, right, "--disparities", 64, "--refine", "median3,speckle,fill,median5", "-o",
                       folder / "dense.pfm")
    filled = judge(folder / "dense.pfm", truth)
    check(dense["density"] == 1 and filled["density"] == 1, dense)
    check(filled["correct"]["1"] > got["correct"]["1"] + 0.03, f"filling gains nothing: {filled}")
    print(f"correct within 1 px: {got['correct']['1']:.4f} of {got['density']:.3f}, dense {filled['correct']['1']:.4f}")


def small_pair(folder):
    """Bit for bit the map of the references, which were written from docs/math.md."""
    rng = np.random.default_rng(3)
    scene = rng.integers(0, 256, (19, 90), np.uint8)
    left, right = scene[:, 20:61].copy(), scene[:, 27:68].copy()
    write_pgm(folder / "l.pgm", left)
    map_quality.write_png(folder / "r.png", right)
    for start, options, settings in ((0, [], (15, 1, 1)), (-3, ["--uniqueness", "off", "--texture", 5], (255, 5, 1)),
                                     (4, ["--uniqueness", 3, "--lr", "off"], (3, 1, 255))):
        wanted = vision_reference.match(left, right, 16, 7, 7, *settings, start)
        wanted = refine_reference.fill(refine_reference.speckle(refine_reference.median(wanted, 5), 12, 8))
        match_json(folder / "l.pgm", folder / "r.png", "--disparities", 16, "--window", 7, "--search-start", start,
                   *options, "--refine", "median5,speckle,fill", "--speckle-size", 12, "--speckle-difference", 0.5,
                   "-o", folder / "small.pfm")
        got = map_quality.read_pfm(folder / "small.pfm")
        check(np.array_equal(got, wanted / 16 + start), f"search start {start}: not the reference's map")
    for mode, sums, offset in (("raw", False, vision_reference.offset_q4),
                               ("ssd", True, vision_reference.parabola_offset_q4)):
        wanted = vision_reference.choose(vision_reference.plain_sums(left, right, 16, 9, 0, sums),
                                         np.ones(left.shape, bool), 30 if sums else 15, 1, 0, 1, offset)
        found = match_json(folder / "l.pgm", folder / "r.png", "--disparities", 16, "--mode", mode, "--refine", "none",
                           "-o", folder / "plain.pfm")
        check(found["window"] == 9 and np.array_equal(map_quality.read_pfm(folder / "plain.pfm"),
              np.where(wanted == 65535, np.inf, wanted / 16)), f"{mode}: not the reference's map")
    none = match_json(folder / "l.pgm", folder / "r.png", "--disparities", 16, "--refine", "none", "-o",
                      folder / "none.pfm")
    check(none["refine"] == [] and none["refine_scratch_bytes"] == 0, none)
    text = match(folder / "l.pgm", folder / "r.png", "--disparities", 16, "-o", folder / "text.pfm")
    check(text.returncode == 0 and "valid" in text.stdout, text.stderr)


def full_disk(folder):
    """What cannot be written or printed is said, and leaves nothing."""
    words = [str(word) for word in (TARSIER, "match", folder / "l.pgm", folder / "r.png", "--disparities", "16", "-o",
                                    folder / "full.pfm")]
    for what, shell in (("a file beyond its limit", 'ulimit -f 1; exec "$@"'), ("no room to print", 'exec "$@" >/dev/full')):
        run = subprocess.run(["bash", "-c", shell, "bash", *words], capture_output=True, text=True, timeout=60)
        check(run.returncode == 2 and len(run.stderr.splitlines()) == 1, f"{what}: {run.returncode} {run.stderr}")
        check(not list(folder.glob(".full.pfm*")), f"{what}: a temporary file is left")
        print(f"{what}: {run.stderr.strip()}")
        check((folder / "full.pfm").exists() == ("print" in what), f"{what}: the map")


def bad_input(scene, folder):
    left, right = (scene / f"{side}160/000.pgm" for side in ("left", "right"))
    out, picture = folder / "out.pfm", folder / "out.png"
    for name, values in (("low.pgm", (6, 40)), ("tiny.pgm", (4, 40)), ("large.pgm", (481, 40))):
        write_pgm(folder / name, np.zeros(values, np.uint8))
    low = folder / "low.pgm"
    (folder / "cut.pgm").write_bytes(left.read_bytes()[:999])
    (folder / "cut.png").write_bytes((folder / "map.png").read_bytes()[:500])
    pair = (left, right, "-o", out)

    def refuse_pair(what, *words, mentions):
        refuse(what, *pair, *words, mentions=mentions, left=[out, picture])

    refuse("no disparities", *pair, mentions=["--disparities"], left=[out])
    refuse("no output", left, right, "--disparities", 32, mentions=["--out"])
    for name, value in (("129 disparities", 129), ("33 disparities", 33), ("0 disparities", 0), ("-8 disparities", -8),
                        ("disparities beyond 16 bits", 65568)):
        refuse_pair(name, "--disparities", value, mentions=["--disparities", "128"])
    filters = ("--refine", "speckle,diffusion")
    for option, values in (("--window", (0, 4, 8, 17, 265)), ("--uniqueness", ("0", "101", "255", "never")),
                           ("--texture", ("0", "128", "1x")), ("--lr", ("0", "128", "")),
                           ("--search-start", (129, -129, 70000)), ("--speckle-size", (1, 0, 4097, -5)),
                           ("--speckle-difference", (0, -1, 4096, "nan")), ("--diffusion-iterations", (0, 101, 257)),
                           ("--diffusion-edge", (0, 16)), ("--mode", ("rank", "", "SAD")),
                           ("--refine", ("median4", "median3,,fill", "", "fill,none", ",".join(["fill"] * 9)))):
        for value in values:
            more = filters if option.startswith(("--speckle", "--diffusion")) else ()
            refuse_pair(f"{option} {value}", "--disparities", 32, *more, f"{option}={value}", mentions=[option])
    for mode, option, value in (("smooth", "--window", 9), ("smooth", "--texture", 2), ("census", "--texture", 1),
                                ("ssd", "--texture", 1), ("sad8", "--window", 13), ("census", "--window", 300)):
        refuse_pair(f"{option} {value} in {mode}", "--disparities", 32, "--mode", mode, option, value,
                    mentions=[option, "takes" if mode == "census" and option == "--window" else mode])
    refuse("too low for smooth", low, low, "--disparities", 16, "--mode", "smooth", "-o", out,
           mentions=["low.pgm", "6 rows", "smooth"])
    refuse_pair("unknown option", "--disparities", 32, "--fast", mentions=["--fast"])
    refuse_pair("misspelt option", "--disparites", 32, mentions=["'--disparites' is not an option"])
    for option, value, step in (("--speckle-size", 70, "speckle"), ("--speckle-difference", 2, "speckle"),
                                ("--diffusion-iterations", 3, "diffusion"), ("--diffusion-edge", 2, "diffusion")):
        refuse_pair(f"{option} without its filter", "--disparities", 32, option, value, mentions=[option, step])
    refuse("other size", left, scene / "right320/000.pgm", "--disparities", 32, "-o", out,
           mentions=["right320", "size", "320x240", "160x120"], left=[out])
    refuse("too low for the window", low, low, "--disparities", 16, "-o", out, mentions=["--window"], left=[out])
    refuse("too small", folder / "tiny.pgm", low, "--disparities", 16, "-o", out, mentions=["tiny.pgm", "40x4"])
    refuse("too large", folder / "large.pgm", low, "--disparities", 16, "-o", out, mentions=["large.pgm", "640x480"])
    refuse("truncated PGM", left, folder / "cut.pgm", "--disparities", 32, "-o", out, mentions=["cut.pgm"], left=[out])
    refuse("truncated PNG", folder / "cut.png", right, "--disparities", 32, "-o", out, mentions=["cut.png"], left=[out])
    refuse("a PFM as picture", folder / "map.pfm", right, "--disparities", 32, "-o", out, mentions=["map.pfm"])
    refuse("no such format", left, right, "--disparities", 32, "-o", folder / "out.tif", mentions=["out.tif", "--out"])
    refuse("negative in a PNG", left, right, "--disparities", 32, "--search-start", -4, "-o", picture,
           mentions=["out.png", "--search-start"], left=[picture])
    write_pgm(folder / "wide.pgm", np.zeros((9, 640), np.uint8))
    wide = (folder / "wide.pgm", folder / "wide.pgm", "--disparities", 16, "-o", picture, "--png", folder / "near.png")
    refuse("more than a PNG holds", *wide, "--search-start", 241, mentions=["out.png", "--search-start"],
           left=[picture, folder / "near.png"])
    check(match(*wide, "--search-start", 240).returncode == 0, "255 px fit a PNG")
    picture.unlink()
    refuse("nowhere to write", left, right, "--disparities", 32, "-o", folder / "no/where.pfm", mentions=["where.pfm"])
    refuse("nowhere to write, with a picture", left, right, "--disparities", 32, "-o", folder / "no/where.pfm", "--png",
           picture, mentions=["where.pfm"], left=[picture])
    refuse("nowhere for the picture", *pair, "--disparities", 32, "--png", folder / "no/where.png",
           mentions=["where.png"], left=[out])
    refuse("picture of another format", *pair, "--disparities", 32, "--png", folder / "p.jpg", mentions=["--png"])
    refuse("output twice", left, right, "--disparities", 32, "-o", picture, "--png", folder / "../" / folder.name /
           "out.png", mentions=["--png"], left=[picture])
    refuse("output twice, in the folder it runs in", left, right, "--disparities", 32, "-o", "twice.png", "--png",
           "./twice.png", mentions=["--png"], left=[pathlib.Path("twice.png")])
    refuse("output without a name", left, right, "--disparities", 32, "-o", "", mentions=["--out", "empty"])
    refuse("picture without a name", *pair, "--disparities", 32, "--png", "", mentions=["--png", "empty"], left=[out])
    refuse("input without a name", "", right, "--disparities", 32, "-o", out, mentions=["left", "empty"], left=[out])
    before = (folder / "r.png").read_bytes()
    refuse("output over the input", folder / "l.pgm", folder / "r.png", "--disparities", 16, "-o", folder / "r.png",
           mentions=["r.png", "--out"])
    check((folder / "r.png").read_bytes() == before, "the input was overwritten")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    scene = folder / "scene"
    make_scene("test_tarsier_match", scene)
    real_pair(scene, folder)
    small_pair(folder)
    full_disk(folder)
    bad_input(scene, folder)
