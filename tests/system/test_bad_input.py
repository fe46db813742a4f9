"""Bad input gets one line on stderr that names file and field, exit status 2, and nothing half-written."""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import BUILD, check, emulate, make_scene

EMULATOR = BUILD / "bin/tarsier-emulator"
SINK = BUILD / "bin/tarsier-sink"
TARSIER = BUILD / "bin/tarsier"
cases = 0


def refuse(what, command, *mentions, out=None):
    """The command must refuse with one line that mentions everything named; out must stay without results."""
    global cases
    cases += 1
    run = subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=60)
    lines = run.stderr.strip().splitlines()
    check(run.returncode == 2, f"{what}: exit status {run.returncode}: {run.stderr}")
    check(len(lines) == 1, f"{what}: {len(lines)} lines: {run.stderr}")
    for mention in mentions:
        check(mention in lines[0], f"{what}: does not name {mention}: {lines[0]}")
    if out is not None and out.is_dir():
        left = [file.name for file in out.iterdir() if file.name not in ("tarsier-run", "unfinished")]
        check(not left, f"{what}: left {left} behind")
    print(f"{what}: {lines[0]}")


def run_pair(left, right, out, *more):
    return [EMULATOR, "--pair", left, right, "--focal-px", "466", "--baseline-mm", "160", "--out", out, *more]


def copy_frames(source, target, count=3):
    target.mkdir()
    for file in sorted(source.glob("*.pgm"))[:count]:
        shutil.copy(file, target)
    return target


def with_site(scene, name, pattern, replacement, count=1):
    """A copy of the scene's site file with one edit, beside the recordings."""
    text = (scene / "site.toml").read_text()
    edited = re.sub(pattern, replacement, text, count=count)
    check(edited != text, f"{name}: the edit did not apply")
    file = scene / name
    file.write_text(edited)
    return file


def frames(folder, scene):
    out = folder / "out"
    left = scene / "left160"
    right = scene / "right160"
    refuse("no folder", run_pair(folder / "nowhere", right, out), "nowhere", out=out)
    (folder / "empty").mkdir()
    refuse("no frames", run_pair(folder / "empty", right, out), "empty", out=out)
    refuse("other size", run_pair(left, scene / "right320", out), "right320", "size", out=out)

    truncated = copy_frames(left, folder / "truncated")
    victim = truncated / "001.pgm"
    victim.write_bytes(victim.read_bytes()[:5000])
    refuse("truncated PGM", run_pair(truncated, right, out), "001.pgm", out=out)

    lying = copy_frames(left, folder / "lying")
    (lying / "000.pgm").write_bytes(b"P5\n60000 60000\n255\n" + bytes(100))
    refuse("lying PGM", run_pair(lying, right, out), "000.pgm", out=out)

    png = copy_frames(left, folder / "png", 0)
    header = b"\x89PNG\r\n\x1a\n" + struct.pack(">I", 13) + b"IHDR" + struct.pack(">IIBBBBB", 160, 120, 8, 0, 0, 0, 0)
    (png / "000.png").write_bytes(header)
    refuse("truncated PNG", run_pair(png, right, out), "000.png", out=out)

    if os.geteuid() != 0:  # root reads everything
        locked = copy_frames(left, folder / "locked")
        (locked / "000.pgm").chmod(0)
        refuse("unreadable frame", run_pair(locked, right, out), "000.pgm", out=out)


def command_lines(folder, scene):
    out = folder / "out"
    refuse("nothing to run", [EMULATOR, "--out", out], "--pair")
    refuse("unknown option", [EMULATOR, scene / "site.toml", "--out", out, "--fast"], "--fast")
    refuse("no focal length", [EMULATOR, "--pair", scene / "left160", scene / "right160", "--out", out], "--focal-px")
    (folder / "file").write_text("in the way")
    refuse("out is a file", [EMULATOR, scene / "site.toml", "--out", folder / "file"], "file")
    refuse("out cannot be made", [EMULATOR, scene / "site.toml", "--out", "/proc/tarsier"], "/proc/tarsier")
    refuse("no sink program", [EMULATOR, scene / "site.toml", "--out", out, "--sink", folder / "nosink"], "nosink", out=out)
    refuse("a sink that does not answer", [EMULATOR, scene / "site.toml", "--out", out, "--sink", "/bin/true"],
           "/bin/true", out=out)
    refuse("seed below 0", [EMULATOR, scene / "site.toml", "--out", out, "--seed", "-1"], "--seed")
    refuse("too many disparities", run_pair(scene / "left160", scene / "right160", out, "--disparities", "129"),
           "--disparities")
    before = (scene / "site.toml").read_bytes()
    refuse("out is the site's own folder", [EMULATOR, scene / "site.toml", "--out", scene], "site.toml", "--out")
    check((scene / "site.toml").read_bytes() == before, "the site's own folder was changed")


def sites(folder, scene):
    out = folder / "out"
    edits = (("unknown pair", r"lead = 3", "lead = 77", "77"),
             ("cycle", r"parent = 1\b", "parent = 3", "parent"),
             ("unknown field", r'name = "aloe"', 'name = "aloe"\ncolour = "red"', "colour"),
             ("negative shadowing", r"shadowing_db = .*", "shadowing_db = -3", "radio.shadowing_db: -3"),
             ("CCA below the noise", r"cca_threshold_dbm = .*", "cca_threshold_dbm = -120", "radio.cca_threshold_dbm: -120"),
             ("empty battery", r"capacity_mah = .*", "capacity_mah = 0", "battery.capacity_mah: 0"),
             ("a converter that gains", r"converter_efficiency_percent = .*", "converter_efficiency_percent = 101",
              "battery.converter_efficiency_percent: 101"),
             ("not TOML", r"\[site\]", "[site", "not_TOML.toml:1"),
             ("negative baseline", r"baseline_mm = 160", "baseline_mm = -160", "baseline_mm"),
             ("two gateways", r'role = "relay"', 'role = "gateway"', "gateway"),
             ("unknown role", r'role = "relay"', 'role = "router"', "role"),
             ("no recordings", r'frames = "left160"\n', "", "node 3: frames"),
             ("no second camera", r'frames_right = "right320"\n', "", "frames_right"),
             ("watch period too long", r"watch_period_ms = 1000", "watch_period_ms = 4294968", "watch_period_ms"),
             ("watched outside", r"watch_period_ms = 1000", "watch_period_ms = 1000\nwatch = [[9999, 0, 1, 1]]", "watch"),
             ("watched outside the picture", r"watch_period_ms = 1000", "watch_period_ms = 1000\nwatch = [[639, 0, 1, 1]]", "watch"),
             ("fault in the past", r"\Z", '\n[[fault]]\nat_s = -1\nkind = "reboot"\nnode = 3\n', "fault 1: at_s: -1 is outside"),
             ("fault of nobody", r"\Z", '\n[[fault]]\nat_s = 1\nkind = "reboot"\nnode = 99\n', "fault 1: node: there is no node 99"),
             ("unknown kind of fault", r"\Z", '\n[[fault]]\nat_s = 1\nkind = "flood"\nnode = 3\n', "fault 1: kind: 'flood'"),
             ("fault with an unknown field", r"\Z", '\n[[fault]]\nat_s = 1\nkind = "sink restart"\ncolor = 3\n', "fault 1: color: unknown"),
             ("a line without end", r"\[site\]", "a" + ".a" * 60000 + " = 1\n[site]", "longer"),
             ("no ground truth", r'truth = "truth160"', 'truth = "nowhere"', "nowhere"),
             ("missing recordings", r'frames = "left160"', 'frames = "nowhere"', "nowhere"))
    for name, pattern, replacement, mention in edits:
        file = with_site(scene, name.replace(" ", "_") + ".toml", pattern, replacement)
        refuse(name, [EMULATOR, file, "--out", out], mention, out=out)
    refuse("no site file", [EMULATOR, scene / "none.toml", "--out", out], "none.toml", out=out)


def faults(folder):
    """Of scenarios: the same tables, the same words, with the line."""
    file = folder / "scenario.toml"
    head = 'name = "t"\nduration_s = 20\n[scene]\nkind = "tank"\n[[fault]]\n'
    for name, tables, mention in (("a negative time", 'at_s = -1\nkind = "death"\nnode = 1\n', "scenario.toml:6: fault 1: at_s: -1 is outside"),
                                  ("after the end", 'at_s = 21\nkind = "death"\nnode = 1\n', "scenario.toml:5: fault 1: at_s: is after"),
                                  ("a key of another kind", 'at_s = 1\nkind = "death"\nnode = 1\nfor_s = 2\n', "scenario.toml:9: fault 1: for_s"),
                                  ("a gateway's camera", 'at_s = 1\nkind = "camera failure"\nnode = 8\n', "scenario.toml:5: fault 1: node: node 8"),
                                  ("an unknown key", 'at_s = 1\nkind = "death"\nnode = 1\ntypo = 2\n', "scenario.toml:9: fault 1: typo: unknown")):
        file.write_text(head + tables)
        refuse(f"fault of a scenario: {name}", [EMULATOR, file, "--out", folder / "out"], mention, out=folder / "out")


def geometry(folder, scene):
    """A right camera turned by 10 degrees, and one ahead of the left one: neither pair can be rectified."""
    turned = "[pair.right]\nposition_m = [{x}, {y}, 1.2]\nrotation = {r}\n"
    upright = "[1, 0, 0, 0, 0, 1, 0, -1, 0]"
    cases = (("converging cameras", turned.format(x=-0.14, y=0, r="[0.985, 0.1736, 0, 0, 0, 1, 0.1736, -0.985, 0]")),
             ("epipole in the image", turned.format(x=-0.3, y=0.16, r=upright)))
    text = (scene / "site.toml").read_text()
    at = text.index("[[pair]]", text.index("[[pair]]") + 1)
    for name, right in cases:
        file = scene / (name.replace(" ", "_") + ".toml")
        file.write_text(text[:at] + right + "\n" + text[at:])
        refuse(name, [EMULATOR, file, "--out", folder / "out"], "two boards", out=folder / "out")


RIG = """%YAML:1.0
---
image_width: 640
image_height: 480
K1: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 500., 240., 0., 0., 1. ]
K2: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 500., 0., 320., 0., 500., 240., 0., 0., 1. ]
R: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
T: [ -60., 0.5, 1. ]
"""


def calibrations(folder):
    """tarsier rectify-table: calibrations that are damaged, or that no table can follow."""
    table = folder / "rig.rect"

    def command(name, text, *more):
        file = folder / name
        file.write_text(text)
        return [TARSIER, "rectify-table", file, "-o", table, *more]

    good = subprocess.run([str(word) for word in command("good.yml", RIG)], capture_output=True, text=True)
    check(good.returncode == 0 and table.stat().st_size > 400, f"a good calibration: {good.stderr}")
    check("baseline_mm = 60.0104" in good.stdout, f"a good calibration prints: {good.stdout}")
    table.unlink()
    edits = (("no left camera", "K1:", "Q1:", "K1", "missing"),
             ("two rows of three", "rows: 3", "rows: 2", "good.yml:5", "K1", "9 values"),
             ("no number", "[ -60.", "[ wide", "T", "finite"),
             ("a mirror", "[ 1., 0., 0., 0., 1.", "[ 1., 0., 0., 0., -1.", "R", "rotation"),
             ("epipole in view", "[ -60., 0.5, 1. ]", "[ -6., 0.5, 60. ]", "T", "epipole"),
             ("one above the other", "[ -60., 0.5, 1. ]", "[ -6., 60., 1. ]", "T", "above"),
             ("cameras exchanged", "[ -60., 0.5, 1. ]", "[ 60., 0.5, 1. ]", "T", "exchange"),
             ("no YAML", "image_width: 640", "image_width: [640", "good.yml", "YAML"),
             ("larger than a node", "image_width: 640", "image_width: 1280", "1280x480"))
    for name, old, new, *mentions in edits:
        refuse(f"calibration: {name}", command("good.yml", RIG.replace(old, new, 1)), *mentions)
    refuse("calibration: one size only", command("good.yml", RIG, "--width", "320"), "--height")
    refuse("calibration: no size", command("good.yml", RIG, "--source", "320"), "--source", "WIDTHxHEIGHT")
    refuse("calibration: no step", command("good.yml", RIG, "--step", "7"), "--step")
    refuse("calibration: no file", [TARSIER, "rectify-table", folder / "none.yml", "-o", table], "none.yml")
    refuse("calibration: another size than it says", command("good.yml", RIG, "--calibrated", "320x240"), "--calibrated",
           "640x480")
    refuse("calibration: no width", command("good.yml", RIG, "--width", "0", "--height", "0"), "--width", "above 0")
    for option, value in (("--zoom", "nan"), ("--zoom", "1.5"), ("--unit-mm", "nan"), ("--unit-mm", "0")):
        refuse(f"calibration: {option} {value}", command("good.yml", RIG, option, value), option, "takes")
    header = folder / "rig.h"
    nowhere = command("good.yml", RIG, "--c-header", header)
    nowhere[4] = folder / "no/such/folder/rig.rect"
    refuse("calibration: nowhere to write", nowhere, "no/such/folder")
    check(not header.exists(), "a table that could not be written left its header")
    refuse("calibration: header without a name", command("good.yml", RIG, "--c-header", ""), "--c-header", "empty")
    refuse("calibration: header over the table", command("good.yml", RIG, "--c-header", table), "--c-header", "--out")
    refuse("calibration: header over the calibration", command("good.yml", RIG, "--c-header", folder / "good.yml"),
           "good.yml", "--c-header", "input")
    over = command("good.yml", RIG)
    over[4] = folder / "good.yml"
    refuse("calibration: table over the calibration", over, "good.yml", "--out", "input")
    check((folder / "good.yml").read_text() == RIG, "the calibration was overwritten")
    check(not table.exists(), "a refused calibration left a table")


def keys(folder, scene):
    emulate(scene / "site.toml", folder / "good")
    text = (folder / "good/keys.toml").read_text()

    def sink(file):
        return [SINK, scene / "site.toml", "--keys", file, "--db", folder / "k.db", "--out", folder / "k",
                "--listen", f"unix:{folder / 'k.socket'}"]

    def with_keys(name, content, mode=0o600):
        file = folder / name
        file.write_text(content)
        file.chmod(mode)
        return file

    short = re.sub(r'link_key = "..', 'link_key = "', text)
    refuse("short key", sink(with_keys("short.toml", short)), "short.toml", "link_key")
    refuse("no hex key", sink(with_keys("nohex.toml", re.sub(r'link_key = "..', 'link_key = "zz', text))), "link_key")
    refuse("readable keys", sink(with_keys("open.toml", text, 0o644)), "open.toml")
    nowhere = sink(folder / "good/keys.toml")
    nowhere[nowhere.index("--listen") + 1] = f"unix:{folder}/no/such/folder/socket"
    refuse("a socket nowhere", nowhere, "no/such/folder", "bind")
    check(not (folder / "k.db").exists(), "a refused key file or address left a database")
    memory = sink(folder / "good/keys.toml")
    memory[memory.index("--db") + 1] = ":memory:"
    refuse("a database not on disk", memory, ":memory:")
    (folder / "text.db").write_text("no database at all, but long enough to be read as one" * 20)
    memory[memory.index(":memory:")] = folder / "text.db"
    refuse("a database that is none", memory, "text.db")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    scene = folder / "scene"
    make_scene("test_bad_input", scene)
    frames(folder, scene)
    command_lines(folder, scene)
    sites(folder, scene)
    faults(folder)
    geometry(folder, scene)
    calibrations(folder)
    keys(folder, scene)
    print(f"{cases} cases refused")
