#!/usr/bin/env python3
"""Stands in for tarsier-sink on the socket it inherits and carries the bytes to a real one on TSR_LINK: tcp or serial.

Takes tarsier-sink's own arguments; the real program comes from TSR_BUILD. A serial port is a pseudo-terminal.
"""
# SPDX-License-Identifier: Apache-2.0
import os
import pathlib
import select
import socket
import subprocess
import sys
import termios
import time


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def connect(port):
    for _ in range(500):
        try:
            return socket.create_connection(("127.0.0.1", port)).detach()
        except ConnectionRefusedError:
            time.sleep(0.01)
    sys.exit(1)


def wait_until_raw(port):
    """The sink has opened it then, and flushes no byte any more."""
    while termios.tcgetattr(port)[3] & termios.ECHO:
        time.sleep(0.01)


def carry(first, second):
    """Bytes both ways between two descriptors until one side closes."""
    while True:
        for ready in select.select([first, second], [], [])[0]:
            data = os.read(ready, 4096)
            if not data:
                return
            to = second if ready is first else first
            while data:
                data = data[os.write(to, data):]


def unmarked_keys(file):
    """The same keys without the mark of test keys, which a serial port refuses."""
    copy = pathlib.Path(file).with_name("serial_keys.toml")
    copy.touch(0o600)
    copy.write_text(pathlib.Path(file).read_text().replace("test = true", "test = false"))
    return str(copy)


def main():
    words = sys.argv[1:]
    listen, keys = words.index("--listen") + 1, words.index("--keys") + 1
    downstream = socket.socket(fileno=int(words[listen].removeprefix("fd:")))
    upstream = None
    if os.environ["TSR_LINK"] == "serial":
        upstream, far_end = os.openpty()
        words[listen] = f"serial:{os.ttyname(far_end)}:115200"
        words[keys] = unmarked_keys(words[keys])
    else:
        port = free_port()
        words[listen] = f"tcp:127.0.0.1:{port}"
    sink = subprocess.Popen([pathlib.Path(os.environ["TSR_BUILD"]) / "bin/tarsier-sink", *words])
    if upstream is None:
        upstream = connect(port)
    else:
        wait_until_raw(far_end)
    carry(downstream.fileno(), upstream)
    sink.terminate()  # it exports; nobody hangs up a serial line, and a TCP listener waits for another gateway
    sys.exit(sink.wait())


main()
