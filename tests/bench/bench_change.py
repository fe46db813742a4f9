"""The change detector on a real video and on made scenes, against its goals: tests/bench/measure_change.py.

TSR_DATA is a folder of pairs mb*/; without it the video alone is measured. Needs python3-opencv and Debian's opencv-doc.

SPDX-License-Identifier: Apache-2.0
"""
import os
import pathlib

FALSE_VIDEO_MAX, CAUGHT_VIDEO_MIN = 0.02, 0.98
FALSE_SCENES_MAX, CAUGHT_SCENES_MIN = 0.005, 0.99
BUILD = pathlib.Path(__file__).resolve().parents[2] / "build" / "release"


def target(name, value, goal, at_most, how):
    return {"name": name, "value": value, "unit": "", "target": goal, "met": value <= goal if at_most else value >= goal,
            "how": how}


def bench():
    os.environ.setdefault("TSR_BUILD", str(BUILD))
    import measure_change
    video = measure_change.measure_video(measure_change.VIDEO, {})
    how = "vtest.avi at 160x120, four watched regions, labels in vtest_people.csv"
    targets = []
    for name, found in video.items():
        targets.append(target(f"{name}: frames with nobody that wake", found["false wakes"], FALSE_VIDEO_MAX, True, how))
        targets.append(target(f"{name}: people caught", found["caught"], CAUGHT_VIDEO_MIN, False, how))
    details = {"video": video}
    if "TSR_DATA" in os.environ:
        scenes = measure_change.summary(measure_change.measure_scenes(measure_change.left_views(pathlib.Path(os.environ["TSR_DATA"])), {}))
        how = "scenes of tests/support/change_scenes.py over all pairs, all conditions and gains"
        targets.append(target("scenes: frames with nothing new that wake", scenes["all"]["empty"], FALSE_SCENES_MAX, True, how))
        targets.append(target("scenes: objects caught", scenes["all"]["events"], CAUGHT_SCENES_MIN, False, how))
        details["scenes"] = scenes
    return {"targets": targets, "details": details}
