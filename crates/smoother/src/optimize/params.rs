use crate::SmootherError;

/// How to take a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Method {
    /// Full steps, whatever they lead to. [Barfoot 2017, 4.3.1]
    GaussNewton,
    /// Gauss–Newton until a step raises the cost; from then on damped by the diagonal of $`H`$. [Marquardt 1963]
    #[default]
    LevenbergMarquardt,
    /// The best step along gradient and Gauss–Newton step within a trust region. [Powell 1970]
    Dogleg,
}

/// When to stop, and how to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Params {
    /// How to take a step. Default Levenberg–Marquardt.
    pub method: Method,
    /// Most iterations, stages of graduated non-convexity included. Default 100, as GTSAM has it.
    pub max_iterations: usize,
    /// Stops after a step whose predicted decrease is below this share of the cost. Default 1e-8.
    pub relative_decrease: f64,
    /// Starts Geman–McClure kernels convex and sharpens them in stages: graduated non-convexity.
    /// Other kernels are not affected. Default off. [Yang et al. 2020]
    pub graduated: bool,
}

impl Default for Params {
    fn default() -> Self {
        Self { method: Method::default(), max_iterations: 100, relative_decrease: 1e-8, graduated: false }
    }
}

impl Params {
    pub(crate) fn validate(&self) -> Result<(), SmootherError> {
        SmootherError::positive("the relative decrease", self.relative_decrease)?;
        SmootherError::positive("the number of iterations", self.max_iterations as f64)
    }
}

/// Why the iteration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// The predicted decrease of the last step was small, or the values were known to be a minimum.
    Converged,
    /// No shorter step lowers the cost either: rounding, or wrong Jacobians.
    NoDecrease,
    /// The limit was reached before.
    IterationLimit,
}

/// What an optimization did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Summary {
    /// Cost at the values before.
    pub start_cost: f64,
    /// Cost at the values after.
    pub cost: f64,
    /// Number of linearizations: 0 if the values were known to be a minimum.
    pub iterations: usize,
    /// Why it ended.
    pub stop: Stop,
    /// Additions and multiplications of one numeric factorization: $`\sum_k c_k^2`$ with $`c_k`$ entries in column k of the Cholesky factor; 0 if there was none.
    pub factorization_flop: f64,
}
