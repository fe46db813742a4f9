"""The C vision layer against tests/support/vision_reference.py, written from docs/math.md: equal bit for bit.

SEED replays a run: SEED=n python3 tests/vectors/test_vision_match.py

SPDX-License-Identifier: Apache-2.0
"""
import ctypes
import os
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    print("tarsier skipped: test_vision_match: python3-numpy is not installed")
    sys.exit(77)

SOURCE = pathlib.Path(os.environ.get("TSR_SOURCE", pathlib.Path(__file__).resolve().parents[2]))
sys.path.insert(0, str(SOURCE / "tests" / "support"))
import vision_reference as reference  # noqa: E402
from vision_library import (AGAIN, LIB, OK, SIZE, STATE_LEN, U8, U16, Gray,  # noqa: E402
                            MatchConfig, SimilarityConfig, SimilarityResult, pointer, portable_kernel)
import vision_library  # noqa: E402

DEFAULT_UNIQUENESS, DEFAULT_TEXTURE, MEDIAN_VALID_MIN = 15, 1, 4
SEED = int(os.environ.get("SEED", "1"))
RNG = np.random.default_rng(SEED)


def padded(picture, stride):
    rows = RNG.integers(0, 256, (picture.shape[0], stride), np.uint8)
    rows[:, :picture.shape[1]] = picture
    return rows


def run_match(left, right, config, strides):
    height, width = left.shape
    config.kernel = portable_kernel()
    frames = [padded(left, strides[0]), padded(right, strides[1])]
    views = [Gray(f.ctypes.data, width, height, f.shape[1]) for f in frames]
    return vision_library.run_match(views, config, np.zeros((height, width), np.uint16), RNG)


def blocky(height, width):
    picture = np.zeros((height, width), np.int64)
    for _ in range(12):
        y, x = RNG.integers(0, height), RNG.integers(0, width)
        picture[y:y + RNG.integers(2, 20), x:x + RNG.integers(2, 20)] = RNG.integers(0, 256)
    return picture


def shifted_pair(height, width, shift, texture):
    """A scene seen twice: right(x) = scene(x + shift), a nearer patch, and noise."""
    scene = texture(height, width + 2 * width)
    left = scene[:, width:2 * width].copy()
    right = scene[:, width + shift:2 * width + shift].copy()
    y, x = height // 3, width // 3
    patch = RNG.integers(0, 256, (height // 3, width // 4))
    left[y:y + patch.shape[0], x:x + patch.shape[1]] = patch
    near = max(0, min(width - patch.shape[1], x - shift - 5))
    right[y:y + patch.shape[0], near:near + patch.shape[1]] = patch
    noise = RNG.normal(0, 2, (2, height, width))
    return [np.clip(np.rint(v + n), 0, 255).astype(np.uint8) for v, n in zip((left, right), noise)]


def random_texture(height, width):
    return RNG.integers(0, 256, (height, width))


def smooth_texture(height, width):
    rough = np.kron(RNG.integers(0, 256, (height // 4 + 1, width // 4 + 1)), np.ones((4, 4)))
    return rough[:height, :width]


def pictures(height, width, shift):
    yield "random", RNG.integers(0, 256, (2, height, width), np.uint8)
    yield "two values", RNG.integers(0, 2, (2, height, width), np.uint8) * 255
    yield "constant", np.full((2, height, width), 77, np.uint8)
    yield "ramp", np.tile((np.arange(width) * 3 % 256).astype(np.uint8), (2, height, 1))
    yield "blocks", [p.astype(np.uint8) for p in (blocky(height, width), blocky(height, width))]
    yield "seen twice", shifted_pair(height, width, shift, random_texture)
    yield "smooth", shifted_pair(height, width, shift, smooth_texture)


def check_match(label, left, right, config):
    got = run_match(left, right, config, [left.shape[1] + int(e) for e in RNG.integers(0, 9, 2)])
    window = config.window or 9
    wanted = reference.match(left, right, config.disparities or 32, window, config.prefilter_cap or min(7, 63 // window),
                             config.uniqueness_percent or DEFAULT_UNIQUENESS, config.texture_min or DEFAULT_TEXTURE,
                             config.lr_tolerance_px or 1, config.search_start_px)
    fields = {name: getattr(config, name) for name, _ in config._fields_}
    assert np.array_equal(got, wanted), (label, fields, np.argwhere(got != wanted)[:5].tolist())
    return int((wanted != reference.INVALID).sum())


def test_match():
    cases = valid = 0
    for window in range(5, 16, 2):
        for disparities, width, height in ((16, 41, 23), (24, 36, 17), (32, 48, 20), (40, 40, 16)):
            room = width - disparities
            for start in {0, room, -room, room // 2, -(room // 3)}:
                for label, (left, right) in pictures(height, width, 6 + start):
                    if RNG.random() < 0.72:
                        continue
                    config = MatchConfig(width, height, disparities, window, 0, int(RNG.choice([0, 1, min(7, 63 // window)])),
                                         int(RNG.choice([0, 1, 100, 255])), int(RNG.choice([0, 5, 127, 255])),
                                         int(RNG.choice([0, 3, 127, 255])), start)
                    valid += check_match(label, left, right, config)
                    cases += 1
    for label, (left, right) in pictures(60, 160, 9):
        valid += check_match(label, left, right, MatchConfig(160, 60))
        cases += 1
    left, right = shifted_pair(20, 150, 100, random_texture)
    valid += check_match("128", left, right, MatchConfig(150, 20, 128))
    print(f"match: {cases + 1} pairs, {valid} valid pixels")


def random_map(height, width, valid_rate, spread):
    disparity_map = RNG.integers(0, spread, (height, width)).astype(np.uint16)
    disparity_map[RNG.random((height, width)) > valid_rate] = reference.INVALID
    return disparity_map


def test_median():
    for height, width in ((1, 1), (1, 9), (9, 1), (2, 2), (17, 23), (40, 31)):
        for valid_rate in (0, 0.2, 0.5, 0.8, 1):
            for spread in (3, 500, 65535):
                before = random_map(height, width, valid_rate, spread)
                got = before.copy()
                state = np.zeros(STATE_LEN, np.uint8)
                scratch = RNG.integers(0, 256, 4 * width, np.uint8)
                assert LIB.tsr_median_start(pointer(state), U16(width), U16(height), pointer(got), SIZE(got.size),
                                            pointer(scratch), SIZE(scratch.size)) == OK
                while LIB.tsr_median_run(pointer(state), U16(int(RNG.integers(1, 7)))) != OK:
                    pass
                assert np.array_equal(got, reference.median(before, MEDIAN_VALID_MIN)), (height, width, valid_rate, spread)


def test_quantise():
    everything = np.arange(65536, dtype=np.uint32).astype(np.uint16)
    for step_log2 in range(5):
        for disparities in (1, 2, 32, 100, 128):
            got = everything.copy()
            assert LIB.tsr_quantise(pointer(got), SIZE(got.size), U8(step_log2), U16(disparities)) == OK
            assert np.array_equal(got, reference.quantise(everything, step_log2, disparities)), (step_log2, disparities)


def test_similarity():
    for height, width in ((16, 16), (16, 23), (45, 37), (120, 160)):
        for _ in range(25):
            spread = int(RNG.choice([20, 400, 65535]))
            a = random_map(height, width, RNG.random(), spread)
            b = a if RNG.random() < 0.1 else random_map(height, width, RNG.random(), spread)
            if RNG.random() < 0.5:
                near = np.minimum(a.astype(np.int64) + RNG.integers(0, 60, a.shape), 65534).astype(np.uint16)
                b = np.where((a == reference.INVALID) | (b == reference.INVALID), b, near)
            block_log2, clip_q4 = int(RNG.integers(2, 5)), int(RNG.choice([1, 16, 32, 255]))
            threshold_q8 = int(RNG.integers(1, clip_q4 * clip_q4 + 1))
            config = SimilarityConfig(width, height, block_log2, clip_q4, threshold_q8, int(RNG.integers(1, 9)))
            state = np.zeros(STATE_LEN, np.uint8)
            result = SimilarityResult()
            assert LIB.tsr_similarity_start(pointer(state), ctypes.byref(config), pointer(a), pointer(b),
                                            SIZE(a.size)) == OK
            while LIB.tsr_similarity_run(pointer(state), U16(int(RNG.integers(1, height)))) != OK:
                pass
            assert LIB.tsr_similarity_get_result(pointer(state), ctypes.byref(result)) == OK
            got = tuple(getattr(result, name) for name, _ in result._fields_)
            wanted = reference.similarity(a, b, block_log2, clip_q4, threshold_q8)
            assert got == wanted, (got, wanted, height, width)
            similar = LIB.tsr_similarity_is_similar(ctypes.byref(config), ctypes.byref(result))
            assert similar == (wanted[4] < config.min_blocks)


if __name__ == "__main__":
    print(f"replay: SEED={SEED} python3 tests/vectors/test_vision_match.py")
    for test in (test_match, test_median, test_quantise, test_similarity):
        test()
        print(f"{test.__name__}: passed")
