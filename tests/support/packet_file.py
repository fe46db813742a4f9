"""Files of maps in packets, written from docs/codec.md, chapter 2b, not from the C.

SPDX-License-Identifier: Apache-2.0
"""
from codec_decoder import FormatError, VersionError


class File:
    """2b: the header's fields, and the packets that are intact."""

    def __init__(self, data):
        if len(data) < 17 or data[:4] != b"PTDM" or crc16(data[:15]) != int.from_bytes(data[15:17], "little"):
            raise FormatError
        if data[4] != 1:
            raise VersionError
        self.step_log2, self.near, self.map_id = data[5] & 7, data[5] >> 3 & 1, data[5] >> 4 & 7
        self.disparities = data[6] + 1
        self.width, self.height = int.from_bytes(data[7:9], "little"), int.from_bytes(data[9:11], "little")
        self.d0_q4 = int.from_bytes(data[11:13], "little", signed=True)
        self.count = int.from_bytes(data[13:15], "little")
        self.packets, self.damaged, at = [], 0, 17
        while at < len(data):
            end = at + 4 + int.from_bytes(data[at:at + 2], "little")
            if 4 <= end - at - 4 <= 1280 and end <= len(data) and crc16(
                    data[at:at + 2] + data[at + 4:end]) == int.from_bytes(data[at + 2:at + 4], "little"):
                self.packets.append(data[at + 4:end])
                at = end
            else:
                self.damaged += 1
                at += 1


def crc16(data, crc=0xFFFF):
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = crc >> 1 ^ (0x8408 if crc & 1 else 0)
    return crc


def record(packet):
    """A packet as it stands in a file."""
    length = len(packet).to_bytes(2, "little")
    return length + crc16(length + packet).to_bytes(2, "little") + packet
