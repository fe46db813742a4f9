"""Frames of a still camera with known events, for the change detector: pictures, sensor, light and objects.

A sequence is [(frame, label)] with label "empty", "object" or "after" (what an object leaves behind may wake as well).
Pictures are uint8; nothing here knows the detector.

SPDX-License-Identifier: Apache-2.0
"""
import numpy as np

CONDITIONS = ("still", "drift", "exposure", "flicker", "vibration", "leaves", "all")
GAINS = (1, 4, 8)
PARTS = (0.015, 0.03, 0.1, 0.3, 0.45)
CONTRASTS = (12, 25, 50)  # rms difference to what the object hides, gray levels
QUIET, STAY, AFTER = 11, 4, 3  # frames before an object, with it, and behind it
EVENTS = 15
SETTLE = 4
SHOT, READ = 0.04, 0.4  # variance per gray level at gain 1; standard deviation per gain
LEAF_PARTS = ((6, 5), (4, 4), (5, 7))


def shifted(picture, x, y):
    """Moved by less than a pixel, bilinear."""
    padded = np.pad(picture, 1, mode="edge")
    rows = (1 - abs(y)) * padded[1:-1] + abs(y) * (padded[2:] if y > 0 else padded[:-2])
    return (1 - abs(x)) * rows[:, 1:-1] + abs(x) * (rows[:, 2:] if x > 0 else rows[:, :-2])


class Scene:
    def __init__(self, picture, others, condition, gain, rng):
        self.picture, self.others, self.gain, self.rng = picture.astype(np.float64), others, gain, rng
        self.has = {name: condition in (name, "all") for name in CONDITIONS}
        self.exposure, self.frame_no, self.phase = 1.0, 0, rng.uniform(0, 2 * np.pi)
        self.noise = rng.normal(0, 1, 1 << 20)
        self.leaves = [(rng.integers(0, picture.shape[0] - h), rng.integers(3, picture.shape[1] - w - 3), h, w)
                       for h, w in LEAF_PARTS]

    def light(self):
        """As it reaches the pixels: drift over two minutes at a frame a second, a step in one frame, the mains."""
        light = 1 + 0.3 * np.sin(self.phase + 2 * np.pi * self.frame_no / 240) if self.has["drift"] else 1
        if self.has["exposure"] and self.frame_no > SETTLE and self.rng.random() < 0.1:
            step = self.rng.uniform(1.05, 1.25)
            self.exposure *= step if self.exposure < 0.8 or (self.exposure < 1.25 and self.rng.random() < 0.5) else 1 / step
        if self.has["flicker"]:
            light *= 1 + self.rng.uniform(-0.02, 0.02)
        return light * self.exposure

    def take(self, placed=None):
        view = self.picture.copy()
        if self.has["leaves"]:
            for y, x, h, w in self.leaves:
                sway = int(self.rng.integers(-2, 3))
                view[y:y + h, x:x + w] = self.picture[y:y + h, x + sway:x + sway + w]
        if placed is not None:
            y, x, patch = placed
            view[y:y + patch.shape[0], x:x + patch.shape[1]] = patch
        if self.has["vibration"]:
            view = shifted(view, *self.rng.uniform(-0.3, 0.3, 2))
        view *= self.light()
        sigma = np.sqrt(SHOT * self.gain * np.maximum(view, 0) + (READ * self.gain) ** 2)
        start = int(self.rng.integers(0, self.noise.size - view.size))
        view += sigma * self.noise[start:start + view.size].reshape(view.shape)
        self.frame_no += 1
        return np.clip(np.rint(view), 0, 255).astype(np.uint8)

    def object(self, part, contrast):
        """A patch of another picture, drawn towards what it hides until they differ by contrast."""
        rows, columns = self.picture.shape
        height = min(rows - 1, round((part * rows * columns / self.rng.uniform(0.6, 1.4)) ** 0.5))
        width = min(columns - STAY * 2, round(part * rows * columns / height))
        y, x = self.rng.integers(0, rows - height), self.rng.integers(0, columns - width - 2 * STAY + 1)
        other = self.others[self.rng.integers(len(self.others))].astype(np.float64)
        u, v = self.rng.integers(0, rows - height + 1), self.rng.integers(0, columns - width + 1)
        patch, hidden = other[u:u + height, v:v + width], self.picture[y:y + height, x:x + width]
        away = np.sqrt(np.mean((patch - hidden) ** 2))
        return y, x, hidden + (patch - hidden) * min(1, contrast / max(away, 1e-9))

    def frames(self):
        """(frame, label, part, contrast)"""
        for _ in range(SETTLE):
            yield self.take(), "settle", None, None
        for event in range(EVENTS):
            part, contrast = PARTS[event % len(PARTS)], CONTRASTS[event // len(PARTS) % len(CONTRASTS)]
            for _ in range(QUIET):
                yield self.take(), "empty", None, None
            y, x, patch = self.object(part, contrast)
            for moved in range(STAY):
                yield self.take((y, x + 2 * moved, patch)), "object", part, contrast
            for _ in range(AFTER):
                yield self.take(), "after", None, None
