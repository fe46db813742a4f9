"""What packets that decode alone cost over one stream: the figures of docs/codec.md, 5a.4.

    TSR_BUILD=build/release python3 tests/bench/measure_packets.py FOLDER_OF_PAIRS [PACKET_LEN]

Gray images and views are the right views of all pairs, pictures the left ones at the step of a node's reference images.
All are cut and reduced as every figure has them. Needs python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import measure_reference  # noqa: E402
import packet_library  # noqa: E402
import stereo_pairs  # noqa: E402
import view_library  # noqa: E402
from vision_library import LIB, OK  # noqa: E402

PACKET_LEN = 90
STEP = 35
CASES = (("gray, lossless", "gray", (0,)), ("gray, by activity", "gray", (8,)), ("view, exact, cap 7", "view", (7, False, False)),
         ("view, coarse", "view", (7, True, False)), (f"picture, step {STEP}", "picture", (STEP, 1)))


def stream(name, image, how):
    """Bytes of one stream, and what it decodes to."""
    if name == "gray":
        return view_library.code_gray(image, how[0])
    if name == "view":
        data = view_library.encode(image, how[0], how[1])
        return len(data), view_library.decode(data)
    return measure_reference.code(image, how[0])


def packets(name, image, how, cap):
    """Packets, and what they decode to from the last to the first."""
    sent = packet_library.Sender(LIB, name, image, how).all(cap)
    height, width = image.shape
    receiver = packet_library.Receiver(LIB, name, width, height, how)
    for packet in reversed(sent):
        assert receiver.take(packet)[0] == OK
    assert receiver.missing() == 0
    return sent, receiver.result()


def show(title, name, how, images, cap):
    whole, counts, sums, likeness = [], [], [], []
    for image in images:
        length, decoded = stream(name, image, how)
        sent, received = packets(name, image, how, cap)
        if name == "picture":
            likeness.append((measure_reference.ssim(image, decoded), measure_reference.ssim(image, received)))
        elif name == "view" or how == (0,):
            assert np.array_equal(decoded, received)
        whole.append(length)
        counts.append(len(sent))
        sums.append(sum(map(len, sent)))
    text = (f"{title:20s} stream {np.mean(whole):6.0f} bytes   {np.mean(counts):5.1f} packets, {np.mean(sums):6.0f} bytes: "
            f"{np.sum(sums) / np.sum(whole):.3f} times")
    if likeness:
        text += "   SSIM {:.4f} and {:.4f}".format(*np.mean(likeness, axis=0))
    print(text)


def main(folder, cap):
    for width, height, _ in stereo_pairs.CASES:
        pairs = [stereo_pairs.load(one, width, height) for one in stereo_pairs.folders(folder)]
        print(f"{width}x{height}, {len(pairs)} pairs, packets of at most {cap} bytes")
        for title, name, how in CASES:
            images = [pair[0] if name == "picture" else pair[1] for pair in pairs]
            if name == "view":
                images = [view_library.prefilter(image, how[0]) for image in images]
            show(title, name, how, images, cap)


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else PACKET_LEN)
