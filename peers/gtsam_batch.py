#!/usr/bin/env python3
"""The batch of a run in GTSAM, on the same factors: its cost at the solution of Wayfix, and where Levenberg–Marquardt leads from three starts.

    wayfix run slam --log MRCLAM_Dataset7 --robot 1 --graph-out robot1.txt
    gtsam_batch.py --limit 300 robot1.txt=MRCLAM_Dataset7/Robot1_Groundtruth.dat victoria.txt=victoria_park/gps.csv,3.78,0.5 …

Each argument is a graph, then the truth, then what of the robot the truth is of (x, y in the robot frame, m). Truth: `t x y …` lines, `t,x,y` rows, or the
`P x y φ` lines of a range-bearing log, 0.1 s apart. Prints a table: the cost of Wayfix, how far GTSAM's cost of the same values is from it, relative to it,
and the largest distance between the paths of Wayfix and of GTSAM from there. The last three columns say how far GTSAM lowers the cost, relative to that of
Wayfix (negative: it stays above), with iterations, time and aligned error: from Wayfix's solution in at most ten iterations, from the filter's estimates, and
from odometry alone with landmarks where they are first seen, until a step gains less than 1e-9 or the time is over (`>`).
"""

import argparse
import time
from pathlib import Path

import gtsam
import numpy as np

from gtsam_fixed_lag import CAUCHY, FULL, Problem, aligned_rmse, symmetric

LEAST_GAIN = 1e-9


class Batch:
    """Factors and values. With a scale of 1 all poses are those of the sensor, since GTSAM has factors in C++ then."""

    def __init__(self, problem):
        self.problem, self.graph = problem, gtsam.NonlinearFactorGraph()
        mounts = {str(mount) for _, _, mount, _ in problem.detections}
        self.is_native = problem.held >= {problem.scale, problem.order[0]} and len(mounts) == 1
        self.mount = problem.detections[0][2] if self.is_native else gtsam.Pose2()
        for factor in (factor for factors in problem.factors.values() for factor in factors):
            if not self.is_native:
                self.graph.add(factor)
            elif isinstance(factor, gtsam.BetweenFactorPose2):
                self.graph.add(self.of_sensor(factor))
            elif isinstance(factor, gtsam.PriorFactorPose2):
                self.graph.add(gtsam.PriorFactorPose2(factor.keys()[0], factor.prior().compose(self.mount), factor.noiseModel()))
            elif isinstance(factor, gtsam.PriorFactorPoint2):
                self.graph.add(factor)
        for keys, (distance, bearing), _, information in problem.detections if self.is_native else []:
            swapped = FULL(symmetric(information, 2)[::-1, ::-1])
            noise = gtsam.noiseModel.Robust.Create(CAUCHY, swapped)
            self.graph.add(gtsam.BearingRangeFactor2D(*keys[:2], gtsam.Rot2(bearing), distance, noise))

    def of_sensor(self, factor):
        """log(m⁻¹ E m) = Ad(m⁻¹) log(E): the same cost."""
        carry = self.mount.AdjointMap()
        information = carry.T @ factor.noiseModel().information() @ carry
        measured = self.mount.inverse().compose(factor.measured()).compose(self.mount)
        return gtsam.BetweenFactorPose2(*factor.keys(), measured, FULL((information + information.T) / 2))

    def values(self, poses, landmarks, log_scale):
        values = gtsam.Values()
        for key, pose in poses.items():
            values.insert(key, pose.compose(self.mount))
        for key, place in landmarks.items():
            values.insert(key, np.asarray(place))
        if not self.is_native:
            values.insert(self.problem.scale, np.asarray(log_scale))
        return values

    def solution(self):
        of, problem = self.problem.solution, self.problem
        poses = {key: gtsam.Pose2(*of[key]) for key in problem.poses}
        return self.values(poses, {key: of[key] for key in problem.landmarks}, of[problem.scale])

    def filtered(self):
        return self.values(self.problem.poses, self.problem.landmarks, self.problem.log_scale)

    def dead_reckoned(self):
        problem, poses, landmarks = self.problem, {self.problem.order[0]: self.problem.poses[self.problem.order[0]]}, {}
        for factors in problem.factors.values():
            for factor in factors:
                if isinstance(factor, gtsam.BetweenFactorPose2):
                    before, after = factor.keys()
                    poses[after] = poses[before].compose(factor.measured())
        for (pose, landmark, _), (distance, bearing), mount, _ in problem.detections:
            seen = distance * np.array([np.cos(bearing), np.sin(bearing)])
            landmarks.setdefault(landmark, poses[pose].compose(mount).transformFrom(seen))
        held = {key: problem.landmarks[key] for key in problem.held if key in problem.landmarks}
        return self.values(poses, problem.landmarks | landmarks | held, problem.log_scale)

    def optimize(self, values, limit, most=10**6):
        """Final values and cost, iterations, seconds, and whether it came to an end."""
        began, n = time.perf_counter(), 0
        optimizer = gtsam.LevenbergMarquardtOptimizer(self.graph, values, gtsam.LevenbergMarquardtParams())
        cost, ended = optimizer.error(), False
        while n < most and time.perf_counter() < began + limit and not ended:
            optimizer.iterate()
            before, cost, n = cost, optimizer.error(), n + 1
            ended = before - cost <= LEAST_GAIN * before
        return optimizer.values(), 2 * cost, n, time.perf_counter() - began, ended

    def path(self, values, at=(0.0, 0.0)):
        poses = (values.atPose2(key).compose(self.mount.inverse()) for key in self.problem.order)
        return np.array([pose.transformFrom(np.array(at)) for pose in poses])


def truth_of(path):
    lines = Path(path).read_text().splitlines()
    robot = [line.split()[1:3] for line in lines if line.startswith("P ")]
    if robot:
        return np.column_stack([0.1 * np.arange(len(robot)), np.array(robot, float)])
    rows = [line.replace(",", " ").split()[:3] for line in lines if line[:1].isdigit() or line[:1] == "-"]
    return np.array(rows, float)


def aligned_error(path, stamps, truth):
    """Aligned rms, by the true position at most 0.3 s away from the line between two that are at most 30 m apart."""
    after = np.clip(np.searchsorted(truth[:, 0], stamps), 1, len(truth) - 1)
    near = np.minimum(abs(truth[after, 0] - stamps), abs(truth[after - 1, 0] - stamps)) <= 0.3
    near &= np.linalg.norm(truth[after, 1:] - truth[after - 1, 1:], axis=1) <= 30
    true = np.stack([np.interp(stamps, truth[:, 0], truth[:, axis]) for axis in (1, 2)], axis=1)
    return aligned_rmse(path[near], true[near])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("graphs", nargs="+", metavar="GRAPH=TRUTH[,X,Y]")
    parser.add_argument("--limit", type=float, default=300, help="seconds for each start")
    arguments = parser.parse_args()
    print("| graph | poses | detections | cost | of GTSAM there | aligned error, m | paths apart, m | from there | from the filter | from odometry |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |")
    for argument in arguments.graphs:
        path, truth, *at = argument.replace("=", ",").split(",")
        problem = Problem(path)
        batch, at = Batch(problem), [float(x) for x in at] or [0.0, 0.0]
        solution = batch.solution()
        there = 2 * batch.graph.error(solution)
        stamps = np.array([problem.stamps[key] for key in problem.order])
        error = lambda values: aligned_error(batch.path(values, at), stamps, truth_of(truth))  # noqa: E731
        row = [Path(path).stem, len(problem.order), len(problem.detections), f"{problem.cost:.6f}", f"{there / problem.cost - 1:+.0e}"]
        falls = []
        for values, most in ((solution, 10), (batch.filtered(), 10**6), (batch.dead_reckoned(), 10**6)):
            found, cost, n, seconds, ended = batch.optimize(values, arguments.limit, most)
            falls.append(f"{1 - cost / problem.cost:+.0e} ({n} in {'' if ended else '> '}{seconds:.0f} s, {error(found):.4f} m)")
            if values is solution:
                row += [f"{error(solution):.4f}", f"{np.abs(batch.path(found) - batch.path(solution)).max():.0e}"]
        print(f"| {' | '.join(map(str, row + falls))} |", flush=True)


if __name__ == "__main__":
    main()
