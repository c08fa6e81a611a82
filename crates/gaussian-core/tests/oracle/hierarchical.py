"""Figures for tests/integration/hierarchical_oracle.rs. Made with: pip install numpy scipy; python hierarchical.py
A general-purpose optimizer on the posterior of (mean, Cholesky factor): the group means are integrated out by writing every group's
observations as one joint Gaussian, one row per observation, with no pooling. Prints how flat the posterior is where it stopped."""
import numpy as np
from scipy.optimize import minimize
from scipy.stats import invwishart, multivariate_normal

D, GROUPS = 3, 7
PSI = np.array([[2.0, 0.3, 0.0], [0.3, 1.5, -0.2], [0.0, -0.2, 1.0]]); DOF = 5.0
M0 = np.array([0.5, -0.5, 1.0]); KAPPA = 0.1

def observations():
    """The same closed formula as in the test: group, indices, values, variances."""
    for j in range(GROUPS):
        for i in range(1 + j % 3):
            s = 0.7 * j + 1.3 * i
            full = [2 * np.sin(1.9 * j) + 0.3 * np.cos(5 * s), np.cos(2.3 * j) + np.sin(1.9 * j) + 0.3 * np.sin(7 * s), 1 + 0.8 * np.sin(3.1 * j + 0.4) + 0.2 * np.cos(11 * s)]
            indices = [d for d in range(D) if (j + 2 * i + d) % 4 != 0]
            yield j, indices, [full[d] for d in indices], [0.05 + 0.02 * d + 0.01 * i for d in indices]

groups = []
for j in range(GROUPS):
    rows = [(d, y, v) for g, ds, ys, vs in observations() if g == j for d, y, v in zip(ds, ys, vs)]
    groups.append((np.array([r[0] for r in rows]), np.array([r[1] for r in rows]), np.array([r[2] for r in rows])))

LOWER = np.tril_indices(D)
def unpack(x):
    L = np.zeros((D, D)); L[LOWER] = x[D:]
    L[np.diag_indices(D)] = np.exp(np.diag(L))
    return x[:D], L

def objective(x, hyperprior):
    mu, L = unpack(x); S = L @ L.T
    f = sum(multivariate_normal.logpdf(y, mu[d], S[np.ix_(d, d)] + np.diag(v)) for d, y, v in groups)
    return f + hyperprior(mu, S)

def gradient(x, hyperprior, h=1e-3):
    """Central differences of sixth order: error of the order h^6 = 1e-18 and of rounding, 1e-15 / h."""
    g = np.zeros_like(x)
    for k in range(len(x)):
        for c, n in ((45, 1), (-9, 2), (1, 3)):
            e = np.zeros_like(x); e[k] = n * h
            g[k] += c * (objective(x + e, hyperprior) - objective(x - e, hyperprior)) / (60 * h)
    return g

def fit(name, hyperprior):
    x = np.zeros(D + len(LOWER[0]))
    for _ in range(3):
        r = minimize(lambda x: -objective(x, hyperprior), x, jac=lambda x: -gradient(x, hyperprior), method="L-BFGS-B",
                     options=dict(maxiter=5000, ftol=1e-16, gtol=1e-11, maxcor=30))
        x = r.x
    mu, L = unpack(x)
    H = np.array([(gradient(x + 1e-4 * e, hyperprior) - gradient(x - 1e-4 * e, hyperprior)) / 2e-4 for e in np.eye(len(x))])
    print(name, "objective", repr(-r.fun), "gradient", np.abs(gradient(x, hyperprior)).max(), "Hessian's eigenvalues", np.linalg.eigvalsh((H + H.T) / 2)[[0, -1]])
    print("  mean", [float(v) for v in mu])
    print("  covariance", [float(v) for v in (L @ L.T).flatten()])

fit("FLAT", lambda mu, S: 0.0)
fit("INVERSE_WISHART", lambda mu, S: invwishart.logpdf(S, DOF, PSI))
fit("NORMAL_INVERSE_WISHART", lambda mu, S: invwishart.logpdf(S, DOF, PSI) + multivariate_normal.logpdf(mu, M0, S / KAPPA))
