#!/usr/bin/env python3
"""Simplification of long chains with GEOS (by shapely) and OpenCV (in 32 bits, the only floats it takes here)."""

import math
import time

import cv2
import numpy as np
import shapely


def xorshift():
    """Uniform numbers in [0, 1), those of crates/line-extract/benches/chains.rs."""
    state, mask = 88172645463325252, (1 << 64) - 1
    while True:
        state ^= (state << 13) & mask
        state ^= state >> 7
        state ^= (state << 17) & mask
        yield (state >> 11) / (1 << 53)


def walk(n):
    uniform = xorshift()
    steps = np.empty((n, 2))
    for k in range(n):
        radius = math.sqrt(-2.0 * math.log(max(next(uniform), 1e-300)))
        angle = math.tau * next(uniform)
        steps[k] = radius * math.cos(angle), radius * math.sin(angle)
    return np.cumsum(steps, axis=0)


def circle(n):
    angle = math.tau * 0.999 * np.arange(n) / (n - 1)
    return np.c_[1e3 * np.cos(angle), 1e3 * np.sin(angle)]


def zigzag(n):
    k = np.arange(n)
    return np.c_[k.astype(float), np.where(k % 2 == 0, 0.0, 1e3 * (1.0 - k / n))]


def measure(job, program, run, repeats):
    """Best of many: other load only ever adds."""
    best = math.inf
    for _ in range(repeats):
        began = time.perf_counter()
        run()
        best = min(best, time.perf_counter() - began)
    print(f"bench\t{job}\t{program}\t{1e9 * best:.0f}", flush=True)


def main():
    million = 1_000_000
    for name, points, epsilon in (("walk", walk(million), 5.0), ("circle", circle(million), 1e-3)):
        line = shapely.LineString(points)
        measure(f"simplify {name} {million}", f"GEOS {shapely.geos_version_string}",
                lambda: line.simplify(epsilon, preserve_topology=False), 5)
        floats = points.astype(np.float32).reshape(-1, 1, 2)
        measure(f"simplify {name} {million}", f"OpenCV {cv2.__version__} f32",
                lambda: cv2.approxPolyDP(floats, epsilon, False), 5)
    # GEOS overflows its stack on this one.
    floats = zigzag(100_000).astype(np.float32).reshape(-1, 1, 2)
    measure("simplify zigzag 100000", f"OpenCV {cv2.__version__} f32",
            lambda: cv2.approxPolyDP(floats, 1e-6, False), 1)


if __name__ == "__main__":
    main()
