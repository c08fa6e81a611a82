use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture, cholesky};

use crate::fusion::carried;
use crate::{AppearanceMapError, PoseHypothesis, PoseHypothesisSource};

/// Share of the information of a component below which a part of the pose is not measured: beyond the rounding of a difference.
const ROUNDING: f64 = 1e-9;

/// A measurement of the pose, or of a part of it, as a source: one hypothesis for each component of the belief, with its weight.
pub(super) struct MeasuredPoses(Vec<PoseHypothesis>);

impl MeasuredPoses {
    /// From the components of a belief and what Kalman updates by the measurement make of them.
    pub(super) fn new<'a>(
        state: &GaussianMixture<Pose2<f64>>,
        posteriors: impl Iterator<Item = &'a Gaussian<Pose2<f64>>>,
    ) -> Result<Self, AppearanceMapError> {
        let predicted = PoseHypothesis::of_mixture(state);
        let hypotheses = predicted.iter().zip(posteriors).map(|(component, posterior)| {
            Ok(PoseHypothesis::new(component.weight, measured(&component.gaussian, posterior)?))
        });
        hypotheses.collect::<Result<_, _>>().map(Self)
    }
}

impl PoseHypothesisSource for MeasuredPoses {
    fn hypotheses(
        &self,
        _: Option<&GaussianMixture<Pose2<f64>>>,
    ) -> Result<Vec<PoseHypothesis>, AppearanceMapError> {
        Ok(self.0.clone())
    }
}

/// The information of a measurement alone: that of the posterior without that of the prior, $`Λ = C_+^{-1} - C_-^{-1}`$ and
/// $`Λ μ = C_+^{-1} μ_+`$ in the chart at $`μ_-`$. A part that is not measured has the prior's marginal, which covariance intersection does not
/// count twice.
fn measured(
    prior: &Gaussian<Pose2<f64>>,
    posterior: &Gaussian<Pose2<f64>>,
) -> Result<Gaussian<Pose2<f64>>, AppearanceMapError> {
    let inverse = |covariance| cholesky("measured", covariance).map(|factor| factor.inverse());
    let seen = posterior.in_chart_at(prior.mean())?;
    let (before, after) = (inverse(prior.covariance())?, inverse(seen.covariance())?);
    let (mut information, mut vector): (Matrix3<f64>, Vector3<f64>) = (after - before, after * seen.mean());
    let is_measured = [0, 1, 2].map(|k| information[(k, k)] > ROUNDING * before[(k, k)]);
    let unmeasured: Vec<usize> = (0..3).filter(|&k| !is_measured[k]).collect();
    let mut marginal = *prior.covariance();
    for k in 0..3 {
        for other in (0..3).filter(|&other| is_measured[k] != is_measured[other]) {
            (information[(k, other)], marginal[(k, other)]) = (0.0, 0.0);
        }
    }
    let of_rest = inverse(&marginal)?;
    for &k in &unmeasured {
        vector[k] = 0.0;
        unmeasured.iter().for_each(|&other| information[(k, other)] = of_rest[(k, other)]);
    }
    let factor = cholesky("measured", &information)?;
    carried(prior.mean(), &factor.solve(&vector), &factor.inverse())
}

#[cfg(test)]
mod tests {
    use approx::assert_abs_diff_eq;
    use wayfix_gaussian_core::GaussianMixture;

    use super::*;
    use crate::{GaussianFusionRule, combine};

    /// A prior that is wide ahead of a robot that faces left, and its Kalman update by the whole pose of `other`.
    fn prior_and_measured() -> [Gaussian<Pose2<f64>>; 2] {
        let prior = Gaussian::from_sigmas(Pose2::new(1.0, 2.0, 1.5), &Vector3::new(0.5, 0.1, 0.2)).unwrap();
        let other = Gaussian::from_sigmas(Pose2::new(1.1, 2.2, 1.4), &Vector3::new(0.2, 0.2, 0.1)).unwrap();
        [prior, other]
    }

    /// The Kalman update in the chart at the prior's mean.
    fn updated(
        prior: &Gaussian<Pose2<f64>>,
        information: Matrix3<f64>,
        z: Vector3<f64>,
    ) -> Gaussian<Pose2<f64>> {
        let before = prior.covariance().try_inverse().unwrap();
        let covariance = (before + information).try_inverse().unwrap();
        carried(prior.mean(), &(covariance * information * z), &covariance).unwrap()
    }

    #[test]
    fn a_measured_pose_is_what_was_measured() {
        let [prior, other] = prior_and_measured();
        let there = other.in_chart_at(prior.mean()).unwrap();
        let information = there.covariance().try_inverse().unwrap();
        let found = measured(&prior, &updated(&prior, information, *there.mean())).unwrap();
        assert_abs_diff_eq!(found.mean().x(), other.mean().x(), epsilon = 1e-6);
        assert_abs_diff_eq!(found.mean().heading(), other.mean().heading(), epsilon = 1e-6);
        assert_abs_diff_eq!(found.covariance(), other.covariance(), epsilon = 1e-3);
    }

    #[test]
    fn intersection_leaves_what_is_not_measured() {
        let [prior, _] = prior_and_measured();
        let information = Matrix3::from_diagonal(&Vector3::new(25.0, 25.0, 0.0));
        let posterior = updated(&prior, information, Vector3::new(0.1, 0.1, 0.0));
        let state = GaussianMixture::from_weights(vec![(1.0, prior.clone())]).unwrap();
        let sources = MeasuredPoses::new(&state, std::iter::once(&posterior)).unwrap();
        let seen = sources.hypotheses(None).unwrap().remove(0);
        let before = PoseHypothesis::new(1.0, prior.clone());
        let fused = combine(&before, &seen, GaussianFusionRule::WeightedIntersection).unwrap();
        assert_abs_diff_eq!(fused.covariance()[(2, 2)], prior.covariance()[(2, 2)], epsilon = 1e-6);
        assert!(fused.covariance()[(0, 0)] < prior.covariance()[(0, 0)]);
    }
}
