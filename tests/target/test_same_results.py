"""The Cortex-M4 and the host give the same bytes: change, matching, filters, similarity, the codecs, sealing.

The workbench runs on both over the same pictures: the demo's Aloe frames at 160x120 and 320x240, and with TSR_DATA the
pairs in that folder. On the host it is built with address and undefined-behaviour sanitizers.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import tempfile

import board
import pictures

RESULTS = ["change_result", "change_state", "gray_coded", "gray_decoded", "view_exact", "lead_map", "view_next", "view_coded", "view_decoded", "near_coded",
           "near_decoded",
           "picture_coded", "picture_decoded",
           "match", "match_sad8", "match_census", "match_smooth", "match_raw", "match_ssd", "median", "median5", "speckle", "fill", "gaussian3",
           "gaussian5", "diffusion", "zone", "quantise", "rectified", "similarity", "map_coded", "map_decoded", "map_later", "message",
           "frames"]


def results(folder):
    found = {path.stem: path.read_bytes() for path in pathlib.Path(folder).glob("*.out")}
    for path in pathlib.Path(folder).glob("*.out"):
        path.unlink()
    return found


def test():
    image = board.build("tarsier-workbench") / "tarsier-workbench.elf"
    host = board.build_on_host("workbench-host")
    with tempfile.TemporaryDirectory() as work:
        for name, folder, shape in pictures.aloe_cases(work) + pictures.data_cases(work):
            board.run([host, *shape], cwd=folder)
            expected = results(folder)
            code, text = board.run_image(image, shape, folder)
            assert code == 0, f"{name}: workbench ended with {code}: {text}"
            found = results(folder)
            assert sorted(expected) == sorted(found) == sorted(RESULTS), f"{name}: {sorted(found)}"
            different = [result for result in RESULTS if expected[result] != found[result]]
            assert not different, f"{name}: the board differs from the host in {', '.join(different)}"
            assert any(expected["match"]) and expected["change_result"][0] == 1, f"{name}: the pictures test nothing"
            print(f"{name}: {len(RESULTS)} results equal, {sum(map(len, found.values()))} bytes")


board.main("target/test_same_results", test)
