#!/usr/bin/env python3
"""Resampling of 1e5 weights with the package `particles`, whose inner loop numba compiles; nanoseconds a particle."""

import time

import numpy as np
from particles import resampling

N = 100_000


def nanoseconds(job, repeats=50):
    """Best of many: other load only ever adds. The first call compiles."""
    job()
    best = float("inf")
    for _ in range(repeats):
        began = time.perf_counter()
        job()
        best = min(best, time.perf_counter() - began)
    return 1e9 * best / N


def main():
    np.random.seed(20_261_121)
    weights = resampling.exp_and_normalise(-0.5 * np.random.uniform(-3.0, 3.0, N) ** 2)
    for scheme in ("systematic", "stratified", "residual", "multinomial"):
        took = nanoseconds(lambda: resampling.resampling(scheme, weights, M=N))
        print(f"bench\tresample {scheme} 1e5\tparticles\t{took:.2f}", flush=True)


if __name__ == "__main__":
    main()
