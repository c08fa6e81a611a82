#!/usr/bin/env python3
"""Pose graphs in this project, in GTSAM and in other programs, one after the other in one run.

    cargo bench -p wayfix-smoother --bench pose_graphs --no-run        # prints the PATH
    pose_graphs.py FOLDER PATH [NAME='COMMAND']…

FOLDER has files `.g2o` or `.g2o.gz`. In a COMMAND, `{}` is the file; it prints `own=COST` and `ms=TIME` (computing time without reading the file).
Prints a table: the best cost of this project and GTSAM (without ½), and of each program computing time in ms of start and optimization (median of three runs; of one, if that takes over 10 s) and peak memory
of the process in MB; in brackets if its cost is above the best by more than 1e-4 of it. Residuals differ a little from program to program.
Wayfix computes a start of its own. The others start from the file's poses, or from dead reckoning along the edges i → i + 1 where there are none (planar graphs). GTSAM:
Levenberg–Marquardt.
All run with one thread.
"""

import argparse
import gzip
import math
import os
import re
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

N_RUNS = 3
LONG_MS = 10_000
ONE_THREAD = {"OMP_NUM_THREADS": "1", "TBB_NUM_THREADS": "1", "RAYON_NUM_THREADS": "1"}


def gtsam_alone(path):
    """Prints cost and computing time."""
    import gtsam

    text = Path(path).read_text()
    is_spatial = "EDGE_SE3" in text
    graph, start = gtsam.readG2o(path, is_spatial)
    first = min(start.keys())
    held = gtsam.noiseModel.Isotropic.Sigma(6 if is_spatial else 3, 1e-6)
    prior = gtsam.PriorFactorPose3 if is_spatial else gtsam.PriorFactorPose2
    anchored = gtsam.NonlinearFactorGraph(graph)
    anchored.add(prior(first, start.atPose3(first) if is_spatial else start.atPose2(first), held))
    params = gtsam.LevenbergMarquardtParams()
    params.setRelativeErrorTol(1e-8)
    began = time.process_time()
    found = gtsam.LevenbergMarquardtOptimizer(anchored, start, params).optimize()
    print(f"own={2 * graph.error(found):.9e} ms={1e3 * (time.process_time() - began):.1f}")


def prepare(path, plain):
    """Writes a graph for all programs, in a process of its own: memory of this one would count in theirs."""
    text = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
    plain.write_text(with_start(text.decode()))


def with_start(text):
    """A graph without empty lines, which some readers refuse; a planar one has vertices of dead reckoning if it has none."""
    lines = [line for line in text.splitlines() if line.strip()]
    steps = {}
    for line in lines:
        if line.startswith("EDGE_SE2 "):
            _, i, j, *numbers = line.split()
            if int(j) == int(i) + 1:
                steps[int(i)] = [float(number) for number in numbers[:3]]
    if "VERTEX" in text or not steps:
        return "\n".join(lines) + "\n"
    i, (x, y, heading) = min(steps), (0.0, 0.0, 0.0)
    vertices = [f"VERTEX_SE2 {i} 0 0 0"]
    while i in steps:
        dx, dy, turn = steps[i]
        cos, sin = math.cos(heading), math.sin(heading)
        x, y, heading, i = x + cos * dx - sin * dy, y + sin * dx + cos * dy, heading + turn, i + 1
        vertices.append(f"VERTEX_SE2 {i} {x!r} {y!r} {heading!r}")
    return "\n".join(vertices + lines) + "\n"


def run(command):
    """Cost, time and memory of a program; `None` for one that fails."""
    with tempfile.TemporaryFile("w+") as out:
        process = subprocess.Popen(command, stdout=out, stderr=subprocess.DEVNULL, env={**os.environ, **ONE_THREAD})
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = status
        out.seek(0)
        text = out.read()
    if status != 0:
        return None
    cost, ms = (re.search(pattern, text) for pattern in (r"(?:own=| cost )(\S+)", r"(?:\bms=|median )([\d.]+)"))
    if cost is None or ms is None or not float(cost[1]) > 0.0:
        return None
    return float(cost[1]), float(ms[1]), usage.ru_maxrss / 1024


def repeated(command):
    """Three runs, or one of a program that takes long."""
    results = [run(command)]
    if results[0] is not None and results[0][1] < LONG_MS:
        results += [run(command) for _ in range(N_RUNS - 1)]
    return results


def cell(results, best):
    if None in results:
        return "fails"
    cost, _, megabytes = results[0]
    text = f"{statistics.median(ms for _, ms, _ in results):.0f}/{megabytes:.0f}"
    return text if cost <= best * (1 + 1e-4) else f"({text})"


def main():
    if sys.argv[1] == "--gtsam-alone":
        return gtsam_alone(sys.argv[2])
    if sys.argv[1] == "--prepare":
        return prepare(Path(sys.argv[2]), Path(sys.argv[3]))
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("bench")
    parser.add_argument("programs", nargs="*")
    args = parser.parse_args()
    programs = {"wayfix": [args.bench, "{}"], "GTSAM": [sys.executable, __file__, "--gtsam-alone", "{}"]}
    for program in args.programs:
        name, command = program.split("=", 1)
        programs[name] = shlex.split(command)
    print("| set | cost |", " | ".join(programs), "|\n|", " --- |" * (len(programs) + 2), flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for path in sorted(args.folder.glob("*.g2o*")):
            name = path.name.split(".")[0]
            plain = Path(folder) / f"{name}.g2o"
            subprocess.run([sys.executable, __file__, "--prepare", path, plain], check=True)
            commands = [[word.replace("{}", str(plain)) for word in command] for command in programs.values()]
            results = [repeated(command) for command in commands]
            # The others may report the cost of another residual.
            ours = [runs for name, runs in zip(programs, results) if name in ("wayfix", "GTSAM")]
            best = min((found[0] for runs in ours for found in runs if found), default=math.inf)
            cells = [cell(runs, best) for runs in results]
            print(f"| {name} | {best:.8g} |", " | ".join(cells), "|", flush=True)
            plain.unlink()


if __name__ == "__main__":
    main()
