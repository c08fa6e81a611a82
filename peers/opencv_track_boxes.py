#!/usr/bin/env python3
"""OpenCV's trackers on the sequences of crates/visual-tracking/examples/01_track_boxes.rs, with the same figures.

opencv_track_boxes.py FOLDER...     each with the frames in img and x,y,w,h a line in groundtruth_rect.txt, corners counted from 1
"""

import sys
import time
from pathlib import Path

import cv2
import numpy as np

cv2.setNumThreads(1)


class HueShift:
    """CamShift or mean shift over the back-projected hue of the first box."""

    def __init__(self, shift):
        self.shift = shift

    def init(self, frame, box):
        self.box = tuple(int(side) for side in box)
        x, y, w, h = self.box
        hsv = cv2.cvtColor(frame[y : y + h, x : x + w], cv2.COLOR_BGR2HSV)
        colored = cv2.inRange(hsv, (0, 40, 30), (180, 255, 255))
        self.histogram = cv2.calcHist([hsv], [0], colored, [32], [0, 180])
        cv2.normalize(self.histogram, self.histogram, 0, 255, cv2.NORM_MINMAX)

    def update(self, frame):
        hsv = cv2.cvtColor(frame, cv2.COLOR_BGR2HSV)
        projected = cv2.calcBackProject([hsv], [0], self.histogram, [0, 180], 1)
        _, box = self.shift(projected, self.box, (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 10, 1))
        if box[2] > 0 and box[3] > 0:
            self.box = box
        return True, self.box


def trackers():
    if hasattr(cv2, "TrackerCSRT_create"):
        yield "CSRT", cv2.TrackerCSRT_create
        yield "KCF", cv2.TrackerKCF_create
        yield "MOSSE", cv2.legacy.TrackerMOSSE_create
    yield "meanShift", lambda: HueShift(cv2.meanShift)
    yield "CamShift", lambda: HueShift(cv2.CamShift)


def overlap(a, b):
    width = min(a[0] + a[2], b[0] + b[2]) - max(a[0], b[0])
    height = min(a[1] + a[3], b[1] + b[3]) - max(a[1], b[1])
    shared = max(0, width) * max(0, height)
    return shared / (a[2] * a[3] + b[2] * b[3] - shared)


def follow(create, folder):
    truths = np.loadtxt(folder / "groundtruth_rect.txt", delimiter=",", ndmin=2) - [1, 1, 0, 0]
    overlaps, near, seconds, tracker = [], 0, 0.0, create()
    frames = sorted((folder / "img").iterdir())
    for k, (path, truth) in enumerate(zip(frames, truths)):
        frame = cv2.imread(str(path))
        began = time.perf_counter()
        if k == 0:
            found, box = True, tuple(int(round(side)) for side in truth)
            tracker.init(frame, box)
        else:
            found, box = tracker.update(frame)
        seconds += time.perf_counter() - began
        if truth[2] > 0 and truth[3] > 0:
            overlaps.append(overlap(box, truth) if found else 0.0)
            off = np.subtract(box[:2], truth[:2]) + np.subtract(box[2:], truth[2:]) / 2
            near += bool(found) and np.hypot(*off) <= 20
    overlaps = np.array(overlaps)
    success = np.mean([(overlaps > 0.05 * step).mean() for step in range(21)])
    return overlaps.mean(), success, near / len(overlaps), 1000 * seconds / len(frames)


print(f"{'sequence':28} {'tracker':10} {'iou':>6} {'auc':>6} {'p20':>6} {'ms':>7}")
for folder in map(Path, sys.argv[1:]):
    for name, create in trackers():
        iou, success, precision, milliseconds = follow(create, folder)
        print(f"{folder.name:28} {name:10} {iou:6.3f} {success:6.3f} {precision:6.3f} {milliseconds:7.2f}", flush=True)
