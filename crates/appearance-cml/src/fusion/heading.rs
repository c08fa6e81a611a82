use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{Manifold, Pose2, wrap_angle};
use wayfix_gaussian_core::{Gaussian, cholesky, symmetrize};

use crate::{AppearanceMapError, HeadingMeasurement};

/// A belief that is told which way the robot looks.
///
/// What references were learned with is in all that they say, and may be in the belief as well: their variance $`l`$ is taken for an error that both have in
/// common, as far as the belief leaves room for it, $`c = \min(l, 1/(C^{-1})_{θθ})`$. So the heading is known no better in the end than they know it. The rest of the
/// belief, $`C' = C - c\,e_θ e_θ^T`$, is updated with the variance $`r + l - c`$, where $`r`$ is that of the comparison:
///
/// $`K = C' e_θ / (C'_{θθ} + r + l - c)`$, $`μ ⊕ K (θ - μ_θ)`$, $`(1 - K e_θ^T) C' + c\,e_θ e_θ^T`$.
///
/// # Errors
/// When the belief is singular or the result is not finite.
pub(crate) fn update_heading(
    belief: &Gaussian<Pose2<f64>>,
    facing: &HeadingMeasurement,
) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError> {
    let information = cholesky("belief's", belief.covariance())?.inverse();
    let common = facing.map_variance.min(1.0 / information[(2, 2)]);
    let noise = facing.comparison_variance + facing.map_variance - common;
    let mut own = *belief.covariance();
    own[(2, 2)] -= common;
    let gain: Vector3<f64> = own.column(2) / (own[(2, 2)] + noise);
    let mut kept = Matrix3::identity();
    kept.column_mut(2).axpy(-1.0, &gain, 1.0);
    let mut told = kept * own * kept.transpose() + gain * gain.transpose() * noise;
    told[(2, 2)] += common;
    let mean = belief.mean().retract(&(gain * wrap_angle(facing.heading - belief.mean().heading())));
    let turn = belief.mean().chart_jacobian(&mean);
    let mut covariance = turn * told * turn.transpose();
    symmetrize(&mut covariance);
    Ok(Gaussian::new(mean, covariance)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{OdometryNoise, propagate};

    fn belief(heading: f64, sigma: f64) -> Gaussian<Pose2<f64>> {
        let sigmas = Vector3::new(0.1, 0.1, sigma);
        Gaussian::from_sigmas(Pose2::new(1.0, 2.0, heading), &sigmas).expect("sigmas are positive")
    }

    #[test]
    fn what_was_learned_perfectly_is_a_measurement_like_any_other() {
        let facing = HeadingMeasurement { heading: -3.1, comparison_variance: 0.04, map_variance: 0.0 };
        let told = update_heading(&belief(3.1, 0.2), &facing).unwrap();
        // Equal variances meet half way, across the wrap.
        let middle = 0.5 * wrap_angle(-3.1 - 3.1);
        assert!((wrap_angle(told.mean().heading() - 3.1) - middle).abs() < 1e-12);
        assert!((told.sigmas().z - 0.2 / 2f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn fused_heading_is_no_sharper_than_the_references() {
        let facing =
            HeadingMeasurement { heading: 0.0, comparison_variance: 0.01, map_variance: 0.05f64.powi(2) };
        let mut told = belief(0.1, 0.2);
        for _ in 0..1000 {
            told = update_heading(&told, &facing).unwrap();
        }
        assert!((0.05..0.052).contains(&told.sigmas().z), "{}", told.sigmas().z);
        assert!(told.mean().heading().abs() < 0.01, "{}", told.mean().heading());
    }

    #[test]
    fn who_went_the_wrong_way_is_taken_back_sideways() {
        let noise = OdometryNoise::default();
        let start = Gaussian::from_sigmas(Pose2::new(0.0, 0.0, 0.1), &Vector3::new(0.01, 0.01, 0.2)).unwrap();
        let moved = propagate(&start, &Pose2::new(10.0, 0.0, 0.0), &noise).unwrap();
        let facing = HeadingMeasurement { heading: 0.0, comparison_variance: 1e-4, map_variance: 1e-4 };
        let told = update_heading(&moved, &facing).unwrap();
        // 10 m · sin 0.1; the odometry's own turn after the start is 0.025 rad against 0.2.
        assert!(moved.mean().y() > 0.99 && told.mean().y().abs() < 0.05, "{:?}", told.mean());
    }

    #[test]
    fn a_singular_belief_is_refused() {
        let flat = Gaussian::from_parts_unchecked(Pose2::new(0.0, 0.0, 0.0), Matrix3::zeros());
        assert!(
            update_heading(
                &flat,
                &HeadingMeasurement { heading: 0.0, comparison_variance: 0.1, map_variance: 0.0 }
            )
            .is_err()
        );
    }
}
