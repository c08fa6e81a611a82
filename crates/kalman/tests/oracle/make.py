"""Figures of filterpy for tests/integration/oracle.rs. Made with: pip install numpy scipy filterpy; python make.py
Prints one Rust tuple a step: mean (4), variances and one covariance (5 numbers), log-likelihood."""
import numpy as np
import scipy.linalg
from filterpy.kalman import KalmanFilter, IMMEstimator, UnscentedKalmanFilter, MerweScaledSigmaPoints

F = np.eye(4); F[0, 2] = F[1, 3] = 0.1
def Q(q, dt=0.1):
    a, b, c = q * dt**3 / 3, q * dt**2 / 2, q * dt
    return np.array([[a, 0, b, 0], [0, a, 0, b], [b, 0, c, 0], [0, b, 0, c]])
H = np.array([[1, .2, 0, .1], [0, 1, .3, 0]]); R = np.array([[.5, .3], [.3, .4]])
def z(k):
    t = 0.1 * k
    return np.array([np.sin(t) + 0.3 * np.cos(7 * t), 2 * t - np.sin(5 * t)])
def kf(q):
    f = KalmanFilter(dim_x=4, dim_z=2)
    f.x = np.zeros(4); f.P = 10 * np.eye(4); f.F = F; f.H = H; f.Q = Q(q); f.R = R
    return f
def rust(numbers):
    return "[" + ", ".join(repr(float(v)) for v in numbers) + "]"

f = kf(0.5)
for k in range(1, 51):
    f.predict(); f.update(z(k))
print("LINEAR", rust(f.x), rust(f.P.flatten()), repr(float(f.log_likelihood)))

imm = IMMEstimator([kf(0.01), kf(20.0)], np.array([.5, .5]), np.array([[.95, .05], [.1, .9]]))
for k in range(1, 21):
    imm.predict(); imm.update(z(k))
print("IMM", rust(imm.x), rust(imm.P.flatten()), rust(imm.mu))

# Range and bearing to a landmark at (5, 3) from a point that drifts. filterpy measures nothing on the circle: bearings stay near 0.5.
def hx(x): return np.array([np.hypot(5 - x[0], 3 - x[1]), np.arctan2(3 - x[1], 5 - x[0])])
points = MerweScaledSigmaPoints(2, alpha=1.0, beta=2.0, kappa=0.0, sqrt_method=lambda P: scipy.linalg.cholesky(P))
u = UnscentedKalmanFilter(2, 2, 1.0, hx, lambda x, dt: x, points)
u.x = np.zeros(2); u.P = np.diag([0.3, 0.2]); u.R = np.diag([0.01, 0.0004]); u.Q = np.diag([0.02, 0.01])
for k in range(1, 11):
    u.predict()
    # filterpy keeps the points it propagated; the additive-noise filter draws new ones from the prediction
    u.sigmas_f = points.sigma_points(u.x, u.P)
    u.update(np.array([5.7 + 0.05 * k, 0.55 + 0.01 * k]))
print("UNSCENTED", rust(u.x), rust(u.P.flatten()))
