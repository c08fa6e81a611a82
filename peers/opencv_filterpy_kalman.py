#!/usr/bin/env python3
"""One Kalman predict and update in OpenCV, filterpy, Stone Soup and plain numpy, with whichever of them is installed."""

import importlib.util
import os
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("OMP_NUM_THREADS", "1")

import numpy as np  # noqa: E402  (the thread counts must be set first)


def model(states, measurements):
    """Positions and velocities; the first `measurements` states are seen."""
    transition = np.eye(states)
    half = states // 2
    transition[np.arange(half), np.arange(half) + half] = 0.1
    observation = np.eye(measurements, states)
    return transition, observation, 1e-3 * np.eye(states), 1e-1 * np.eye(measurements)


def opencv(f, h, q, r, z):
    import cv2

    kalman = cv2.KalmanFilter(len(f), len(h), 0, cv2.CV_64F)
    kalman.transitionMatrix, kalman.measurementMatrix = f, h
    kalman.processNoiseCov, kalman.measurementNoiseCov = q, r
    kalman.errorCovPost = np.eye(len(f))

    def step():
        kalman.predict()
        kalman.correct(z)

    return step


def filterpy(f, h, q, r, z):
    from filterpy.kalman import KalmanFilter

    kalman = KalmanFilter(dim_x=len(f), dim_z=len(h))
    kalman.F, kalman.H, kalman.Q, kalman.R, kalman.P = f, h, q, r, np.eye(len(f))

    def step():
        kalman.predict()
        kalman.update(z)

    return step


def stone_soup(f, h, q, r, z):
    from datetime import datetime, timedelta

    from stonesoup.models.measurement.linear import LinearGaussian
    from stonesoup.models.transition.linear import LinearGaussianTimeInvariantTransitionModel
    from stonesoup.predictor.kalman import KalmanPredictor
    from stonesoup.types.detection import Detection
    from stonesoup.types.hypothesis import SingleHypothesis
    from stonesoup.types.state import GaussianState
    from stonesoup.updater.kalman import KalmanUpdater

    motion = LinearGaussianTimeInvariantTransitionModel(transition_matrix=f, covariance_matrix=q)
    sensor = LinearGaussian(ndim_state=len(f), mapping=tuple(range(len(h))), noise_covar=r)
    predictor, updater = KalmanPredictor(motion), KalmanUpdater(sensor)
    now = datetime(2000, 1, 1)
    state = GaussianState(np.zeros((len(f), 1)), np.eye(len(f)), timestamp=now)

    def step():
        nonlocal state, now
        now += timedelta(seconds=0.1)
        predicted = predictor.predict(state, timestamp=now)
        detection = Detection(z, timestamp=now, measurement_model=sensor)
        state = updater.update(SingleHypothesis(predicted, detection))

    return step


def joseph(f, h, q, r, z):
    x, p, identity = np.zeros((len(f), 1)), np.eye(len(f)), np.eye(len(f))

    def step():
        nonlocal x, p
        x, p = f @ x, f @ p @ f.T + q
        gain = np.linalg.solve(h @ p @ h.T + r, h @ p).T
        x = x + gain @ (z - h @ x)
        rest = identity - gain @ h
        p = rest @ p @ rest.T + gain @ r @ gain.T

    return step


def nanoseconds(step, repeats, rounds=5):
    """Best of the rounds: other load only ever adds."""
    step()
    best = float("inf")
    for _ in range(rounds):
        began = time.perf_counter()
        for _ in range(repeats):
            step()
        best = min(best, (time.perf_counter() - began) / repeats)
    return 1e9 * best


def main():
    programs = [
        ("numpy Joseph", "numpy", joseph),
        ("OpenCV", "cv2", opencv),
        ("filterpy", "filterpy", filterpy),
        ("Stone Soup", "stonesoup", stone_soup),
    ]
    for states, measurements in ((4, 2), (30, 30)):
        z = np.full((measurements, 1), 0.5)
        for name, module, make in programs:
            if importlib.util.find_spec(module):
                took = nanoseconds(make(*model(states, measurements), z), repeats=2000)
                print(f"bench\tkalman {states}/{measurements}\t{name}\t{took:.0f}", flush=True)


if __name__ == "__main__":
    main()
