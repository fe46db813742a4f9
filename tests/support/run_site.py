"""Run the demo's scene through the emulator and read what came out."""
# SPDX-License-Identifier: Apache-2.0
import hashlib
import json
import os
import pathlib
import signal
import subprocess
import sys

BUILD = pathlib.Path(os.environ["TSR_BUILD"])
PICTURES = pathlib.Path("/usr/share/doc/opencv-doc/examples/data")
SKIPPED = 77


def skip(test, reason):
    """End this test as skipped; tools/test shows the line."""
    print(f"tarsier skipped: {test}: {reason}")
    sys.exit(SKIPPED)


def make_scene(test, out):
    """The demo's recorded folders and site.toml in out."""
    if not (PICTURES / "aloeL.jpg").exists():
        skip(test, "opencv-doc is not installed")
    subprocess.run([BUILD / "bin/tarsier", "demo-scene", "--pictures", PICTURES, "--out", out], check=True)
    return out / "site.toml"


def emulate(site, out, *options):
    """Run to the end; returns summary.json."""
    subprocess.run([BUILD / "bin/tarsier-emulator", site, "--out", out, "--quiet", *options], check=True,
                   stdout=subprocess.DEVNULL)
    return json.loads((out / "summary.json").read_text())


def start_emulator(site, out, *options):
    return subprocess.Popen([BUILD / "bin/tarsier-emulator", site, "--out", out, "--quiet", *options],
                            stdout=subprocess.DEVNULL)


def child_named(pid, name):
    """The first child process of pid with this command name, or None."""
    try:
        children = pathlib.Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        for child in children:
            if pathlib.Path(f"/proc/{child}/comm").read_text().strip() == name[:15]:
                return int(child)
    except OSError:
        pass
    return None


def kill_quietly(pid):
    try:
        os.kill(pid, signal.SIGKILL)
        return True
    except ProcessLookupError:
        return False


def stored_maps(out):
    """(node, digest of the decoded map) in order of arrival, for each stored map."""
    received = json.loads((out / "sink.json").read_text())["received"]
    return [(entry["node"], hashlib.sha256((out / (entry["file"] + ".pfm")).read_bytes()).hexdigest())
            for entry in received]


def results(out):
    """Contents by name of what a run wrote, but for how long it took."""
    files = {name: (out / name).read_bytes() for name in
             ("cloud.ply", "capture.pcapng", "sink.json", "events.csv", "nodes.csv", "links.csv", "maps.csv")}
    files.update({f"maps/{file.name}": file.read_bytes() for file in (out / "maps").iterdir()})
    summary = json.loads((out / "summary.json").read_text())
    del summary["wall_time_s"]
    files["summary.json"] = json.dumps(summary).encode()
    return files


def check(condition, message):
    if not condition:
        print("FAILED:", message)
        sys.exit(1)
