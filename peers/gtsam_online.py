#!/usr/bin/env python3
"""A planar pose graph edge by edge, in this project and in GTSAM's iSAM2, one after the other in one run, one thread.

    cargo bench -p wayfix-smoother --bench online --no-run        # prints the PATH
    gtsam_online.py FILE.g2o[.gz] PATH [RELINEARIZE_THRESHOLD]

Prints a table: number of steps, median and 99th percentile of the computing time of a step, their sum, and the cost (without 1/2) at the end, relative to the batch's; for iSAM2 too after
20 updates without new edges.
"""

import gzip
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import gtsam

N_FURTHER = 20


def read(path):
    text = gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
    with tempfile.NamedTemporaryFile(suffix=".g2o") as plain:
        plain.write(text)
        plain.flush()
        return gtsam.readG2o(plain.name, False)


def main():
    if len(sys.argv) < 3 or not Path(sys.argv[2]).is_file():
        sys.exit(__doc__)
    graph, start = read(Path(sys.argv[1]))
    edges = [graph.at(k) for k in range(graph.size())]
    edges = [edge for edge in edges if edge is not None and len(edge.keys()) == 2]
    edges.sort(key=lambda edge: (max(edge.keys()), abs(edge.keys()[0] - edge.keys()[1])))
    params = gtsam.ISAM2Params()
    params.setRelinearizeThreshold(float(sys.argv[3]) if len(sys.argv) > 3 else 0.1)
    params.relinearizeSkip = 1
    params.setFactorization("QR")  # Cholesky fails at vertex 1058 of manhattan
    isam = gtsam.ISAM2(params)
    held = gtsam.noiseModel.Isotropic.Sigma(3, 1e-6)
    first, known, seconds = min(start.keys()), set(), []
    for edge in edges:
        began = time.thread_time()
        factors, values = gtsam.NonlinearFactorGraph(), gtsam.Values()
        if not known:
            factors.add(gtsam.PriorFactorPose2(first, start.atPose2(first), held))
            values.insert(first, start.atPose2(first))
            known.add(first)
        i, j = edge.keys()
        at = lambda key: values.atPose2(key) if values.exists(key) else isam.calculateEstimatePose2(key)
        if j not in known:
            values.insert(j, at(i).compose(edge.measured()))
        elif i not in known:
            values.insert(i, at(j).compose(edge.measured().inverse()))
        known.update((i, j))
        factors.add(edge)
        isam.update(factors, values)
        isam.calculateEstimatePose2(j)
        seconds.append(time.thread_time() - began)
    steps = sorted(1e3 * second for second in seconds)
    quantile = lambda share: steps[int((len(steps) - 1) * share)]
    cost = lambda: 2 * graph.error(isam.calculateEstimate())
    own = subprocess.run([sys.argv[2], sys.argv[1]], capture_output=True, text=True, check=True).stdout
    n, median, slow, total = re.search(r": (\d+) steps, median ([\d.]+) ms, 99 % ([\d.]+) ms.* sum ([\d.]+) s", own).groups()
    batch, relative = re.search(r"batch (\S+), relative (\S+)", own).groups()
    print("| program | steps | median, ms | 99 %, ms | sum, s | cost above the batch's |\n| --- | ---: | ---: | ---: | ---: | ---: |")
    print(f"| Wayfix | {n} | {median} | {slow} | {total} | {relative} |")
    above = lambda: f"{cost() / float(batch) - 1:.1e}"
    at_end = above()
    for _ in range(N_FURTHER):
        isam.update()
    times = f"{quantile(0.5):.2f} | {quantile(0.99):.2f} | {sum(seconds):.1f}"
    print(f"| iSAM2 | {len(steps)} | {times} | {at_end}, {above()} after {N_FURTHER} updates more |")


if __name__ == "__main__":
    main()
