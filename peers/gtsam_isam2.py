#!/usr/bin/env python3
"""A range-bearing log through GTSAM's iSAM2, known ids: the smoother that relinearizes while the log runs."""

import sys
import time
from pathlib import Path

import gtsam
import numpy as np
from gtsam.symbol_shorthand import L, X

from numpy_ekf_slam import read_log


def smooth(steps):
    """Positions as they were known when they were passed, and the seconds that each step took."""
    params = gtsam.ISAM2Params()
    params.setRelinearizeThreshold(0.1)
    params.relinearizeSkip = 1
    isam = gtsam.ISAM2(params)
    sigmas = gtsam.noiseModel.Diagonal.Sigmas
    moved, seen, fixed = (sigmas(np.array(s)) for s in ([0.02, 0.02, 0.005], [0.01, 0.05], [1e-6] * 3))
    pose, known, path, seconds = gtsam.Pose2(0, 0, 0), set(), [], []
    for k, (_, odometry, sightings) in enumerate(steps):
        began = time.perf_counter()
        graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
        if k == 0:
            graph.add(gtsam.PriorFactorPose2(X(0), pose, fixed))
        else:
            increment = gtsam.Pose2(*odometry)
            graph.add(gtsam.BetweenFactorPose2(X(k - 1), X(k), increment, moved))
            pose = pose.compose(increment)
        values.insert(X(k), pose)
        for landmark, distance, bearing in sightings:
            graph.add(gtsam.BearingRangeFactor2D(X(k), L(landmark), gtsam.Rot2(bearing), distance, seen))
            if landmark not in known:
                known.add(landmark)
                place = distance * np.array([np.cos(bearing), np.sin(bearing)])
                values.insert(L(landmark), pose.transformFrom(place))
        isam.update(graph, values)
        pose = isam.calculateEstimatePose2(X(k))
        seconds.append(time.perf_counter() - began)
        path.append((pose.x(), pose.y()))
    return np.array(path), seconds, len(known)


def main():
    log = Path(sys.argv[1])
    steps = read_log(log)
    path, seconds, n_landmarks = smooth(steps)
    x, y, heading = steps[0][0]
    turn = np.array([[np.cos(heading), np.sin(heading)], [-np.sin(heading), np.cos(heading)]])
    truth = np.array([turn @ (pose[:2] - (x, y)) for pose, _, _ in steps])
    rmse = np.sqrt(np.mean(np.sum((path - truth) ** 2, axis=1)))
    print(f"landmarks {n_landmarks}, path RMSE {rmse:.4f} m, worst step {1e3 * max(seconds):.1f} ms")
    print(f"bench\tekf_slam_step/{log.stem}\tGTSAM iSAM2\t{1e9 * np.mean(seconds):.0f}", flush=True)


if __name__ == "__main__":
    main()
