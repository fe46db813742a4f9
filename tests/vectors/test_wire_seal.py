"""Frames and messages sealed by the C open with another AES-CCM, and the other way round.

The Python side is written from the formats in tsr/wire/{frame,message,address,fragment}.h
and the clauses they cite, and seals with python3-cryptography. The C side gets its AES
block from Python, too, so nothing but the format is shared.
"""
# SPDX-License-Identifier: Apache-2.0
import ctypes
import os
import pathlib
import random
import struct
import subprocess
import sys
import unittest

NAME = "vectors/test_wire_seal"
try:
    from cryptography.exceptions import InvalidTag
    from cryptography.hazmat.primitives.ciphers import Cipher, algorithms, modes
    from cryptography.hazmat.primitives.ciphers.aead import AESCCM
except ImportError:
    print(f"tarsier skipped: {NAME}: python3-cryptography is not installed")
    sys.exit(77)

SEED = int(os.environ.get("SEED", "1"))
RUNS = int(os.environ.get("RUNS", "300"))
OK, ERR_FORMAT, ERR_AUTH = 0, -4, -6


def library_path():
    build = pathlib.Path(os.environ.get("TSR_BUILD", "build/release"))
    found = sorted(build.rglob("libtsr_firmware.so"))
    if not found:
        sys.exit(f"no libtsr_firmware.so under {build}")
    return str(found[0])


def preload_sanitizer(library):
    """A library built with AddressSanitizer wants its runtime loaded before Python."""
    if "libasan" in os.environ.get("LD_PRELOAD", ""):
        return
    needed = subprocess.run(["ldd", library], capture_output=True, text=True, check=True).stdout
    runtime = [line.split()[2] for line in needed.splitlines() if "libasan" in line]
    if runtime:
        os.environ["LD_PRELOAD"] = runtime[0]
        os.environ["ASAN_OPTIONS"] = "detect_leaks=0"
        os.execv(sys.executable, [sys.executable, *sys.argv])


LIBRARY_PATH = library_path()
preload_sanitizer(LIBRARY_PATH)
LIBRARY = ctypes.CDLL(LIBRARY_PATH)

U8P = ctypes.POINTER(ctypes.c_uint8)
EXPAND = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, U8P)
ENCRYPT = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p, U8P, U8P)


class AesOps(ctypes.Structure):
    _fields_ = [("expand", EXPAND), ("encrypt", ENCRYPT)]


class CipherState(ctypes.Structure):
    _fields_ = [("ops", ctypes.POINTER(AesOps)), ("key", ctypes.c_uint64 * 36)]


class FrameHeader(ctypes.Structure):
    _fields_ = [("sequence", ctypes.c_uint8), ("ack_request", ctypes.c_bool), ("pan_id", ctypes.c_uint16),
                ("destination", ctypes.c_uint16), ("source", ctypes.c_uint16), ("counter", ctypes.c_uint32)]


class MessageHeader(ctypes.Structure):
    _fields_ = [("kind", ctypes.c_uint8), ("key_use", ctypes.c_uint8), ("origin", ctypes.c_uint16),
                ("destination", ctypes.c_uint16), ("counter", ctypes.c_uint32)]


@EXPAND
def expand(state, key):
    ctypes.memmove(state, key, 16)
    return OK


@ENCRYPT
def encrypt(state, block, out):
    aes = Cipher(algorithms.AES(ctypes.string_at(state, 16)), modes.ECB()).encryptor()
    ctypes.memmove(out, aes.update(ctypes.string_at(block, 16)), 16)
    return OK


OPS = AesOps(expand, encrypt)


def cipher_of(key):
    state = CipherState()
    assert LIBRARY.tsr_cipher_init(ctypes.byref(state), ctypes.byref(OPS), key) == OK
    return state


# The formats, from the headers' words. -------------------------------------


def crc16(data, start=0):
    """x^16 + x^12 + x^5 + 1, bits reflected (IEEE 802.15.4-2015, 7.2.11)."""
    crc = start
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ 0x8408 if crc & 1 else crc >> 1
    return crc


def frame_parts(pan, destination, source, sequence, counter, ack):
    """MHR with auxiliary header, and nonce."""
    control = 1 | 1 << 3 | ack << 5 | 1 << 6 | 2 << 10 | 1 << 12 | 2 << 14
    security = 6 | 1 << 3  # ENC-MIC-64, key identifier mode 1
    header = struct.pack("<HBHHHBIB", control, sequence, pan, destination, source, security, counter, 1)
    eui64 = bytes((0x02, 0x54, 0x53, 0x52)) + struct.pack(">HH", pan, source)
    return header, eui64 + struct.pack(">IB", counter, 6)


def message_parts(kind, key_use, origin, destination, counter):
    """Header in clear, nonce, associated data."""
    return (struct.pack("<BBI", kind, key_use, counter),
            struct.pack("<HHIB4x", origin, destination, counter, kind),
            struct.pack("<HHBBI", origin, destination, kind, key_use, counter))


class Seal(unittest.TestCase):
    def setUp(self):
        self.random = random.Random(SEED)

    def cases(self):
        for run in range(RUNS):
            with self.subTest(replay=f"SEED={SEED} RUNS={RUNS}", run=run):
                yield self.random

    def frame_fields(self, rng):
        return {"pan": rng.randrange(0xFFFF), "destination": rng.randrange(0x10000), "source": rng.randrange(1, 0xFFFE),
                "sequence": rng.randrange(256), "counter": rng.randrange(0xFFFFFFFF), "ack": rng.randrange(2)}

    def test_frames_from_c(self):
        for rng in self.cases():
            key, payload, fields = rng.randbytes(16), rng.randbytes(rng.randrange(103)), self.frame_fields(rng)
            header = FrameHeader(fields["sequence"], bool(fields["ack"]), fields["pan"], fields["destination"],
                                 fields["source"], fields["counter"])
            psdu, length = ctypes.create_string_buffer(127), ctypes.c_size_t()
            self.assertEqual(LIBRARY.tsr_frame_seal(ctypes.byref(header), ctypes.byref(cipher_of(key)), payload,
                                                    ctypes.c_size_t(len(payload)), psdu, ctypes.c_size_t(127),
                                                    ctypes.byref(length)), OK)
            frame = psdu.raw[:length.value]
            mhr, nonce = frame_parts(**fields)
            self.assertEqual(frame[:15], mhr)
            self.assertEqual(frame[-2:], struct.pack("<H", crc16(frame[:-2])))
            self.assertEqual(AESCCM(key, tag_length=8).decrypt(nonce, frame[15:-2], mhr), payload)

    def open_frame(self, key, frame):
        out, length = ctypes.create_string_buffer(102), ctypes.c_size_t()
        status = LIBRARY.tsr_frame_open(frame, ctypes.c_size_t(len(frame)), ctypes.byref(cipher_of(key)), out,
                                        ctypes.c_size_t(102), ctypes.byref(length))
        return status, out.raw[:length.value]

    def test_frames_to_c(self):
        for rng in self.cases():
            key, payload = rng.randbytes(16), rng.randbytes(rng.randrange(103))
            mhr, nonce = frame_parts(**self.frame_fields(rng))
            frame = mhr + AESCCM(key, tag_length=8).encrypt(nonce, payload, mhr)
            self.assertEqual(self.open_frame(key, frame + struct.pack("<H", crc16(frame))), (OK, payload))
            changed = bytearray(frame)
            changed[rng.randrange(len(frame))] ^= 1 << rng.randrange(8)
            status, opened = self.open_frame(key, bytes(changed) + struct.pack("<H", crc16(changed)))
            self.assertIn(status, (ERR_AUTH, ERR_FORMAT))
            self.assertEqual(opened, b"")

    def message_fields(self, rng):
        return {"kind": rng.randrange(1, 5), "key_use": rng.randrange(1, 3), "origin": rng.randrange(0xFFFE),
                "destination": rng.randrange(0xFFFE), "counter": rng.randrange(0x100000000)}

    def body(self, rng):
        return rng.randbytes(rng.randrange(rng.choice((2, 40, 300))))

    def test_messages_from_c(self):
        for rng in self.cases():
            key, body, fields = rng.randbytes(16), self.body(rng), self.message_fields(rng)
            message = ctypes.create_string_buffer(bytes(6) + body + bytes(8), len(body) + 14)
            length = ctypes.c_size_t()
            self.assertEqual(LIBRARY.tsr_message_seal(ctypes.byref(MessageHeader(**fields)),
                                                      ctypes.byref(cipher_of(key)), message,
                                                      ctypes.c_size_t(len(message)), ctypes.c_size_t(len(body)),
                                                      ctypes.byref(length)), OK)
            self.assertEqual(length.value, len(message))
            header, nonce, associated = message_parts(**fields)
            self.assertEqual(message.raw[:6], header)
            self.assertEqual(AESCCM(key, tag_length=8).decrypt(nonce, message.raw[6:], associated), body)
            fields["origin"] ^= 1  # what a relay could forge in the fragment's header
            _, nonce, associated = message_parts(**fields)
            with self.assertRaises(InvalidTag):
                AESCCM(key, tag_length=8).decrypt(nonce, message.raw[6:], associated)

    def test_messages_to_c(self):
        for rng in self.cases():
            key, body, fields = rng.randbytes(16), self.body(rng), self.message_fields(rng)
            header, nonce, associated = message_parts(**fields)
            sealed = header + AESCCM(key, tag_length=8).encrypt(nonce, body, associated)
            message, length = ctypes.create_string_buffer(sealed, len(sealed)), ctypes.c_size_t()
            read = MessageHeader()
            self.assertEqual(LIBRARY.tsr_message_parse(message, ctypes.c_size_t(len(sealed)),
                                                       ctypes.c_uint16(fields["origin"]),
                                                       ctypes.c_uint16(fields["destination"]),
                                                       ctypes.byref(read)), OK)
            self.assertEqual({name: getattr(read, name) for name in fields}, fields)
            self.assertEqual(LIBRARY.tsr_message_open(ctypes.byref(read), ctypes.byref(cipher_of(key)), message,
                                                      ctypes.c_size_t(len(sealed)), ctypes.byref(length)), OK)
            self.assertEqual(message.raw[6:6 + length.value], body)

    def test_longest_message(self):
        key, body = bytes(range(16)), self.random.randbytes(65535)
        fields = {"kind": 3, "key_use": 1, "origin": 3, "destination": 0, "counter": 7}
        message = ctypes.create_string_buffer(bytes(6) + body + bytes(8), len(body) + 14)
        length = ctypes.c_size_t()
        self.assertEqual(LIBRARY.tsr_message_seal(ctypes.byref(MessageHeader(**fields)), ctypes.byref(cipher_of(key)),
                                                  message, ctypes.c_size_t(len(message)), ctypes.c_size_t(len(body)),
                                                  ctypes.byref(length)), OK)
        _, nonce, associated = message_parts(**fields)
        self.assertEqual(AESCCM(key, tag_length=8).decrypt(nonce, message.raw[6:], associated), body)


if __name__ == "__main__":
    unittest.main()
