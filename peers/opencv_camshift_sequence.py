#!/usr/bin/env python3
"""OpenCV's CamShift and meanShift on a sequence: how well they follow a target from its first true box.

    opencv_camshift_sequence.py FRAMES TRUTH

FRAMES is a folder of pictures, TRUTH has a line x,y,w,h for each of them in the order of names. The model is a histogram of hue (16
bins) of the pixels in the first box that are neither too dark nor too grey, as in OpenCV's tutorial. Prints mean overlap, success AUC and
the share of frames within 20 pixels, of the upright box that each program returns.
"""

import sys
from pathlib import Path

import cv2
import numpy as np

THRESHOLDS = np.linspace(0, 1, 21)


def overlap(one, other):
    width = min(one[0] + one[2], other[0] + other[2]) - max(one[0], other[0])
    height = min(one[1] + one[3], other[1] + other[3]) - max(one[1], other[1])
    shared = max(width, 0) * max(height, 0)
    return shared / (one[2] * one[3] + other[2] * other[3] - shared)


def distance(one, other):
    return np.hypot(one[0] + one[2] / 2 - other[0] - other[2] / 2, one[1] + one[3] / 2 - other[1] - other[3] / 2)


def hue_and_mask(frame):
    hsv = cv2.cvtColor(frame, cv2.COLOR_BGR2HSV)
    return hsv, cv2.inRange(hsv, (0, 60, 32), (180, 255, 255))


def follow(step, frames, truth):
    """Boxes of one program, the first one given."""
    x, y, w, h = window = tuple(int(round(number)) for number in truth[0])
    hsv, mask = hue_and_mask(cv2.imread(str(frames[0])))
    region, inside = hsv[y : y + h, x : x + w], mask[y : y + h, x : x + w]
    model = cv2.calcHist([region], [0], inside, [16], [0, 180])
    cv2.normalize(model, model, 0, 255, cv2.NORM_MINMAX)
    criteria = (cv2.TERM_CRITERIA_EPS | cv2.TERM_CRITERIA_COUNT, 10, 1)
    boxes = [truth[0]]
    for path in frames[1:]:
        hsv, mask = hue_and_mask(cv2.imread(str(path)))
        back = cv2.calcBackProject([hsv], [0], model, [0, 180], 1) & mask
        _, window = step(back, window, criteria)
        if window[2] < 1 or window[3] < 1:  # it has shrunk to nothing: begin again where it was
            window = (window[0], window[1], w, h)
        boxes.append(window)
    return boxes


def main(folder, truth_file):
    frames = sorted(path for path in Path(folder).iterdir() if path.suffix.lower() in (".png", ".jpg"))
    text = Path(truth_file).read_text().replace(",", " ").replace("\t", " ")
    truth = [tuple(float(word) for word in line.split()) for line in text.splitlines() if line.strip()]
    for name, step in (("CamShift", cv2.CamShift), ("meanShift", lambda *a: cv2.meanShift(*a))):
        boxes = follow(step, frames, truth)
        seen = [(box, true) for box, true in zip(boxes, truth) if true[2] > 0 and true[3] > 0]
        ious = np.array([overlap(box, true) for box, true in seen])
        near = np.mean([distance(box, true) <= 20 for box, true in seen])
        auc = np.mean([np.mean(ious > threshold) for threshold in THRESHOLDS])
        print(f"{name}\tiou_mean {ious.mean():.3f}\tsuccess_auc {auc:.3f}\tprecision_20px {near:.3f}")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
