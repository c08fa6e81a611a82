#!/usr/bin/env python3
"""A frame of colour tracking in OpenCV, one thread: the jobs of crates/visual-tracking/benches/track.rs on its frame."""

import math
import time

import cv2
import numpy as np

SIZE = (320, 240)
LEFT, TOP, SIDE = 130, 90, 60
N_HYPOTHESES = 300


def xorshift():
    """Uniform numbers in [0, 1), those of crates/visual-tracking/benches/track.rs."""
    state, mask = 88172645463325252, (1 << 64) - 1
    while True:
        state ^= (state << 13) & mask
        state ^= state >> 7
        state ^= (state << 17) & mask
        yield (state >> 11) / (1 << 53)


def frame():
    uniform = xorshift()
    rgb = np.array([int(256 * next(uniform)) for _ in range(3 * SIZE[0] * SIZE[1])], np.uint8)
    rgb = rgb.reshape(SIZE[1], SIZE[0], 3)
    v, u = np.mgrid[: SIZE[1], : SIZE[0]]
    disc = np.hypot(u - 160.0, v - 120.0) < 30.0
    green = 90 + rgb[..., 1] // 16
    rgb[disc] = np.stack([np.full_like(green, 240), green, np.full_like(green, 30)], -1)[disc]
    return np.ascontiguousarray(rgb[..., ::-1])


def measure(job, run, calls):
    """Best of many: other load only ever adds."""
    best = math.inf
    for _ in range(calls):
        began = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - began)
    print(f"bench\t{job}\tOpenCV {cv2.__version__}\t{1e9 * best:.0f}", flush=True)


def main():
    cv2.setNumThreads(1)
    image = frame()
    hsv = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
    target = np.s_[TOP : TOP + SIDE, LEFT : LEFT + SIDE]

    mask = cv2.inRange(hsv, (0, 100, 100), (20, 255, 255))
    square = np.ones((3, 3), np.uint8)
    measure("track segment, one set", lambda: cv2.inRange(hsv, (0, 100, 100), (20, 255, 255)), 200)
    measure("track erode 3x3", lambda: cv2.erode(mask, square), 1000)
    opened = cv2.morphologyEx(mask, cv2.MORPH_OPEN, square)
    measure("track blobs", lambda: cv2.connectedComponentsWithStats(opened, connectivity=8), 500)
    measure("track contour", lambda: cv2.findContours(opened, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE), 500)

    def histogram(pixels):
        h = cv2.calcHist([pixels], [0, 1], None, [8, 8], [0, 180, 0, 256])
        return cv2.normalize(h, h)

    def hypotheses():
        converted = cv2.cvtColor(image, cv2.COLOR_BGR2HSV)
        model = histogram(converted[target])
        windows = (converted[y : y + SIDE, x : x + SIDE] for x, y in places)
        return [cv2.compareHist(model, histogram(window), cv2.HISTCMP_INTERSECT) for window in windows]

    uniform = xorshift()
    places = [(int(260 * next(uniform)), int(180 * next(uniform))) for _ in range(N_HYPOTHESES)]
    measure("track 300 colour hypotheses", hypotheses, 30)


if __name__ == "__main__":
    main()
