"""tshark reads the capture, decrypts every data frame with the link key, and finds nothing malformed."""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, emulate, make_scene, skip

FIELDS = ("wpan.frame_type", "wpan.fcs_ok", "wpan.src16", "data.data", "_ws.expert.message", "_ws.malformed")
DATA_FRAME, ACK_FRAME = "0x0001", "0x0002"


def dissect(capture, key, pan_id, nodes):
    """One tuple of FIELDS for each frame."""
    command = ["tshark", "-r", capture, "-T", "fields", "-o", f'uat:ieee802154_keys:"{key}","1","No hash"']
    for node in nodes:
        command += ["-o", f'uat:802154_addresses:"{node:04x}","{pan_id:04x}",02545352{pan_id:04x}{node:04x}']
    for field in FIELDS:
        command += ["-e", field]
    text = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    return [tuple(line.split("\t")) for line in text.splitlines()]


if shutil.which("tshark") is None:
    skip("test_capture", "tshark is not installed")
with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    summary = emulate(make_scene("test_capture", folder / "scene"), folder / "out")
    key = re.search(r'link_key = "([0-9a-f]{32})"', (folder / "out/keys.toml").read_text()).group(1)
    nodes = [node["id"] for node in summary["nodes"]]
    frames = dissect(folder / "out/capture.pcapng", key, 0xBEEF, nodes)
    check(len(frames) == summary["totals"]["air_frames"], "frames in the capture and on air differ")
    for number, (kind, fcs_ok, source, data, expert, malformed) in enumerate(frames, 1):
        check(kind in (DATA_FRAME, ACK_FRAME), f"frame {number}: type {kind}")
        check(not expert and not malformed, f"frame {number}: {expert} {malformed}")
        check(fcs_ok in ("1", "True"), f"frame {number}: FCS")
        if kind == DATA_FRAME:
            # Decrypted, a frame holds a fragment: dispatch 0x10 or 0x11, docs/wire_format.md.
            check(data[:2] in ("10", "11"), f"frame {number}: does not decrypt to a fragment: {data[:8]}")
    wrong = dissect(folder / "out/capture.pcapng", "00" * 16, 0xBEEF, nodes)
    check(any("decrypt" in frame[4] for frame in wrong), "a wrong key is not noticed")
    print(f"{len(frames)} frames")
