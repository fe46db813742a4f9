"""What the change detector catches and how often it wakes for nothing, as JSON.

    TSR_BUILD=build/release python3 tests/bench/measure_change.py [--video FILE] [--pairs FOLDER | --pictures FILE ...]
        [--config NAME=VALUE ...]

Video: vtest.avi of Debian's opencv-doc against the labels in vtest_people.csv; "" for none. Pairs: left views of a folder mb*/;
these or any pictures are made into scenes by tests/support/change_scenes.py. A frame that wakes is followed by one that becomes the background, as on a node;
"no rebase" is the detector alone. Needs python3-opencv; SEED (environment, default 1).

SPDX-License-Identifier: Apache-2.0
"""
import argparse
import collections
import ctypes
import json
import os
import pathlib
import sys

import cv2
import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(FOLDER), str(FOLDER.parent / "support")]
import change_scenes  # noqa: E402
import progress  # noqa: E402
import stereo_pairs  # noqa: E402
from vision_library import LIB, OK, SIZE, ChangeConfig, ChangeResult, pointer, view  # noqa: E402

VIDEO = "/usr/share/doc/opencv-doc/examples/data/vtest.avi"
WIDTH, HEIGHT = 160, 120
CAUGHT_WITHIN = 10  # frames from entering: 1 s
AMBIGUOUS = 2  # frames that a label may be off


class Watch:
    """A node's use of the detector."""

    def __init__(self, options, watched=(), rebases=True):
        config = ChangeConfig(WIDTH, HEIGHT, **options)
        config.watched_count = len(watched)
        for i, rectangle in enumerate(watched):
            config.watched[i] = rectangle
        self.state = np.zeros(LIB.tsr_change_state_len(ctypes.byref(config)), np.uint8)
        self.change, self.rebases, self.woken = np.zeros(512, np.uint8), rebases, False
        status = LIB.tsr_change_init(pointer(self.change), ctypes.byref(config), pointer(self.state), SIZE(self.state.size))
        assert status == OK, status

    def wakes(self, frame):
        """Whether this frame wakes; None if it is the capture that becomes the background."""
        gray, result = view(frame), ChangeResult()
        if self.woken and self.rebases:
            self.woken = False
            assert LIB.tsr_change_rebase(pointer(self.change), ctypes.byref(gray)) == OK
            return None
        assert LIB.tsr_change_update(pointer(self.change), ctypes.byref(gray), ctypes.byref(result)) == OK
        self.woken = result.changed
        return result.changed


def read_labels():
    regions = collections.defaultdict(lambda: {"nobody": [], "person": []})
    for line in (FOLDER / "vtest_people.csv").read_text("utf-8").splitlines():
        if line and not line.startswith("#"):
            kind, name, *numbers = line.split(",")
            numbers = tuple(int(number) for number in numbers)
            if kind == "region":
                regions[name]["rectangle"] = numbers
            else:
                regions[name][kind].append(numbers)
    return regions


def read_video(path):
    video, frames = cv2.VideoCapture(path), []
    while True:
        more, frame = video.read()
        if not more:
            break
        frames.append(cv2.resize(cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY), (WIDTH, HEIGHT), interpolation=cv2.INTER_AREA))
    if not frames:
        sys.exit(f"measure_change: {path}: no frames")
    return frames


def measure_region(frames, region, options, rebases):
    watch = Watch(options, [region["rectangle"]], rebases)
    woken = [watch.wakes(frame) for frame in frames]
    quiet = [i for first, last in region["nobody"]
             for i in range(first + AMBIGUOUS * (first > 0), last + 1 - AMBIGUOUS) if woken[i] is not None]
    missed = [first for first, last in region["person"]
              if not any(woken[max(0, first - AMBIGUOUS):min(last, first + CAUGHT_WITHIN) + 1])]
    return {"nobody": len(quiet), "false": [i for i in quiet if woken[i]], "people": len(region["person"]), "missed": missed,
            "woken": sum(map(bool, woken))}


def measure_video(path, options):
    frames, found = read_video(path), {}
    for name, rebases in (("node", True), ("no rebase", False)):
        regions = {region: measure_region(frames, label, options, rebases) for region, label in read_labels().items()}
        total = {key: sum(one[key] for one in regions.values()) for key in ("nobody", "people")}
        false, missed = (sum(len(one[key]) for one in regions.values()) for key in ("false", "missed"))
        found[name] = {"false wakes": round(false / total["nobody"], 4), "caught": round(1 - missed / total["people"], 4),
                       **total, "regions": regions}
    return found


def measure_scene(scene, options, counts):
    watch, caught, key, label_before = Watch(options), False, None, ""
    for frame, label, part, contrast in scene.frames():
        woken = watch.wakes(frame)
        if label == "object":
            key, caught = (part, contrast), caught or bool(woken)
        elif label_before == "object":
            for group in (f"part {key[0]:.1%}", f"contrast {key[1]}", "events", f"part {key[0]:.1%} contrast {key[1]}"):
                counts[group][0] += caught
                counts[group][1] += 1
            caught = False
        if label == "empty" and woken is not None:
            counts["empty"][0] += woken
            counts["empty"][1] += 1
        label_before = label


def left_views(folder):
    return [folder / "left.png" for folder in stereo_pairs.folders(folder)]


def measure_scenes(files, options):
    pictures = [stereo_pairs.reduced(cv2.imread(str(file), cv2.IMREAD_GRAYSCALE), WIDTH, HEIGHT) for file in files]
    found, rng = {}, np.random.default_rng(int(os.environ.get("SEED", "1")))
    for condition in change_scenes.CONDITIONS:
        for gain in change_scenes.GAINS:
            counts = collections.defaultdict(lambda: [0, 0])
            for i, picture in enumerate(pictures):
                progress.tell(f"{condition}, gain {gain}: picture {i + 1} of {len(pictures)}")
                others = [p for j, p in enumerate(pictures) if j != i]
                measure_scene(change_scenes.Scene(picture, others, condition, gain, rng), options, counts)
            found[f"{condition}, gain {gain}"] = counts
    progress.tell("")
    return found


def summary(found):
    """Sums over all conditions, and rates."""
    total = collections.defaultdict(lambda: [0, 0])
    for counts in found.values():
        for group, (count, of) in counts.items():
            total[group][0] += count
            total[group][1] += of

    def rates(counts):
        return {group: round(count / of, 4) for group, (count, of) in counts.items()}

    return {"all": rates(total), **{name: {group: rates(counts)[group] for group in ("events", "empty")}
                                    for name, counts in found.items()}}


def main():
    parser = argparse.ArgumentParser(description="What the change detector catches and how often it wakes for nothing.")
    parser.add_argument("--video", default=VIDEO)
    parser.add_argument("--pairs", type=pathlib.Path)
    parser.add_argument("--pictures", nargs="*", default=[], metavar="FILE")
    parser.add_argument("--config", nargs="*", default=[], metavar="NAME=VALUE", help="fields of tsr_change_config")
    arguments = parser.parse_args()
    options = {name: int(value) for name, value in (field.split("=") for field in arguments.config)}
    result = {"video": measure_video(arguments.video, options)} if arguments.video else {}
    files = left_views(arguments.pairs) if arguments.pairs else arguments.pictures
    if files:
        result["scenes"] = summary(measure_scenes(files, options))
    print(json.dumps(result, indent=1))


if __name__ == "__main__":
    main()
