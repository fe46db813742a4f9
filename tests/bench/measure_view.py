"""Bytes that a wing sends, and what they cost of the map: the figures of docs/codec.md, 3.6 and 4.7.

    TSR_BUILD=build/release python3 tests/bench/measure_view.py FOLDER_OF_PAIRS [TRIALS]

First views, and views against the one before after an object of a tenth of the picture has appeared in both views, all
captures with noise of one gray level. `lost` is what is lost of the correct pixels of mode sad's map against exchanging
the gray view. Needs python3-opencv.

SPDX-License-Identifier: Apache-2.0
"""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import stereo_pairs  # noqa: E402
import view_library  # noqa: E402
import vision_library  # noqa: E402

NOISE_SIGMA = 1.0
OBJECT_PART = 0.10
NEARER_PX = 2


def correct(left, right, disparities, truth, **fields):
    return stereo_pairs.judge(vision_library.match(left, right, disparities, **fields), truth)["correct"]


def noisy(picture, rng, sigma):
    return np.clip(np.rint(picture + rng.normal(0, sigma, picture.shape)), 0, 255).astype(np.uint8)


def paste(pair, patch_of, disparities, rng, part):
    """A patch of another picture nearer than what it hides, in both views and in the truth."""
    left, right, truth = (picture.copy() for picture in pair)
    height, width = left.shape
    if part == 0:
        return left, right, truth
    across = int(rng.integers(int(0.225 * width), int(0.4 * width)))
    down = min(round(width * height * part / across), height - 8)
    x, y = int(rng.integers(disparities, width - across)), int(rng.integers(0, height - down))
    from_x, from_y = int(rng.integers(0, width - across)), int(rng.integers(0, height - down))
    behind = truth[y:y + down, x:x + across].max()
    shift = int(min(disparities - 1, max(np.ceil(behind) + NEARER_PX, 8)))
    patch = patch_of[from_y:from_y + down, from_x:from_x + across]
    left[y:y + down, x:x + across] = right[y:y + down, x - shift:x - shift + across] = patch
    truth[y:y + down, x:x + across] = shift
    return left, right, truth


def changed_scenes(pair, pairs, i, trials, part):
    """Pair i of the pairs after an object has appeared in it, as views and truth, and the generator for the noise: trials times."""
    *views, disparities = pair
    for trial in range(trials):
        rng = np.random.default_rng(1000 * i + trial)
        other = pairs[(i + 1 + rng.integers(len(pairs) - 1)) % len(pairs)][0]
        yield *paste(views, other, disparities, rng, part), rng


def first_views(pairs, coarse, cap):
    sizes, losses = [], []
    for left, right, truth, disparities in pairs:
        data = view_library.encode(view_library.prefilter(right, cap), cap, coarse)
        sizes.append(len(data))
        losses.append(correct(left, right, disparities, truth) -
                      correct(left, view_library.decode(data), disparities, truth, right_is_prefiltered=True,
                              prefilter_cap=cap))
    return sizes, losses


def next_views(pairs, coarse, trials, sigma, part=OBJECT_PART):
    sizes, losses = [], []
    for i, pair in enumerate(pairs):
        lost, right, disparities = [], pair[1], pair[3]
        for new_left, new_right, new_truth, rng in changed_scenes(pair, pairs, i, trials, part):
            height, width = right.shape
            wing, lead = view_library.Held(width, height), view_library.Held(width, height)
            view_library.decode(view_library.encode(view_library.prefilter(noisy(right, rng, sigma)), 7, coarse, wing), lead)
            seen_left, seen_right = noisy(new_left, rng, sigma), noisy(new_right, rng, sigma)
            fresh = view_library.prefilter(seen_right)
            data = view_library.encode(fresh, 7, coarse, wing, view_library.choose_tiles(fresh, wing))
            got = view_library.decode(data, lead)
            assert np.array_equal(wing.packed, lead.packed) and wing.struct.check == lead.struct.check
            sizes.append(len(data))
            lost.append(correct(seen_left, seen_right, disparities, new_truth) -
                        correct(seen_left, got, disparities, new_truth, right_is_prefiltered=True))
        losses.append(np.mean(lost))
    return sizes, losses


def gray_views(pairs, near, mode):
    sizes, losses = [], []
    for left, right, truth, disparities in pairs:
        size, decoded = view_library.code_gray(right, near)
        sizes.append(size)
        losses.append(correct(left, right, disparities, truth, mode=vision_library.MODES[mode]) -
                      correct(left, decoded, disparities, truth, mode=vision_library.MODES[mode]))
    return sizes, losses


def show(name, sizes, losses):
    print(f"{name:40s} {np.mean(sizes):7.0f} bytes ({min(sizes)} .. {max(sizes)})   lost {np.mean(losses):+.4f}, at most "
          f"{np.max(losses):+.4f} of a pair")


def main(folder, trials):
    for width, height, disparities in stereo_pairs.CASES:
        pairs = [stereo_pairs.load(one, width, height) + (disparities,) for one in stereo_pairs.folders(folder)]
        print(f"{width}x{height}, {len(pairs)} pairs")
        for cap in (7, 6, 5, 4, 3):
            show(f"first, exact, cap {cap}", *first_views(pairs, False, cap))
        show("first, coarse", *first_views(pairs, True, 7))
        for sigma in (0.5, NOISE_SIGMA, 2.0):
            show(f"next, coarse, noise {sigma}", *next_views(pairs, True, trials, sigma))
        show("next, exact", *next_views(pairs, False, trials, NOISE_SIGMA))
        for near in (0, 8, 1, 2, 4):
            for mode in ("smooth", "census"):
                show(f"gray, near {near if near < 8 else 'by activity'}, {mode}", *gray_views(pairs, near, mode))
        show("next, coarse, nothing changed", *next_views(pairs, True, 1, NOISE_SIGMA, 0.0))


if __name__ == "__main__":
    main(pathlib.Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 4)
