"""The JPEG files whose cost tools/bench work counts on the Cortex-M4 are those of the host's own libjpeg, byte for byte.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import tempfile

import board
import pictures

FILES = ("left.jpg", "right.jpg")


def files(folder):
    found = {name: (pathlib.Path(folder) / name).read_bytes() for name in FILES}
    for name in FILES:
        (pathlib.Path(folder) / name).unlink()
    return found


def test():
    board.need_libjpeg()
    image = board.build("tarsier-jpeg") / "tarsier-jpeg.elf"
    host = board.build_on_host("jpeg-host")
    with tempfile.TemporaryDirectory() as work:
        for name, folder, shape in pictures.aloe_cases(work):
            board.run([host, *shape], cwd=folder)
            expected = files(folder)
            code, text = board.run_image(image, shape, folder)
            assert code == 0, f"{name}: ended with {code}: {text}"
            found = files(folder)
            different = [file for file in FILES if expected[file] != found[file]]
            assert not different, f"{name}: the board differs from the host in {', '.join(different)}"
            print(f"{name}: {', '.join(f'{file} of {len(data)} bytes' for file, data in found.items())}")


board.main("target/test_jpeg_on_board", test)
