#!/usr/bin/env python3
"""EKF-SLAM in numpy on a range-bearing log with known ids: all sightings of a step in one dense update.

    numpy_ekf_slam.py LOG

An oracle that shares no code with the Rust filters, and a peer for `cargo xtask bench --peers`.
"""

import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np  # noqa: E402  (the thread counts must be set first)

# The noise that the logs were made with.
ODOMETRY_NOISE = np.diag([0.02**2, 0.02**2, 0.005**2])
SIGHTING_NOISE = np.diag([0.05**2, 0.01**2])


def read_log(path):
    """Steps of [true pose, odometry increment, [(id, range, bearing), …]]."""
    steps = []
    for line in Path(path).read_text().splitlines():
        kind, *rest = line.split()
        numbers = [float(number) for number in rest]
        if kind == "P":
            steps.append([np.array(numbers), None, []])
        elif kind == "O":
            steps[-1][1] = np.array(numbers)
        elif kind == "Z":
            steps[-1][2].append((int(numbers[0]), numbers[1], numbers[2]))
    return steps


def wrap(angle):
    return (angle + np.pi) % (2 * np.pi) - np.pi


class EkfSlam:
    """State (x, y, θ, landmarks); the robot starts at the origin, certain of it."""

    def __init__(self):
        self.state = np.zeros(3)
        self.covariance = np.zeros((3, 3))
        self.index = {}

    def predict(self, odometry):
        c, s = np.cos(self.state[2]), np.sin(self.state[2])
        dx, dy, turn = odometry
        rotation = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
        jacobian = np.array([[1, 0, -s * dx - c * dy], [0, 1, c * dx - s * dy], [0, 0, 1]])
        self.state[:3] += [c * dx - s * dy, s * dx + c * dy, turn]
        p = self.covariance
        p[:3, :3] = jacobian @ p[:3, :3] @ jacobian.T + rotation @ ODOMETRY_NOISE @ rotation.T
        p[:3, 3:] = jacobian @ p[:3, 3:]
        p[3:, :3] = p[:3, 3:].T

    def update(self, sightings):
        known = [sighting for sighting in sightings if sighting[0] in self.index]
        fresh = [sighting for sighting in sightings if sighting[0] not in self.index]
        if known:
            self.correct(known)
        for sighting in fresh:
            self.augment(*sighting)

    def correct(self, sightings):
        n, m = len(self.state), len(sightings)
        jacobian, innovation = np.zeros((2 * m, n)), np.zeros(2 * m)
        for row, (landmark, distance, bearing) in zip(range(0, 2 * m, 2), sightings):
            at = self.index[landmark]
            dx, dy = self.state[at : at + 2] - self.state[:2]
            squared = dx * dx + dy * dy
            expected = np.sqrt(squared)
            innovation[row] = distance - expected
            innovation[row + 1] = wrap(bearing - (np.arctan2(dy, dx) - self.state[2]))
            jacobian[row, :2] = -dx / expected, -dy / expected
            jacobian[row, at : at + 2] = dx / expected, dy / expected
            jacobian[row + 1, :3] = dy / squared, -dx / squared, -1
            jacobian[row + 1, at : at + 2] = -dy / squared, dx / squared
        cross = jacobian @ self.covariance
        innovation_covariance = cross @ jacobian.T + np.kron(np.eye(m), SIGHTING_NOISE)
        gain = np.linalg.solve(innovation_covariance, cross).T
        self.state = self.state + gain @ innovation
        covariance = self.covariance - gain @ cross
        self.covariance = 0.5 * (covariance + covariance.T)

    def augment(self, landmark, distance, bearing):
        self.index[landmark] = len(self.state)
        c, s = np.cos(self.state[2] + bearing), np.sin(self.state[2] + bearing)
        by_pose = np.array([[1, 0, -distance * s], [0, 1, distance * c]])
        by_sighting = np.array([[c, -distance * s], [s, distance * c]])
        p = self.covariance
        cross = by_pose @ p[:3, :]
        own = by_pose @ p[:3, :3] @ by_pose.T + by_sighting @ SIGHTING_NOISE @ by_sighting.T
        self.covariance = np.block([[p, cross.T], [cross, own]])
        self.state = np.append(self.state, self.state[:2] + distance * np.array([c, s]))


def main(path):
    steps = read_log(path)
    ekf, times, squared_errors, nees = EkfSlam(), [], [], []
    start_x, start_y, start_heading = steps[0][0]
    c, s = np.cos(start_heading), np.sin(start_heading)
    for k, (truth, odometry, sightings) in enumerate(steps):
        began = time.perf_counter()
        if k > 0:
            ekf.predict(odometry)
        ekf.update(sightings)
        times.append(time.perf_counter() - began)

        dx, dy = truth[0] - start_x, truth[1] - start_y
        local_truth = np.array([c * dx + s * dy, -s * dx + c * dy, truth[2] - start_heading])
        error = ekf.state[:3] - local_truth
        error[2] = wrap(error[2])
        squared_errors.append(error[:2] @ error[:2])
        if k > 0:
            nees.append(error @ np.linalg.solve(ekf.covariance[:3, :3], error))
    nanoseconds = 1e9 * np.array(times)
    print(f"bench\tekf_slam_step/{Path(path).stem}\tnumpy\t{nanoseconds.mean():.0f}")
    print(
        f"numpy {np.__version__}, known: {len(ekf.index)} landmarks, path RMSE {np.sqrt(np.mean(squared_errors)):.4f} m, "
        f"NEES {np.mean(nees):.2f}, median {np.median(nanoseconds) / 1e3:.0f} us, worst {nanoseconds.max() / 1e3:.0f} us"
    )


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
