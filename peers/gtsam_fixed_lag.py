#!/usr/bin/env python3
"""The least squares problem of a run in GTSAM: as a batch, in a window that drops poses, and by iSAM2, which drops none.

    wayfix run slam --log MRCLAM_Dataset7 --robot 1 --graph-out robot1.txt
    gtsam_fixed_lag.py robot1.txt [MRCLAM_Dataset7/Robot1_Groundtruth.dat]

Prints the cost of the batch, and the error of each path after the best rigid motion: against the batch, and against the truth where it is given
(`t x y …` lines). In the window and in iSAM2 a pose counts as it is estimated when it becomes older than the lag; both are solved once a second.
iSAM2 shows how far the measurements until then can lead.
"""

import sys
import time
from pathlib import Path

import gtsam
import numpy as np

LAG, PERIOD = 60.0, 1.0
CAUCHY = gtsam.noiseModel.mEstimator.Cauchy.Create(2.385)
HELD = 1e-6
FULL = gtsam.noiseModel.Gaussian.Information


def symmetric(entries, n):
    matrix = np.zeros((n, n))
    matrix[np.triu_indices(n)] = entries
    return matrix + np.triu(matrix, 1).T


class Problem:
    """Factors in the order of the poses that they need, where variables start, and the solution of Wayfix."""

    def __init__(self, path):
        self.stamps, self.poses, self.landmarks, self.factors, self.solution = {}, {}, {}, {}, {}
        self.held, self.detections, at_start = set(), [], []
        latest = 0.0
        for line in Path(path).read_text().splitlines():
            kind, *words = line.split()
            x = [float(word) for word in words]
            if kind == "POSE":
                # No estimate was asked for after a pose without a time.
                self.stamps[int(x[0])] = latest = max(x[1], latest)
                self.poses[int(x[0])] = gtsam.Pose2(*x[2:5])
            elif kind == "LANDMARK":
                self.landmarks[int(x[0])] = np.array(x[1:3])
            elif kind == "LOG_SCALE":
                self.scale, self.log_scale = int(x[0]), np.array(x[1:2])
            elif kind == "HELD":
                self.held.add(int(x[0]))
                at_start.append(self.tight_prior(int(x[0])))
            elif kind == "START":
                at_start.append(start([int(key) for key in x[1 : int(x[0]) + 1]], x[int(x[0]) + 1 :], self))
            elif kind == "MOTION":
                i, j = int(x[0]), int(x[1])
                self.add(j, gtsam.BetweenFactorPose2(i, j, gtsam.Pose2(*x[2:5]), FULL(symmetric(x[5:], 3))))
            elif kind == "DETECTION":
                self.detections.append(([int(key) for key in x[:3]], x[3:5], gtsam.Pose2(*x[5:8]), x[8:]))
                self.add(int(x[0]), detection(*self.detections[-1]))
            elif kind == "COST":
                self.cost = x[0]
            elif kind == "SOLUTION":
                self.solution[int(x[0])] = x[1:]
        self.order = list(self.poses)
        self.factors[self.order[0]] = at_start + self.factors.get(self.order[0], [])

    def add(self, pose, factor):
        self.factors.setdefault(pose, []).append(factor)

    def tight_prior(self, key):
        noise = lambda n: gtsam.noiseModel.Isotropic.Sigma(n, HELD)  # noqa: E731
        if key in self.poses:
            return gtsam.PriorFactorPose2(key, self.poses[key], noise(3))
        if key in self.landmarks:
            return gtsam.PriorFactorPoint2(key, self.landmarks[key], noise(2))
        return gtsam.PriorFactorVector(key, self.log_scale, noise(1))


def start(keys, numbers, problem):
    """A Gaussian of poses, landmarks and the logarithm of the scale."""
    dims = [3 if key in problem.poses else 2 if key in problem.landmarks else 1 for key in keys]
    n = sum(dims)
    means = np.split(np.array(numbers[:n]), np.cumsum(dims)[:-1])

    def error(_, values, jacobians):
        parts = []
        for place, (key, dim, mean) in enumerate(zip(keys, dims, means)):
            by_own = np.eye(dim)
            if dim == 3:
                moved = gtsam.Pose2(*mean).between(values.atPose2(key))
                parts.append(gtsam.Pose2.Logmap(moved))
                by_own = gtsam.Pose2.LogmapDerivative(moved)
            else:
                parts.append((values.atPoint2(key) if dim == 2 else values.atVector(key)) - mean)
            if jacobians is not None:
                jacobians[place] = np.zeros((n, dim), order="F")
                jacobians[place][sum(dims[:place]) : sum(dims[: place + 1])] = by_own
        return np.concatenate(parts)

    return gtsam.CustomFactor(FULL(symmetric(numbers[n:], n)), keys, error)


def detection(keys, measured, mount, information):
    to_sensor = mount.inverse().AdjointMap()

    def error(_, values, jacobians):
        sensor = values.atPose2(keys[0]).compose(mount)
        x, y = sensor.transformTo(values.atPoint2(keys[1]))
        distance, scale = np.hypot(x, y), np.exp(values.atVector(keys[2])[0])
        if jacobians is not None:
            by_seen = np.array([[x * scale, y * scale], [-y / distance, x / distance]]) / distance
            jacobians[0] = by_seen @ np.array([[-1, 0, y], [0, -1, -x]]) @ to_sensor
            jacobians[1] = by_seen @ sensor.rotation().matrix().T
            jacobians[2] = np.array([[scale * distance], [0.0]])
        turn = np.arctan2(y, x) - measured[1]
        return np.array([scale * distance - measured[0], (turn + np.pi) % (2 * np.pi) - np.pi])

    noise = gtsam.noiseModel.Robust.Create(CAUCHY, FULL(symmetric(information, 2)))
    return gtsam.CustomFactor(noise, keys, error)


def batch(problem):
    """All at once from where the filter was."""
    graph, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
    for factors in problem.factors.values():
        for factor in factors:
            graph.add(factor)
    for id, pose in problem.poses.items():
        values.insert(id, pose)
    for id, place in problem.landmarks.items():
        values.insert(id, place)
    values.insert(problem.scale, problem.log_scale)
    params = gtsam.LevenbergMarquardtParams()
    params.setRelativeErrorTol(1e-12)
    params.setAbsoluteErrorTol(1e-12)
    values = gtsam.LevenbergMarquardtOptimizer(graph, values, params).optimize()
    print(f"batch cost {2 * graph.error(values):.9f}")
    return {id: values.atPose2(id) for id in problem.order}


def online(problem, smoother, drops):
    """Each pose as it is when it becomes older than the lag; landmarks stay."""
    settled, known, estimate, solved = {}, {problem.scale}, None, -np.inf
    graph, values, pose = gtsam.NonlinearFactorGraph(), gtsam.Values(), problem.poses[problem.order[0]]
    values.insert(problem.scale, problem.log_scale)
    waiting, stamps = list(problem.order), {}
    for number, id in enumerate(problem.order):
        stamp = problem.stamps[id]
        factors = problem.factors.get(id, [])
        for factor in factors:
            graph.add(factor)
            if isinstance(factor, gtsam.BetweenFactorPose2):
                pose = pose.compose(factor.measured())
        values.insert(id, pose)
        stamps[id] = stamp
        for factor in factors:
            new = [key for key in factor.keys() if key in problem.landmarks and key not in known]
            for key in new:
                # Where the filter has it: as good as where the detection is.
                values.insert(key, pose.transformFrom(problem.poses[id].transformTo(problem.landmarks[key])))
                known.add(key)
        if stamp < solved + PERIOD and number + 1 < len(problem.order):
            continue
        solved, before = stamp, estimate
        if drops:
            smoother.update(graph, values, {**stamps, **dict.fromkeys(known, stamp)})
        else:
            smoother.update(graph, values)
            smoother.update()
        graph, values, stamps = gtsam.NonlinearFactorGraph(), gtsam.Values(), {}
        estimate = smoother.calculateEstimate()
        pose = estimate.atPose2(id)
        while waiting and (problem.stamps[waiting[0]] < stamp - LAG or number + 1 == len(problem.order)):
            oldest = waiting.pop(0)
            settled[oldest] = (estimate if estimate.exists(oldest) else before).atPose2(oldest)
    return settled


def aligned_rmse(path, reference):
    """After the best rigid motion. [Umeyama 1991]"""
    a, b = path - path.mean(0), reference - reference.mean(0)
    u, _, vt = np.linalg.svd(a.T @ b)
    turn = u @ np.diag([1, np.linalg.det(u @ vt)]) @ vt
    return np.sqrt(np.mean(np.sum((a @ turn - b) ** 2, axis=1)))


def main():
    problem = Problem(sys.argv[1])
    truth = np.loadtxt(sys.argv[2]) if len(sys.argv) > 2 else None
    stamps = np.array([problem.stamps[id] for id in problem.order])
    params = gtsam.ISAM2Params()
    params.setRelinearizeThreshold(0.01)
    params.relinearizeSkip = 1
    runs = {
        "batch": lambda: batch(problem),
        "window": lambda: online(problem, gtsam.BatchFixedLagSmoother(LAG + PERIOD), True),
        "iSAM2": lambda: online(problem, gtsam.ISAM2(params), False),
    }
    reference = None
    for name, run in runs.items():
        began = time.perf_counter()
        poses = run()
        path = np.array([[poses[id].x(), poses[id].y()] for id in problem.order])
        reference = path if reference is None else reference
        line = f"{name}: {aligned_rmse(path, reference):.4f} m from the batch"
        if truth is not None:
            within = (stamps >= truth[0, 0]) & (stamps <= truth[-1, 0])
            true = np.stack([np.interp(stamps, truth[:, 0], truth[:, axis]) for axis in (1, 2)], axis=1)
            line += f", {aligned_rmse(path[within], true[within]):.4f} m from the truth"
        print(f"{line}, {time.perf_counter() - began:.0f} s", flush=True)


if __name__ == "__main__":
    main()
