"""tarsier encode and decode: a map is the same after both, as a node quantises it, and bad input is refused."""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, skip

try:
    import numpy as np
except ImportError:
    skip("test_tarsier_codec", "python3-numpy is not installed")
import codec_decoder
import map_quality
from tarsier_run import RNG, TARSIER, quantised, refuse, run, run_json, scene

CODED_LEN_MAX = 11 + 640 * 480 * 12 // 8 + 784  # docs/codec.md, 2.9


def independent(path, reference=None):
    """The decoder of the specification, in px; reference is (px, id)."""
    if reference is not None:
        held = np.where(np.isfinite(reference[0]), 16 * reference[0], codec_decoder.INVALID).astype(int)
        rows = codec_decoder.decode_map(path.read_bytes(), held.tolist(), reference[1])[1]
    else:
        rows = codec_decoder.decode_map(path.read_bytes())[1]
    values = np.array(rows, float)
    return np.where(values == codec_decoder.INVALID, np.inf, values / 16)


def round_trip(folder):
    values = scene()
    source, coded, back = folder / "map.pfm", folder / "map.tdm", folder / "back.pfm"
    map_quality.write_pfm(source, values)
    sizes = []
    for step in (1, 0.5, 0.25, 0.125, 0.0625):
        wanted = quantised(values, step, 32)
        told = run_json("encode", source, "-o", coded, "--step", step, "--d0=-31.1")
        sizes.append(coded.stat().st_size)
        check(told == {"width": 80, "height": 60, "bytes": sizes[-1], "bits_per_pixel": 8 * sizes[-1] / 4800,
                       "density": told["density"], "step_px": step, "near": 0, "disparities": 32, "d0_px": -31.125,
                       "reference_id": None, "format_version": 3, "prior": 2, "packets": None, "out": str(coded)}, f"{step}: {told}")
        check(abs(told["density"] - np.isfinite(values).mean()) < 1e-9, told)
        found = run_json("decode", coded, "-o", back)
        check(found == {**told, "out": str(back)}, f"{step}: {found}")
        check(np.array_equal(map_quality.read_pfm(back), wanted), f"{step}: another map")
        check(np.array_equal(independent(coded), wanted), f"{step}: another map, says the specification")
    check(sizes[0] < sizes[1] < sizes[-1], f"a finer step takes less: {sizes}")
    text = run("decode", coded, "-o", folder / "back.png")
    check(text.returncode == 0 and f"{sizes[-1]} bytes" in text.stdout and "step 0.0625 px" in text.stdout, text)
    run_json("encode", folder / "back.png", "-o", folder / "of_png.tdm", "--step", 0.0625, "--d0=-31.1")
    check((folder / "of_png.tdm").read_bytes() == coded.read_bytes(), "the PNG is another map")
    default = run_json("encode", source, "-o", coded)
    check((default["step_px"], default["d0_px"], default["near"]) == (0.5, 0, 0), default)

    wide = run_json("encode", source, "-o", folder / "wide.TDM", "--disparities", 100)
    check(wide["disparities"] == 100 and run("encode", source, "-o", coded, "--disparities", 31).returncode == 0, wide)
    for what, edge in (("one pixel", np.array([[3.0]])), ("nothing valid", np.full((5, 7), np.inf)),
                       ("noise", RNG.integers(0, 127 * 16, (480, 640)) / 16)):
        map_quality.write_pfm(source, edge)
        run_json("encode", source, "-o", coded, "--step", 0.0625)
        run_json("decode", coded, "-o", back)
        check(np.array_equal(map_quality.read_pfm(back), edge), what)
        check(coded.stat().st_size <= CODED_LEN_MAX, f"{what}: {coded.stat().st_size} bytes")


def near(folder):
    values = scene()
    source, coded, back = folder / "map.pfm", folder / "near.tdm", folder / "near.pfm"
    map_quality.write_pfm(source, values)
    for step in (1, 0.5, 0.0625):
        exact = run_json("encode", source, "-o", coded, "--step", step)["bytes"]
        told = run_json("encode", source, "-o", coded, "--step", step, "--near", 1)
        check(run_json("decode", coded, "-o", back)["near"] == 1, "near is not told")
        got, wanted = map_quality.read_pfm(back), quantised(values, step, 32)
        check(np.array_equal(np.isfinite(got), np.isfinite(wanted)), f"{step}: other pixels have a match")
        valid = np.isfinite(got)
        check(np.abs(got[valid] - wanted[valid]).max() <= step, f"{step}: farther off than a step")
        check(told["bytes"] < exact or step < 0.5, f"{step}: {told['bytes']} bytes, exactly {exact}")


def reference(folder):
    old, new = scene(), None
    new = old.copy()
    new[20:30, 50:60] = 25
    map_quality.write_pfm(folder / "old.pfm", old)
    map_quality.write_pfm(folder / "new.pfm", new)
    coded, back = folder / "new.tdm", folder / "new_back.pfm"
    for step in (1, 0.5, 0.0625):
        alone = run_json("encode", folder / "new.pfm", "-o", coded, "--step", step)["bytes"]
        for options in ([], ["--near", 1]):
            run_json("encode", folder / "old.pfm", "-o", folder / "old.tdm", "--step", step, *options)
            held = ["--against", folder / "old.tdm", "--reference-id", 65535]
            told = run_json("encode", folder / "new.pfm", "-o", coded, "--step", step, *options, *held)
            check(told["reference_id"] == 65535 and told["bytes"] < alone / 2, f"{told}, alone {alone}")
            check(run_json("decode", coded, "-o", back, *held) == {**told, "out": str(back)}, "told otherwise")
            got, wanted = map_quality.read_pfm(back), quantised(new, step, 32)
            off = np.abs(np.where(np.isfinite(wanted), got, 0) - np.where(np.isfinite(wanted), wanted, 0)).max()
            check(off <= (step if options else 0), f"step {step}, {options}: {off} px off")
            run_json("decode", folder / "old.tdm", "-o", folder / "old_back.pfm")
            check(np.array_equal(independent(coded, (map_quality.read_pfm(folder / "old_back.pfm"), 65535)), got),
                  "another map, says the specification")
            run_json("decode", coded, "-o", folder / "again.pfm", "--against", folder / "old_back.pfm",
                     "--reference-id", 65535)
            check((folder / "again.pfm").read_bytes() == back.read_bytes(), "the decoded map is another reference")
    noisy = new.copy()
    noisy[::3] += 1
    map_quality.write_pfm(folder / "noisy.pfm", noisy)
    held = ["--against", folder / "old.pfm", "--reference-id", 0]
    every, large = (run_json("encode", folder / "noisy.pfm", "-o", coded, *held, *hold)["bytes"] for hold in ([], ["--hold"]))
    run_json("decode", coded, "-o", back, *held)
    got, wanted = map_quality.read_pfm(back), quantised(old, 0.5, 32)
    wanted[20:30, 50:60] = quantised(noisy, 0.5, 32)[20:30, 50:60]
    far = np.ones(got.shape, bool)
    far[14:36, 44:66] = False  # within reach of a window that the object fills
    check(large < every / 2 and np.array_equal(got[far], wanted[far]) and np.array_equal(got[20:30, 50:60],
                                                                                       wanted[20:30, 50:60]), "held")
    run_json("encode", folder / "new.pfm", "-o", coded, *held)
    run_json("decode", coded, "-o", back, *held)
    check(np.array_equal(map_quality.read_pfm(back), quantised(new, 0.5, 32)), "against a map file")
    held_to_another_kind(folder, quantised(old, 0.5, 32))


def held_to_another_kind(folder, now):
    """An earlier map of a finer step, with disparities that this one does not have: as it looks from here, or not held."""
    earlier, coded, back = now.copy(), folder / "other.tdm", folder / "other.pfm"
    earlier[3, 4] = 100
    earlier[2:-2:5, 2:-2:5] += 0.3125
    map_quality.write_pfm(folder / "earlier.pfm", earlier)
    map_quality.write_pfm(folder / "now.pfm", now)
    run_json("encode", folder / "earlier.pfm", "-o", folder / "earlier.tdm", "--step", 0.0625)
    run_json("decode", folder / "earlier.tdm", "-o", folder / "earlier.pfm")
    held = ["--against", folder / "earlier.tdm", "--reference-id", 1]
    run_json("encode", folder / "now.pfm", "-o", coded, *held, "--hold")
    run_json("decode", coded, "-o", back, *held)
    wanted = quantised(map_quality.read_pfm(folder / "earlier.pfm"), 0.5, 128)
    wanted[3, 4] = now[3, 4]
    check(np.array_equal(map_quality.read_pfm(back), wanted), "held to a map of another kind")


def bad_encode(folder):
    source, out = folder / "map.pfm", folder / "bad.tdm"
    values = scene()
    map_quality.write_pfm(source, values)

    def refuse_map(what, *words, mentions, map_file=source):
        refuse(what, "encode", map_file, "-o", out, *words, mentions=mentions, left=[out])

    refuse("no output", "encode", source, mentions=["--out"])
    refuse("no map", "encode", "-o", out, mentions=["map"])
    refuse("output without a name", "encode", source, "-o", "", mentions=["--out", "empty"])
    refuse("another ending", "encode", source, "-o", folder / "bad.pfm", mentions=["bad.pfm", "--out", ".tdm"])
    refuse("nowhere to write", "encode", source, "-o", folder / "no/where.tdm", mentions=["where.tdm"])
    for option, wrong in (("--step", ("0.3", "2", "0", "-1", "nan", "half", "")), ("--near", ("2", "-1", "yes")),
                          ("--disparities", ("0", "129", "-8", "many", "65568")),
                          ("--d0", ("2048", "-2048.1", "nan", "inf", "1e300", "far", "")),
                          ("--reference-id", ("-1", "65536", "old"))):
        for value in wrong:
            refuse_map(f"{option} {value}", f"{option}={value}", mentions=[option])
    refuse_map("an offset without digits", "--d0", "", mentions=["--d0", "empty"])
    refuse_map("a map without a name", map_file="", mentions=["map", "empty"])
    refuse_map("unknown option", "--packet", 90, mentions=["--packet"])
    for value in ("19", "1281", "-1", "all"):
        refuse_map(f"--packets {value}", f"--packets={value}", mentions=["--packets"])
    refuse_map("packets against a map", "--packets", 90, "--against", folder / "old.pfm", "--reference-id", 3,
               mentions=["--packets", "alone", "--against"])
    run_json("encode", folder / "map.pfm", "-o", folder / "packets.tdm", "--packets", 90)
    refuse_map("a reference in packets", "--against", folder / "packets.tdm", "--reference-id", 3,
               mentions=["packets.tdm", "reference", "packets"])
    values[7, 33] = 30.75
    map_quality.write_pfm(source, values)
    for disparities, step, last in ((31, 0.5, 30), (31, 0.25, 30), (20, 1, 19)):
        refuse_map(f"{disparities} disparities", "--disparities", disparities, "--step", step,
                   mentions=["map.pfm", "disparity", "px at (", f"--disparities {disparities} is {last}"])
    values = np.full((9, 11), 5.0)
    for value in (-1, 128, 127.75, 1e30):
        values[2, 3] = value
        map_quality.write_pfm(folder / "beyond.pfm", values)
        refuse_map(f"{value} px", map_file=folder / "beyond.pfm", mentions=["beyond.pfm", "disparity", "(3, 2)"])
    map_quality.write_pfm(folder / "large.pfm", np.full((481, 8), 5.0))
    refuse_map("too large", map_file=folder / "large.pfm", mentions=["large.pfm", "size", "8x481"])
    (folder / "cut.pfm").write_bytes(source.read_bytes()[:-7])
    refuse_map("truncated", map_file=folder / "cut.pfm", mentions=["cut.pfm"])
    map_quality.write_png(folder / "gray.png", np.zeros((9, 9), np.uint8))
    refuse_map("8-bit PNG", map_file=folder / "gray.png", mentions=["gray.png", "depth"])
    refuse_map("a coded map", map_file=folder / "old.tdm", mentions=["old.tdm", "magic"])
    refuse_map("no such map", map_file=folder / "none.pfm", mentions=["none.pfm"])

    refuse_map("a reference without an id", "--against", folder / "old.pfm", mentions=["--reference-id"])
    refuse_map("an id without a reference", "--reference-id", 3, mentions=["--against"])
    refuse_map("a reference without a name", "--against", "", "--reference-id", 3, mentions=["--against", "empty"])
    refuse_map("a reference of another size", "--against", folder / "beyond.pfm", "--reference-id", 3,
               mentions=["beyond.pfm"])
    map_quality.write_pfm(folder / "small.pfm", np.full((9, 11), 5.0))
    refuse_map("a reference of another size", "--against", folder / "small.pfm", "--reference-id", 3,
               mentions=["small.pfm", "size", "11x9", "80x60"])
    refuse_map("a reference that needs one", "--against", folder / "new.tdm", "--reference-id", 3,
               mentions=["new.tdm", "reference", "id 0"])
    before = (folder / "old.tdm").read_bytes()
    refuse("output over the reference", "encode", source, "-o", folder / "old.tdm", "--against", folder / "old.tdm",
           "--reference-id", 3, mentions=["old.tdm", "--out", "input"])
    (folder / "link.tdm").symlink_to(source)
    refuse("output over the map", "encode", source, "-o", folder / "link.tdm", mentions=["link.tdm", "input"])
    check((folder / "old.tdm").read_bytes() == before and map_quality.read_pfm(source).shape == (60, 80), "destroyed")


def decodes(data):
    try:
        codec_decoder.decode_map(data)
        return True
    except codec_decoder.FormatError:
        return False


def bad_decode(folder):
    good, needing, out = folder / "old.tdm", folder / "new.tdm", folder / "bad.pfm"
    coded = good.read_bytes()

    def refuse_bytes(what, data, mentions):
        (folder / "bad.tdm").write_bytes(data)
        refuse(what, "decode", folder / "bad.tdm", "-o", out, mentions=["bad.tdm", *mentions], left=[out])

    def changed(at, value):
        return coded[:at] + bytes([value]) + coded[at + 1:]

    refuse_bytes("an empty file", b"", ["header", "0 bytes"])
    refuse_bytes("half a header", coded[:8], ["header", "8 bytes"])
    refuse_bytes("another version", changed(0, 1), ["version", "1"])
    refuse_bytes("another mode", changed(0, 0x23), ["mode", "2"])
    refuse_bytes("another prior", changed(1, 0xF3), ["prior", "15"])
    refuse_bytes("another step", changed(1, 0x15), ["step", "5"])
    refuse_bytes("129 disparities", changed(2, 128), ["disparities", "129"])
    refuse_bytes("no width", coded[:3] + bytes(2) + coded[5:], ["width", "0"])
    refuse_bytes("too wide", changed(4, 3), ["width", "640"])
    refuse_bytes("no height", coded[:5] + bytes(2) + coded[7:], ["height", "0"])
    refuse_bytes("too high", changed(6, 2), ["height", "480"])
    refuse_bytes("no reference id", needing.read_bytes()[:10], ["header", "10 bytes"])
    while decodes(noise := coded[:2] + bytes([16]) + coded[3:9] + RNG.bytes(2000)):
        pass
    refuse_bytes("labels that do not exist", noise, ["labels", "row"])
    refuse_bytes("a PFM", (folder / "old.pfm").read_bytes(), ["version"])
    with (folder / "bad.tdm").open("wb") as file:
        file.write(coded)
        file.truncate(CODED_LEN_MAX + 1)
    refuse("larger than any", "decode", folder / "bad.tdm", "-o", out, mentions=["bad.tdm", str(CODED_LEN_MAX)],
           left=[out])
    with (folder / "bad.tdm").open("r+b") as file:
        file.truncate(1 << 40)
    refuse("far larger", "decode", folder / "bad.tdm", "-o", out, mentions=["bad.tdm"], left=[out])
    (folder / "bad.tdm").unlink()
    refuse("no such file", "decode", folder / "bad.tdm", "-o", out, mentions=["bad.tdm"], left=[out])
    refuse("a folder", "decode", folder, "-o", out, mentions=["regular"], left=[out])
    os.mkfifo(folder / "pipe.tdm")
    refuse("a pipe", "decode", folder / "pipe.tdm", "-o", out, mentions=["pipe.tdm", "regular"], left=[out])

    refuse("no reference", "decode", needing, "-o", out, mentions=["new.tdm", "reference", "id 0", "--against"], left=[out])
    held = ["--against", folder / "old.pfm", "--reference-id"]
    refuse("another reference", "decode", needing, "-o", out, *held, 1, mentions=["id 0", "1"], left=[out])
    refuse("a reference too many", "decode", good, "-o", out, *held, 1, mentions=["old.tdm", "alone"], left=[out])
    refuse("no id", "decode", needing, "-o", out, *held[:2], mentions=["--reference-id"], left=[out])
    refuse("another size", "decode", needing, "-o", out, "--against", folder / "small.pfm", "--reference-id", 0,
           mentions=["small.pfm", "size", "11x9", "80x60"], left=[out])
    refuse("a reference that needs one", "decode", needing, "-o", out, "--against", needing, "--reference-id", 0,
           mentions=["new.tdm", "reference"], left=[out])
    refuse("another ending", "decode", good, "-o", folder / "bad.tif", mentions=["bad.tif", "--out"])
    refuse("nowhere to write", "decode", good, "-o", folder / "no/where.pfm", mentions=["where.pfm"])
    refuse("no output", "decode", good, mentions=["--out"])
    (folder / "link.pfm").symlink_to(good)
    refuse("output over the coded map", "decode", good, "-o", folder / "link.pfm", mentions=["link.pfm", "input"])
    refuse("output over the reference", "decode", needing, "-o", folder / "old.pfm", *held, 0,
           mentions=["old.pfm", "input"])
    check(good.read_bytes() == coded, "the coded map was overwritten")


def damaged(folder):
    """Any bytes behind a header decode to a map or are refused; the same bytes as the specification's decoder."""
    coded, back = (folder / "old.tdm").read_bytes(), folder / "damaged.pfm"
    refused = 0
    for _ in range(40):
        data = bytearray(coded)
        for at in RNG.integers(9, len(data), 3):
            data[at] = RNG.integers(256)
        (folder / "damaged.tdm").write_bytes(data)
        back.unlink(missing_ok=True)
        done = run("decode", folder / "damaged.tdm", "-o", back)
        try:
            wanted = independent(folder / "damaged.tdm")
        except codec_decoder.FormatError:
            refused += 1
            check(done.returncode == 2 and len(done.stderr.splitlines()) == 1 and not back.exists(), done)
        else:
            check(done.returncode == 0 and np.array_equal(map_quality.read_pfm(back), wanted), done)
    print(f"40 damaged maps: {refused} refused")


def full_disk(folder):
    noise = folder / "noise.pfm"
    map_quality.write_pfm(noise, RNG.integers(0, 2000, (60, 80)) / 16)
    check(run("encode", noise, "-o", folder / "noise.tdm", "--step", 0.0625).returncode == 0, "noise")
    for command, source, out in (("encode", noise, folder / "full.tdm"), ("decode", folder / "noise.tdm", folder / "full.pfm")):
        for what, shell in (("a file beyond its limit", 'ulimit -f 1; exec "$@"'), ("no room to print", 'exec "$@" >/dev/full')):
            words = [TARSIER, command, source, "-o", out, *(["--step", "0.0625"] if command == "encode" else [])]
            done = subprocess.run(["bash", "-c", shell, "bash", *map(str, words)], capture_output=True, text=True, timeout=60)
            check(done.returncode == 2 and len(done.stderr.splitlines()) == 1, f"{what}: {done}")
            check(not list(folder.glob(".full.*")) and out.exists() == ("print" in what), f"{command}, {what}: the file")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    round_trip(folder)
    near(folder)
    reference(folder)
    bad_encode(folder)
    bad_decode(folder)
    damaged(folder)
    full_disk(folder)
