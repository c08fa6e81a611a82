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

/// Resolution of the search for the share. The determinant is flat at its minimum, so this costs less than a percent of it.
const STEPS: u32 = 24;

/// Split covariance intersection of two, by the share $`ω`$ of least determinant.
///
/// $`C^{-1} = (C_{a,s}/ω + C_{a,i})^{-1} + (C_{b,s}/(1-ω) + C_{b,i})^{-1}`$. [Julier & Uhlmann 2001]
pub(super) fn intersect(a: &Split, b: &Split) -> Result<(Vector3<f64>, Matrix3<f64>), GaussianError> {
    let mut best: Option<(f64, Vector3<f64>, Matrix3<f64>)> = None;
    for step in 1..STEPS {
        let share = f64::from(step) / f64::from(STEPS);
        let (mean, covariance) = fused((a.mean, a.widened(share)), (b.mean, b.widened(1.0 - share)))?;
        let determinant = covariance.determinant();
        if best.as_ref().is_none_or(|(least, ..)| determinant < *least) {
            best = Some((determinant, mean, covariance));
        }
    }
    let (_, mean, covariance) = best.ok_or(GaussianError::Empty { what: "shares" })?;
    Ok((mean, covariance))
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
