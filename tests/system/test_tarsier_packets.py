"""tarsier encode --packets and decode: every packet alone, in any order, with losses and damage; bad files are refused."""
# SPDX-License-Identifier: Apache-2.0
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from run_site import check, skip

try:
    import numpy as np
except ImportError:
    skip("test_tarsier_packets", "python3-numpy is not installed")
import codec_decoder
import codec_decoder_packet
import map_quality
import packet_file
from tarsier_run import RNG, quantised, refuse, run, run_json, scene


def held_by(packet, shape):
    """Which pixels a packet holds, and all of a map that are of it, px."""
    held, values = np.zeros((shape.height, shape.width), bool), np.full((shape.height, shape.width), np.inf)
    for x, y, value in codec_decoder_packet.decode_packet(shape, shape.map_id, packet)[1]:
        held[y, x] = True
        values[y, x] = np.inf if value == codec_decoder.INVALID else value / 16
    return held, values


def packets(folder):
    values = scene()
    source, coded, back = folder / "map.pfm", folder / "packets.tdm", folder / "packets.pfm"
    map_quality.write_pfm(source, values)
    for cap, step, options in ((90, 0.5, ()), (20, 0.0625, ()), (1280, 1, ()), (45, 0.5, ("--near", 1))):
        told = run_json("encode", source, "-o", coded, "--packets", cap, "--step", step, "--d0=-31.1", *options)
        file = packet_file.File(coded.read_bytes())
        lens = [len(packet) for packet in file.packets]
        check(max(lens) <= cap and told["bytes"] == sum(lens) and file.damaged == 0 and file.d0_q4 == -16 * 31.125, told)
        check(told["packets"] == {"count": len(lens), "found": len(lens), "missing_pixels": 0, "damaged_bytes": 0}, told)
        check((told["d0_px"], told["format_version"], told["prior"], told["reference_id"]) == (-31.125, 2, None, None),
              told)
        check(run_json("decode", coded, "-o", back) == {**told, "out": str(back)}, "told otherwise")
        got, wanted = map_quality.read_pfm(back), quantised(values, step, 32)
        check(np.array_equal(np.isfinite(got), np.isfinite(wanted)), f"{cap}: other pixels have a match")
        valid = np.isfinite(wanted)
        check(np.abs(got[valid] - wanted[valid]).max() <= (step if options else 0), f"{cap}, {step}: farther off")
        parts = [held_by(packet, file) for packet in file.packets]
        check((sum(held.astype(int) for held, _ in parts) == 1).all(), f"{cap}: not each pixel once")
        for held, said in parts:
            check(np.array_equal(said[held], got[held]), f"{cap}, {step}: another map, says the specification")
    lost_packets(folder, coded.read_bytes()[:17], [packet_file.record(packet) for packet in file.packets],
                 [held for held, _ in parts], got)


def lost_packets(folder, header, records, held, whole):
    """Packets gone, moved, repeated, cut and changed: the rest decodes, and what is missing is told."""
    coded, back = folder / "lossy.tdm", folder / "lossy.pfm"

    def expect(what, body, lost, damaged=0):
        coded.write_bytes(header + b"".join(body))
        told = run_json("decode", coded, "-o", back)
        missing = sum((held[i] for i in lost), np.zeros((60, 80), bool))
        check(told["packets"] == {"count": len(records), "found": len(records) - len(lost),
                                  "missing_pixels": missing.sum(), "damaged_bytes": damaged}, f"{what}: {told}")
        check(np.array_equal(map_quality.read_pfm(back), np.where(missing, np.inf, whole)), f"{what}: another map")
        line = run("decode", coded, "-o", back).stdout
        check(line.count("\n") == 1 and all(word in line for word in (
            [f"{len(records) - len(lost)} of {len(records)} intact", f"{missing.sum()} px missing", f"{damaged} bytes damaged"]
            if lost or damaged else [f"in {len(records)} packets"])), f"{what}: {line}")
        print(f"{what}: {line.strip()}")

    count = len(records)
    check(count > 6, f"{count} packets")
    expect("all", records, [])
    expect("removed", records[:2] + records[3:-1], [2, count - 1])
    expect("reordered and repeated", records[::-1] + records[3:5], [])
    expect("all but one removed", records[4:5], [i for i in range(count) if i != 4])
    expect("truncated", [*records[:-1], records[-1][:-1]], [count - 1], len(records[-1]) - 1)
    expect("cut within a length", [*records[:3], records[3][:1]], range(3, count), 1)
    for what, at in (("length", 0), ("length's second byte", 1), ("checksum", 2), ("packet's header", 5), ("payload", 20)):
        changed = bytearray(records[2])
        changed[at] ^= 0x20
        expect(f"another {what}", records[:2] + [changed] + records[3:], [2], len(changed))
    # A literal packet of 4,096 pixels with no label but 0: version 2, id 0, as in 2a.1.
    other = packet_file.record((2 << 30 | 1 << 26 | 511 << 17).to_bytes(4, "little"))
    expect("pixels again by other bytes", [*records[1:3], other, *records[3:], other, *records[:1]], [])
    expect("bytes between", [records[0], b"\0between", *records[1:], RNG.bytes(40)], [], 48)
    expect("bytes lost from the middle", [*records[:3], records[3][:30] + records[4][40:], *records[5:]], [3, 4],
           30 + len(records[4]) - 40)


def bad_packets(folder):
    good, out = (folder / "packets.tdm").read_bytes(), folder / "bad.pfm"
    packets = packet_file.File(good).packets

    def refuse_bytes(what, data, mentions):
        (folder / "bad.tdm").write_bytes(data)
        refuse(what, "decode", folder / "bad.tdm", "-o", out, mentions=["bad.tdm", *mentions], left=[out])

    def with_fields(*changes, body=good[17:]):
        header = bytearray(good[:15])
        for at, value in changes:
            header[at] = value
        return bytes(header) + packet_file.crc16(header).to_bytes(2, "little") + body

    refuse_bytes("half a header of packets", good[:16], ["header", "16 bytes", "17"])
    refuse_bytes("another file version", with_fields((4, 2)), ["file version", "2"])
    refuse_bytes("a damaged header", good[:7] + b"\x51" + good[8:], ["header", "damaged", "checksum"])
    for what, changes, field in (("another step", [(5, 5)], "step"), ("a flag", [(5, 0x83)], "flags"),
                                 ("129 disparities", [(6, 128)], "disparities"), ("no width", [(7, 0)], "width"),
                                 ("too wide", [(8, 3)], "width"), ("no height", [(9, 0)], "height"),
                                 ("too high", [(10, 2)], "height"), ("no packets", [(13, 0), (14, 0)], "packets")):
        refuse_bytes(what, with_fields(*changes), [field])
    refuse_bytes("a header alone", good[:17], ["packets", "none", str(len(packets))])
    refuse_bytes("packets of another map", with_fields((5, 0x13)), ["packets", "none"])
    refuse_bytes("noise", good[:17] + RNG.bytes(5000), ["packets", "none"])
    newer = packets[0][:3] + bytes([packets[0][3] ^ 0xC0]) + packets[0][4:]
    refuse_bytes("another packet version", with_fields(body=packet_file.record(newer)), ["packet version", "1"])
    (folder / "bad.tdm").write_bytes(good.ljust(2**21 + 1, b"\0"))
    refuse("packets without end", "decode", folder / "bad.tdm", "-o", out, mentions=["bad.tdm", str(2**21)], left=[out])
    (folder / "bad.tdm").unlink()
    refuse("a reference to packets", "decode", folder / "packets.tdm", "-o", out, "--against", folder / "map.pfm",
           "--reference-id", 1, mentions=["packets.tdm", "alone"], left=[out])


def damaged_packets(folder):
    """Bytes changed, lost and put in anywhere behind the header: the same map as by the specification."""
    coded, back = (folder / "packets.tdm").read_bytes(), folder / "damaged.pfm"
    for turn in range(30):
        data = bytearray(coded)
        for at in RNG.integers(17, len(data) - 60, 4):
            data[at:at + RNG.integers(0, 40)] = RNG.bytes(RNG.integers(0, 40))
        (folder / "damaged.tdm").write_bytes(data)
        told, file = run_json("decode", folder / "damaged.tdm", "-o", back), packet_file.File(bytes(data))
        wanted, held = np.full((60, 80), np.inf), np.zeros((60, 80), bool)
        for here, values in (held_by(packet, file) for packet in file.packets):
            wanted[here], held = values[here], held | here
        check(told["packets"] == {"count": file.count, "found": len(file.packets), "missing_pixels": (~held).sum(),
                                  "damaged_bytes": file.damaged}, f"{turn}: {told}")
        check(np.array_equal(map_quality.read_pfm(back), wanted), f"{turn}: another map, says the specification")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    packets(folder)
    bad_packets(folder)
    damaged_packets(folder)
