"""firmware/vision as Python calls: the shared library of the build in TSR_BUILD, its structs, and whole runs.

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import sys

import numpy as np

OK, AGAIN = 0, 1
INVALID, TEST_OFF = 65535, 255
STATE_LEN = 512  # more than any module's struct
MODES = {"sad": 0, "sad8": 1, "census": 2, "smooth": 3, "raw": 4, "ssd": 5}
STEPS = {name: i + 1 for i, name in
         enumerate(("median3", "median5", "speckle", "fill", "gaussian3", "gaussian5", "diffusion"))}
U8, U16, I16, U32, U64, SIZE, ANY = (ctypes.c_uint8, ctypes.c_uint16, ctypes.c_int16, ctypes.c_uint32, ctypes.c_uint64,
                                     ctypes.c_size_t, ctypes.c_void_p)


class Gray(ctypes.Structure):
    _fields_ = [("pixels", ANY), ("width", U16), ("height", U16), ("stride", U16)]


class MatchConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("disparities", U16), ("window", U8), ("mode", U8), ("prefilter_cap", U8),
                ("uniqueness_percent", U8), ("texture_min", U8), ("lr_tolerance_px", U8), ("search_start_px", I16),
                ("right_is_prefiltered", ctypes.c_bool), ("kernel", ANY)]


class SpeckleConfig(ctypes.Structure):
    _fields_ = [("min_size", U16), ("max_difference_q4", U16)]


class DiffusionConfig(ctypes.Structure):
    _fields_ = [("iterations", U8), ("edge_q4", U8), ("rate_q8", U8)]


class RefineConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("steps", U8 * 8), ("speckle", SpeckleConfig),
                ("diffusion", DiffusionConfig), ("fill_rule", U8)]


class ChangeRectangle(ctypes.Structure):
    _fields_ = [("x", U16), ("y", U16), ("width", U16), ("height", U16)]


class ChangeConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("reduction", U8), ("amplification", U8), ("deviation_min", U8),
                ("deviation_max", U8), ("min_cells", U16), ("settle_frames", U8),
                ("watched_count", U8), ("watched", ChangeRectangle * 4)]


class ChangeResult(ctypes.Structure):
    _fields_ = [("changed", ctypes.c_bool), ("settling", ctypes.c_bool), ("changed_cells", U16),
                ("light_q8", U16)]


class SimilarityConfig(ctypes.Structure):
    _fields_ = [("width", U16), ("height", U16), ("block_log2", U8), ("clip_q4", U8), ("threshold_q8", U16),
                ("min_blocks", U16)]


class SimilarityResult(ctypes.Structure):
    _fields_ = [("squares_q8", U64), ("both_count", U32), ("one_count", U32), ("blocks", U16), ("different_blocks", U16)]


def load():
    build = pathlib.Path(os.environ.get("TSR_BUILD", "build"))
    found = sorted(build.rglob("libtsr_firmware.so"))
    if not found:
        sys.exit(f"no libtsr_firmware.so under {build}")
    library = ctypes.CDLL(str(found[0]))
    for name in ("tsr_match_scratch_len", "tsr_match_pair_len", "tsr_change_state_len", "tsr_refine_scratch_len"):
        getattr(library, name).restype = SIZE
    library.tsr_similarity_is_similar.restype = ctypes.c_bool
    library.tsr_match_kernel_at.restype = ANY
    library.tsr_match_start.argtypes = [ANY, ANY, Gray, Gray, ANY, SIZE, ANY, SIZE]
    library.tsr_refine_start.argtypes = [ANY, ANY, ANY, SIZE, ANY, SIZE]
    library.tsr_refine_run.argtypes = [ANY, U16]
    return library


LIB = load()


def pointer(array):
    return array.ctypes.data_as(ANY)


def view(picture):
    height, width = picture.shape
    return Gray(picture.ctypes.data, width, height, picture.strides[0])


def portable_kernel():
    """The definition, which property/test_vision_kernels holds every other kernel to."""
    kernels = []
    while not kernels or kernels[-1] is not None:
        kernels.append(LIB.tsr_match_kernel_at(len(kernels)))
    return kernels[-2]


def run_match(views, config, disparity_map, rng=None):
    """Match two views (Gray, consumed) into an array. With rng the scratch holds noise and calls take any rows."""
    scratch = np.zeros(LIB.tsr_match_scratch_len(ctypes.byref(config)), np.uint8)
    if rng is not None:
        scratch[:] = rng.integers(0, 256, scratch.size, np.uint8)
    state = np.zeros(STATE_LEN, np.uint8)
    status = LIB.tsr_match_start(pointer(state), ctypes.byref(config), *views, pointer(disparity_map),
                                 disparity_map.size, pointer(scratch), scratch.size)
    assert status == OK, status
    while status != OK or not LIB.tsr_match_rows_done(pointer(state)):
        status = LIB.tsr_match_run(pointer(state), U16(65535 if rng is None else int(rng.integers(1, config.height))))
        assert status in (OK, AGAIN), status
    return disparity_map


def match(left, right, disparities, **fields):
    """The map of two pictures, which stay as they are."""
    height, width = left.shape
    copies = left.copy(), right.copy()
    config = MatchConfig(width, height, disparities, **fields)
    return run_match([view(copy) for copy in copies], config, np.zeros((height, width), np.uint16))


def refine(disparity_map, steps, speckle_size=0):
    """The map after the named filters."""
    height, width = disparity_map.shape
    result = disparity_map.copy()
    config = RefineConfig(width, height, (U8 * 8)(*[STEPS[step] for step in steps]), SpeckleConfig(speckle_size))
    scratch = np.zeros(LIB.tsr_refine_scratch_len(ctypes.byref(config)) // 4 + 1, np.uint32)
    state = np.zeros(STATE_LEN, np.uint8)
    status = LIB.tsr_refine_start(pointer(state), ctypes.byref(config), pointer(result), result.size, pointer(scratch),
                                  4 * scratch.size)
    assert status == OK, status
    while LIB.tsr_refine_run(pointer(state), 65535) == AGAIN:
        pass
    return result
