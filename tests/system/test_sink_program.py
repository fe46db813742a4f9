#!/usr/bin/env python3
"""tarsier-sink as a process: refusals, a link that talks nonsense, signals, restarts.

The link's framing is written here from RFC 1662, not taken from the firmware.

SPDX-License-Identifier: Apache-2.0
"""
import json
import os
import pathlib
import random
import resource
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = pathlib.Path(os.environ.get("TSR_BUILD", "build")) / "bin" / "tarsier-sink"
HELLO, UPLINK, ANSWER = 1, 2, 3

SITE = """[site]
name = "program test"
pan_id = 0xbeef
[[node]]
id = 1
role = "gateway"
[[node]]
id = 2
role = "binocular"
parent = 1
[[pair]]
name = "porch"
lead = 2
width = 32
height = 24
disparities = 16
focal_px = 100
baseline_mm = 60
"""
KEYS = "test = true\nlink_key = '%s'\n" % ("0" * 32) + "".join(
    "[[node]]\nid = %d\nkey = '%032x'\n" % (node, node) for node in (1, 2))


def fcs16(data):
    """RFC 1662, appendix C.2, bit by bit."""
    fcs = 0xFFFF
    for byte in data:
        fcs ^= byte
        for _ in range(8):
            fcs = (fcs >> 1) ^ 0x8408 if fcs & 1 else fcs >> 1
    return fcs ^ 0xFFFF


def frame(kind, sequence, body):
    content = bytes([kind]) + sequence.to_bytes(2, "little") + body
    content += fcs16(content).to_bytes(2, "little")
    escaped = b"".join(bytes([0x7D, b ^ 0x20]) if b in (0x7D, 0x7E) else bytes([b]) for b in content)
    return b"\x7e" + escaped + b"\x7e"


def read_answer(link):
    """Sequence and body of the next ANSWER."""
    content, escape = bytearray(), False
    while True:
        byte = link.recv(1)
        if not byte:
            raise EOFError("the sink closed the link")
        if byte == b"\x7e":
            if content:
                break
        elif byte == b"\x7d":
            escape = True
        else:
            content.append(byte[0] ^ (0x20 if escape else 0))
            escape = False
    assert fcs16(content[:-2]) == int.from_bytes(content[-2:], "little")
    assert content[0] == ANSWER
    return int.from_bytes(content[1:3], "little"), bytes(content[3:-2])


class SinkProgram(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.folder = pathlib.Path(self.temporary.name)
        (self.folder / "site.toml").write_text(SITE)
        self.write_keys(KEYS)
        self.process = None

    def tearDown(self):
        if self.process is not None and self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.temporary.cleanup()

    def write_keys(self, text, mode=0o600):
        keys = self.folder / "keys.toml"
        keys.write_text(text)
        keys.chmod(mode)

    def arguments(self, **changes):
        options = {"--keys": "keys.toml", "--db": "sink.db", "--listen": "unix:link", "--out": "out", **changes}
        words = [str(PROGRAM.absolute()), "site.toml"]
        for name, value in options.items():
            words += [] if value is None else [name, value] if value != "" else [name]
        return words

    def run_sink(self, *extra, **changes):
        return subprocess.run([*self.arguments(**changes), *extra], cwd=self.folder, capture_output=True, text=True,
                              timeout=30)

    def start(self):
        with (self.folder / "log").open("w") as log:
            self.process = subprocess.Popen(self.arguments(), cwd=self.folder, stderr=log)
        return self.connect()

    def connect(self):
        link = socket.socket(socket.AF_UNIX)
        link.settimeout(10)
        for _ in range(500):
            try:
                link.connect(str(self.folder / "link"))
                return link
            except OSError:
                time.sleep(0.01)
        self.fail("the sink does not listen")

    def expect_refused(self, result, text):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn(text, result.stderr)
        self.assertFalse((self.folder / "out").exists())

    def test_refusals_are_one_line_and_status_2(self):
        self.expect_refused(self.run_sink("--nonsense"), "command line: ")
        self.expect_refused(self.run_sink(**{"--db": None}), "command line: --db is required")
        self.expect_refused(self.run_sink(**{"--keys": None}), "are required without --export-only")
        self.expect_refused(self.run_sink(**{"--listen": "pigeon:home"}), "--listen pigeon:home: kind")
        self.expect_refused(self.run_sink(**{"--listen": "serial:/dev/null:115200"}), "test keys are refused")
        self.expect_refused(self.run_sink(**{"--db": "no/folder.db"}), "no/folder.db: SQLite")
        self.expect_refused(self.run_sink("--export-only", **{"--db": "absent.db"}), "absent.db: SQLite")
        self.assertFalse((self.folder / "absent.db").exists())
        self.write_keys(KEYS, 0o644)
        self.expect_refused(self.run_sink(), "keys.toml: mode")
        self.write_keys(KEYS.replace("0" * 32, "0" * 31))
        self.expect_refused(self.run_sink(), "link_key: 31 characters")
        self.write_keys(KEYS.split("[[node]]\nid = 2")[0])
        self.expect_refused(self.run_sink(), "no key for node 2")
        (self.folder / "site.toml").write_text(SITE.replace("parent = 1", "parent = 7"))
        self.expect_refused(self.run_sink(), "site.toml:7: node 2: parent: there is no node 7")
        (self.folder / "site.toml").unlink()
        self.expect_refused(self.run_sink(), "site.toml: No such file")

    def test_every_frame_is_answered_and_nonsense_is_counted(self):
        link = self.start()
        link.sendall(frame(HELLO, 0, bytes([1, 0xEF, 0xBE, 1, 0])))
        self.assertEqual(read_answer(link), (0, b""))
        rng = random.Random(5)
        for sequence in range(1, 200):
            link.sendall(rng.randbytes(rng.randrange(60)) + b"\x7e")
            body = rng.randbytes(8 + rng.randrange(103))
            link.sendall(frame(UPLINK, sequence, body))
            self.assertEqual(read_answer(link), (sequence, b""))
        link.close()
        self.process.send_signal(signal.SIGTERM)
        self.assertEqual(self.process.wait(20), 0)
        numbers = json.loads((self.folder / "out" / "sink.json").read_text())
        self.assertEqual(numbers["session"]["link"]["uplinks"], 199)
        self.assertGreater(numbers["session"]["refused"]["link_damaged"], 100)
        self.assertEqual(numbers["maps"]["received"], 0)
        self.assertFalse((self.folder / "link").exists())

    def test_a_connection_waits_while_there_is_no_descriptor_for_it(self):
        hello = frame(HELLO, 0, bytes([1, 0xEF, 0xBE, 1, 0]))
        first = self.start()
        first.sendall(hello)
        self.assertEqual(read_answer(first), (0, b""))
        pid = self.process.pid
        used = 1 + max(int(name) for name in os.listdir(f"/proc/{pid}/fd"))
        before = resource.prlimit(pid, resource.RLIMIT_NOFILE)
        resource.prlimit(pid, resource.RLIMIT_NOFILE, (used, before[1]))
        second = self.connect()
        second.sendall(hello)
        time.sleep(1.5)
        told = (self.folder / "log").read_text().count("a connection waits")
        self.assertGreater(told, 0)
        self.assertLess(told, 10, "it asks without a pause")  # once a second; a machine may stall
        resource.prlimit(pid, resource.RLIMIT_NOFILE, before)
        self.assertEqual(read_answer(second), (0, b""))

    def test_a_killed_sink_starts_again_and_interrupt_exports(self):
        self.start().close()
        self.process.kill()
        self.process.wait()
        self.assertTrue((self.folder / "link").exists())
        link = self.start()
        self.process.send_signal(signal.SIGINT)
        self.assertEqual(self.process.wait(20), 0)
        link.close()
        first = (self.folder / "out" / "sink.json").read_bytes()
        result = self.run_sink("--export-only", **{"--keys": None, "--listen": None})
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual((self.folder / "out" / "sink.json").read_bytes(), first)
        self.assertTrue((self.folder / "out" / "cloud.ply").read_bytes().startswith(b"ply\n"))


if __name__ == "__main__":
    if not PROGRAM.exists():
        print(f"tarsier skipped: test_sink_program: {PROGRAM} is not built")
        sys.exit(77)
    unittest.main()
