#!/usr/bin/env python3
"""A planar pose graph edge by edge through GTSAM's iSAM2, in the order of `cargo bench -p wayfix-smoother --bench online`.

    gtsam_online.py FILE.g2o[.gz] [RELINEARIZE_THRESHOLD]

Prints median and 99th percentile of the computing time of a step, and the cost (without 1/2) at the end; then what further updates without new edges leave of it.
"""

import gzip
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
    graph, start = read(Path(sys.argv[1]))
    edges = [graph.at(k) for k in range(graph.size())]
    edges = [edge for edge in edges if edge is not None and len(edge.keys()) == 2]
    edges.sort(key=lambda edge: (max(edge.keys()), abs(edge.keys()[0] - edge.keys()[1])))
    params = gtsam.ISAM2Params()
    params.setRelinearizeThreshold(float(sys.argv[2]) if len(sys.argv) > 2 else 0.1)
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
    print(f"{len(steps)} steps, median {quantile(0.5):.2f} ms, 99 % {quantile(0.99):.2f} ms, sum {sum(seconds):.1f} s")
    print(f"cost {cost():.9e}", flush=True)
    for _ in range(N_FURTHER):
        isam.update()
    print(f"after {N_FURTHER} updates without new edges {cost():.9e}")


if __name__ == "__main__":
    main()
