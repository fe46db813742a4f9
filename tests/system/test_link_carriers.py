"""The gateway link stores the same maps over TCP and over a serial port as over the socket it inherits."""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import sys
import tempfile

SUPPORT = pathlib.Path(__file__).resolve().parents[1] / "support"
sys.path.insert(0, str(SUPPORT))
from run_site import check, emulate, make_scene, stored_maps



def carriers():
    """TCP, and a serial port where there are pseudo-terminals to stand in for one."""
    yield "tcp", "127.0.0.1"
    try:
        for descriptor in os.openpty():
            os.close(descriptor)
    except OSError as error:
        print(f"tarsier skipped: test_link_carriers: its serial port: {error}")
        return
    yield "serial", "/dev/pts/"


with tempfile.TemporaryDirectory() as folder:
    folder = pathlib.Path(folder)
    site = make_scene("test_link_carriers", folder / "scene")
    emulate(site, folder / "inherited")
    for carrier, named in carriers():
        os.environ["TSR_LINK"] = carrier
        out = folder / carrier
        emulate(site, out, "--sink", SUPPORT / "carried_sink.py")
        check(named in (out / "sink.log").read_text(), f"the sink did not listen on {carrier}")
        check(stored_maps(out) == stored_maps(folder / "inherited"), f"other maps over {carrier}")
        check((out / "capture.pcapng").read_bytes() == (folder / "inherited/capture.pcapng").read_bytes(),
              f"other frames on air over {carrier}")
        print(f"{carrier}: {len(stored_maps(out))} maps")
