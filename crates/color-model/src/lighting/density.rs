use nalgebra::{Matrix3, Vector3};

/// How the pixels of one map colour are distributed in YUV: $`N(μ[m], Σ[m,m] + ν)`$. [Schulz & Fox 2004, Eq. 9]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorDensity {
    /// Mean (Y, U, V).
    pub mean: Vector3<f64>,
    /// Covariance of a single pixel.
    pub covariance: Matrix3<f64>,
}
