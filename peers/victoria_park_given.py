#!/usr/bin/env python3
"""Victoria Park with the association that GTSAM's example data gives, as a folder that `wayfix run slam --association known` reads.

    victoria_park_given.py VICTORIA_PARK OUT

VICTORIA_PARK holds odometry.csv, trees.csv, gps.csv and known_association.txt, a graph without stamps: `ODOMETRY i j dx dy dθ …` from pose to pose,
`LANDMARK pose landmark x y …` in the frame of the rear axle. Its poses are scans, of which it left out 280 while the car stood still. Which ones is found by
comparing the length of every step with the odometry between scans (dynamic programming); the steps then agree to 3 cm on average, 9 cm at most. Sightings are
the graph's own, some of them of trees that trees.csv lacks.
"""

import math
import shutil
import sys
from pathlib import Path

import numpy as np

LASER = np.array([3.78, 0.5])  # m, from the rear axle
WHEEL_BASE, WHEEL_OFFSET = 2.83, 0.76  # m
SCAN_PERIOD = 0.2141  # s
MOST_LEFT_OUT = 5  # scans in a row, between two poses


def scan_stamps(trees):
    """Stamps of all scans; those without a tree are not in the table and lie evenly between their neighbours."""
    stamps = np.unique(trees[:, 0])
    full = [stamps[0]]
    for before, after in zip(stamps, stamps[1:]):
        n = max(round((after - before) / SCAN_PERIOD), 1)
        full.extend(before + (after - before) * np.arange(1, n + 1) / n)
    return np.array(full)


def path_length(odometry, stamps):
    """How far the rear axle has come at each stamp, m. [Guivant & Nebot 2001, Eq. 1]"""
    t, wheel, steering = odometry.T
    speed = wheel / (1 - np.tan(steering) * WHEEL_OFFSET / WHEEL_BASE)
    return np.interp(stamps, t, np.concatenate([[0], np.cumsum(speed[:-1] * np.diff(t))]))


def scans_of_poses(steps, lengths):
    """For each pose its scan, in order, so that steps differ as little as they can from the way between their scans."""
    n_poses = len(steps) + 1
    n_left_out = len(lengths) - n_poses
    cost = np.zeros(n_left_out + 1)
    came_from = np.zeros((n_poses, n_left_out + 1), int)
    for pose in range(1, n_poses):
        best = np.full(n_left_out + 1, np.inf)
        for skipped in range(MOST_LEFT_OUT + 1):
            before = np.arange(n_left_out + 1 - skipped)
            way = lengths[pose + before + skipped] - lengths[pose - 1 + before]
            total = cost[before] + np.abs(steps[pose - 1] - way)
            better = total < best[before + skipped]
            best[before + skipped] = np.where(better, total, best[before + skipped])
            came_from[pose, before + skipped] = np.where(better, before, came_from[pose, before + skipped])
        cost = best
    left_out = np.zeros(n_poses, int)
    left_out[-1] = cost.argmin()
    for pose in range(n_poses - 1, 0, -1):
        left_out[pose - 1] = came_from[pose, left_out[pose]]
    return np.arange(n_poses) + left_out


def main():
    folder, out = map(Path, sys.argv[1:3])
    table = lambda name: np.loadtxt(folder / name, delimiter=",", skiprows=1)  # noqa: E731
    rows = [line.split() for line in (folder / "known_association.txt").read_text().splitlines()]
    odometry = [row for row in rows if row[0] == "ODOMETRY"]
    poses = [odometry[0][1]] + [row[2] for row in odometry]
    steps = np.array([float(row[3]) for row in odometry])
    stamps = scan_stamps(table("trees.csv"))
    lengths = path_length(table("odometry.csv"), stamps)
    scans = scans_of_poses(steps, lengths)
    apart = np.abs(steps - np.diff(lengths[scans]))
    print(f"{len(poses)} poses of {len(stamps)} scans; steps differ by {apart.mean():.3f} m, at most {apart.max():.3f} m")

    stamp_of = dict(zip(poses, stamps[scans]))
    out.mkdir(parents=True, exist_ok=True)
    for name in ("odometry.csv", "gps.csv"):
        shutil.copyfile(folder / name, out / name)
    with open(out / "trees.csv", "w", encoding="utf-8") as trees:
        trees.write("t_s,range_m,bearing_rad,diameter_m,landmark\n")
        sightings = [row for row in rows if row[0] == "LANDMARK"]
        for _, pose, landmark, x, y, *_ in sorted(sightings, key=lambda row: stamp_of[row[1]]):
            ahead, left = np.array([float(x), float(y)]) - LASER
            bearing = math.atan2(left, ahead) + math.pi / 2  # a laser counts from the right
            trees.write(f"{stamp_of[pose]:.3f},{math.hypot(ahead, left):.4f},{bearing:.6f},0,{landmark}\n")


if __name__ == "__main__":
    main()
