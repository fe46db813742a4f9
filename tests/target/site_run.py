"""Run tarsier-node.elf, the firmware on the Cortex-M4, against a real sink. Not a test.

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib
import re
import struct
import subprocess
import time

import board
import pictures

GATEWAY, LEAD, WING = 1, 3, 4  # of firmware/app/mps2_an386.c, as are the keys
LINK_KEY_BYTE, PAIR_KEY_BYTE = 0xc0, 0xc1
KEY_LEN = 16
TIMEOUT_S = 120


def board_site(demo_site):
    """The demo's site without its relay and its binocular node; the lead's parent is the gateway."""
    head, *tables = re.split(r"(?m)^(?=\[\[)", demo_site)
    kept = [table for table in tables if re.search(rf"(?m)^(id = ({GATEWAY}|{LEAD}|{WING})|lead = {LEAD})$", table)]
    if len(kept) != 4:
        raise board.BoardError("the demo's site has other nodes than expected")
    return head + "".join(re.sub(r"parent = 2\b", f"parent = {GATEWAY}", table) for table in kept)


def key_text(byte):
    return (bytes([byte]) * KEY_LEN).hex()


def key_file():
    text = f'test = true\nlink_key = "{key_text(LINK_KEY_BYTE)}"\n'
    for node in (GATEWAY, LEAD, WING):
        text += f'\n[[node]]\nid = {node}\nkey = "{key_text(node)}"\n'
    return text + f'\n[[pair]]\nlead = {LEAD}\nwing = {WING}\nkey = "{key_text(PAIR_KEY_BYTE)}"\n'


def start_sink(work, scene):
    program = board.HOST_BUILD / "bin/tarsier-sink"
    if not os.access(program, os.X_OK):
        raise board.Missing(f"{program} is not built")
    (work / "site.toml").write_text(board_site((scene / "site.toml").read_text("utf-8")), "utf-8")
    (work / "keys.toml").write_text(key_file(), "utf-8")
    (work / "keys.toml").chmod(0o600)
    socket = work / "sink.socket"
    sink = subprocess.Popen([program, work / "site.toml", "--keys", work / "keys.toml", "--db", work / "sink.db",
                             "--listen", f"unix:{socket}", "--out", work / "out", "--once"],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    end = time.monotonic() + 30
    while not socket.exists() and sink.poll() is None and time.monotonic() < end:
        time.sleep(0.02)
    return sink, socket


def views(scene):
    return [scene / f"{side}160/{pictures.FRAME_AFTER}.pgm" for side in ("left", "right")]


def run(work):
    """One map from picture to sink: the counters that the image prints, and the maps that the sink has written."""
    work = pathlib.Path(work)
    image = board.build("tarsier-node") / "tarsier-node.elf"
    scene = pictures.demo_scene(work)
    sink, socket = start_sink(work, scene)
    try:
        code, report = board.run_image(image, views(scene), work, TIMEOUT_S, ("-serial", f"unix:{socket}"))
        log = sink.communicate(timeout=TIMEOUT_S)[0]
    finally:
        sink.kill()
        sink.wait()
    if code != 0 or sink.returncode != 0:
        raise board.BoardError(f"image: exit {code}: {report}\nsink: exit {sink.returncode}: {log}")
    counters = {name: int(value) for name, value in re.findall(r"(\w+) (\d+)", report)}
    return counters, sorted((work / "out/maps").glob("*.pfm"))


def read_pfm(path):
    """Disparities, top row first."""
    header = re.match(rb"Pf\s+(\d+)\s+(\d+)\s+-\S+\s", path.read_bytes())
    if header is None:
        raise board.BoardError(f"{path}: not a little-endian PFM")
    width, height = int(header[1]), int(header[2])
    data = path.read_bytes()[header.end():]
    rows = [struct.unpack_from(f"<{width}f", data, 4 * width * y) for y in range(height)]
    return [value for row in reversed(rows) for value in row]
