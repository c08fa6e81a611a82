"""State condensation in plain numpy, on two traverses of a route.

Kasprzak & Szynkiewicz, "A method for discrete self-localization using image analysis": Eqs. 4-6 with the published likelihood, a Gaussian of the
weighted distance whose weights are one over the variances of the features over the places. Frame i of `query` is place i of `ref`.

    numpy_state_condensation.py FOLDER      with FOLDER/ref and FOLDER/query

Prints, for each feature, the share of the frames found within two places.
"""
import pathlib
import re
import sys

import cv2
import numpy as np

TOLERANCE = 2  # places, the definition of the data set
MOVES = ((0, 0.1), (1, 0.8), (2, 0.1))  # places on a frame: Eq. 4
LEAK = 1e-3  # belief that goes everywhere


def frames(folder):
    number = lambda path: [int(n) for n in re.findall(r"\d+", path.name)]
    files = [p for p in pathlib.Path(folder).iterdir() if p.suffix.lower() in (".png", ".jpg", ".jpeg")]
    return [cv2.imread(str(path))[:, :, ::-1].astype(float) for path in sorted(files, key=number)]


def mean_var(image):
    pixels = image.reshape(-1, 3)
    return np.r_[pixels.mean(0), pixels.std(0)]


def grey(image):
    return image @ (0.299, 0.587, 0.114)


def fft6(image):
    return np.abs(np.fft.fft2(grey(image))[0, :6]) / image[:, :, 0].size


def hist6(image):
    counts = np.bincount(np.rint(grey(image)).astype(int).ravel(), minlength=256)
    most = np.argsort(-counts, kind="stable")[:3]
    return np.r_[most, counts[most] / counts.sum()]


def found(learned, seen):
    n = len(learned)
    weights = 1.0 / np.maximum(learned.var(0), 1e-12)
    belief = np.full(n, 1.0 / n)
    best = []
    for k, features in enumerate(seen):
        if k:
            predicted = np.zeros(n)
            for step, share in MOVES:
                np.add.at(predicted, np.minimum(np.arange(n) + step, n - 1), share * belief)
            belief = (1 - LEAK) * predicted + LEAK / n
        log = -0.5 * ((features - learned) ** 2 * weights).sum(1)
        belief = belief * np.exp(log - log.max())
        belief /= belief.sum()
        best.append(belief.argmax())
    return np.mean(np.abs(np.array(best) - np.arange(len(seen))) <= TOLERANCE)


def main():
    folder = pathlib.Path(sys.argv[1])
    ref, query = frames(folder / "ref"), frames(folder / "query")
    for feature in (mean_var, fft6, hist6):
        learned, seen = (np.array([feature(image) for image in images]) for images in (ref, query))
        print(f"{feature.__name__}\t{found(learned, seen):.3f}")


if __name__ == "__main__":
    main()
