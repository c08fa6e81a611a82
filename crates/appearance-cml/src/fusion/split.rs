use nalgebra::{Matrix3, Vector3};
use wayfix_gaussian_core::{GaussianError, cholesky, symmetrize};

/// A deviation with the two parts of its covariance.
pub(super) struct Split {
    pub(super) mean: Vector3<f64>,
    pub(super) shared: Matrix3<f64>,
    pub(super) independent: Matrix3<f64>,
}

impl Split {
    pub(super) fn new(mean: Vector3<f64>, covariance: &Matrix3<f64>, independent: f64) -> Self {
        Self { mean, shared: covariance * (1.0 - independent), independent: covariance * independent }
    }

    /// $`C_s / ω + C_i`$.
    fn widened(&self, share: f64) -> Matrix3<f64> {
        self.shared / share + self.independent
    }
}

/// Split covariance intersection of two, by the share $`ω`$ of least determinant.
///
/// $`C^{-1} = (C_{a,s}/ω + C_{a,i})^{-1} + (C_{b,s}/(1-ω) + C_{b,i})^{-1}`$. [Julier & Uhlmann 2001]
/// The information is concave in $`ω`$, so that the determinant has one minimum. The interval around it shrinks by a quarter in each
/// iteration. After twice as many iterations as a number has decimal digits its width is 2e-4.
pub(super) fn intersect(a: &Split, b: &Split) -> Result<(Vector3<f64>, Matrix3<f64>), GaussianError> {
    let at = |share: f64| fused((a.mean, a.widened(share)), (b.mean, b.widened(1.0 - share)));
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..2 * f64::DIGITS {
        let middle = (low + high) / 2.0;
        let (left, right) = ((low + middle) / 2.0, (middle + high) / 2.0);
        if at(left)?.1.determinant() < at(right)?.1.determinant() {
            high = right;
        } else {
            low = left;
        }
    }
    at((low + high) / 2.0)
}

/// The product of two Gaussians, its covariance in Joseph form.
fn fused(
    (mean_a, a): (Vector3<f64>, Matrix3<f64>),
    (mean_b, b): (Vector3<f64>, Matrix3<f64>),
) -> Result<(Vector3<f64>, Matrix3<f64>), GaussianError> {
    let gain = cholesky("sum", &(a + b))?.solve(&a).transpose();
    let kept = Matrix3::identity() - gain;
    let mut covariance = kept * a * kept.transpose() + gain * b * gain.transpose();
    symmetrize(&mut covariance);
    Ok((mean_a + gain * (mean_b - mean_a), covariance))
}
