use crate::SmootherError;

/// What a residual costs, as a function of its squared Mahalanobis norm $`s = r^T Ω r`$.
///
/// Steps use the weight $`ρ'(s)`$: iteratively reweighted least squares. All of them cost $`s`$ near 0 and differ in what an outlier costs.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Kernel {
    /// $`ρ = s`$: Gaussian noise.
    #[default]
    Squared,
    /// $`ρ = s`$ up to $`k^2`$, then $`2k\sqrt{s} - k^2`$. [Huber 1964]
    Huber {
        /// $`k`$, in standard deviations; 1.345 keeps 95 % of the efficiency under Gaussian noise.
        k: f64,
    },
    /// $`ρ = c^2 \ln(1 + s/c^2)`$; 2.385 keeps 95 % of the efficiency.
    Cauchy {
        /// $`c`$, in standard deviations.
        c: f64,
    },
    /// $`ρ = μ c^2 s / (μ c^2 + s)`$ with $`μ = 1`$, or from a large $`μ`$ down to 1 with
    /// [`Params::graduated`](crate::Params::graduated). [Yang et al. 2020, Eq. 8]
    GemanMcClure {
        /// $`c`$, in standard deviations; an outlier costs at most $`c^2`$.
        c: f64,
    },
    /// Dynamic covariance scaling, the closed form of switchable constraints:
    /// $`ρ = s`$ up to $`Φ`$, then $`Φ(3s - Φ)/(s + Φ)`$. [Agarwal et al. 2013, Eq. 15]
    Switchable {
        /// $`Φ`$, the squared norm at which a residual begins to switch off.
        phi: f64,
    },
}

impl Kernel {
    /// $`ρ(s)`$ and $`ρ'(s)`$, with $`μ`$ for [`GemanMcClure`](Self::GemanMcClure).
    pub(crate) fn cost_and_weight(self, s: f64, mu: f64) -> (f64, f64) {
        match self {
            Self::Squared => (s, 1.0),
            Self::Huber { k } if s > k * k => (2.0 * k * s.sqrt() - k * k, k / s.sqrt()),
            Self::Huber { .. } => (s, 1.0),
            Self::Cauchy { c } => (c * c * (s / (c * c)).ln_1p(), 1.0 / (1.0 + s / (c * c))),
            Self::GemanMcClure { c } => {
                let share = mu * c * c / (mu * c * c + s);
                (share * s, share * share)
            }
            Self::Switchable { phi } if s > phi => {
                let scale = 2.0 * phi / (phi + s);
                (phi * (3.0 * s - phi) / (s + phi), scale * scale)
            }
            Self::Switchable { .. } => (s, 1.0),
        }
    }

    /// # Errors
    /// [`SmootherError::OutOfRange`] if its parameter is not positive and finite.
    pub(crate) fn validate(self) -> Result<(), SmootherError> {
        let (what, value) = match self {
            Self::Squared => return Ok(()),
            Self::Huber { k } => ("k of the Huber kernel", k),
            Self::Cauchy { c } => ("c of the Cauchy kernel", c),
            Self::GemanMcClure { c } => ("c of the Geman-McClure kernel", c),
            Self::Switchable { phi } => ("Φ of the switchable kernel", phi),
        };
        SmootherError::positive(what, value)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::abs_diff_eq;

    const KERNELS: [Kernel; 5] = [
        Kernel::Squared,
        Kernel::Huber { k: 1.345 },
        Kernel::Cauchy { c: 2.385 },
        Kernel::GemanMcClure { c: 3.0 },
        Kernel::Switchable { phi: 2.0 },
    ];

    #[test]
    fn weight_is_the_derivative_of_the_cost() {
        for kernel in KERNELS {
            for mu in [1.0, 50.0] {
                for s in [1e-3, 0.5, 1.9, 2.1, 10.0, 1e4] {
                    let h = 1e-5 * s;
                    let cost = |s: f64| kernel.cost_and_weight(s, mu).0;
                    let slope = (cost(s + h) - cost(s - h)) / (2.0 * h);
                    let (_, weight) = kernel.cost_and_weight(s, mu);
                    assert!(
                        abs_diff_eq!(slope, weight, epsilon = 1e-8 + 1e-6 * weight),
                        "{kernel:?} at {s}: {slope} {weight}"
                    );
                }
            }
        }
    }

    #[test]
    fn small_residuals_cost_their_square_and_none_costs_more() {
        for kernel in KERNELS {
            let (cost, weight) = kernel.cost_and_weight(1e-9, 1.0);
            assert!(
                abs_diff_eq!(cost / 1e-9, 1.0, epsilon = 1e-8) && abs_diff_eq!(weight, 1.0, epsilon = 1e-8),
                "{kernel:?}"
            );
            assert!((0..40).map(|i| 1.5_f64.powi(i) * 1e-3).all(|s| kernel.cost_and_weight(s, 1.0).0 <= s));
        }
    }

    #[test]
    fn huge_residuals_stay_finite() {
        for kernel in KERNELS {
            let (cost, weight) = kernel.cost_and_weight(1e300, 1.0);
            assert!(cost.is_finite() && weight.is_finite(), "{kernel:?}: {cost} {weight}");
        }
    }

    #[test]
    fn kernel_without_a_positive_parameter_is_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Kernel::Cauchy { c: bad }.validate().is_err(), "{bad}");
        }
    }
}
