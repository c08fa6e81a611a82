use std::f64::consts::TAU;

use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

use crate::PoseHypothesis;

/// The likelihood of one measurement as a function of the pose: Gaussian peaks over a constant floor.
///
/// $`p(y|x) ∝ m + \sum_b w_b \exp(-\tfrac12 (x ⊟ μ_b)^T C_b^{-1} (x ⊟ μ_b))`$. The floor $`m`$ is the missed detection of probabilistic data
/// association. [Bar-Shalom & Tse 1975]
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{PoseHypothesis, GaussianMixtureLikelihood, UniformComponent};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::Gaussian;
/// let pose = Gaussian::from_sigmas(Pose2::new(1.0, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// // A source that is right with probability 0.9, in a map of 100 m²: the floor is the remaining probability.
/// let uniform = UniformComponent { weight: 1.0, volume: 100.0 * std::f64::consts::TAU };
/// let likelihood = GaussianMixtureLikelihood::of_probabilities(vec![PoseHypothesis::new(0.9, pose)], &uniform);
/// assert!((likelihood.floor - 0.1).abs() < 1e-12 && likelihood.peaks[0].weight > 1000.0);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GaussianMixtureLikelihood {
    /// The peaks; the weight is the height.
    pub peaks: Vec<PoseHypothesis>,
    /// Likelihood of a pose far from all peaks, on the same scale.
    pub floor: f64,
}

impl GaussianMixtureLikelihood {
    /// From hypotheses whose weights are probabilities. The densities of a probability $`w`$ have the height
    /// $`w V / (2π)^{3/2} |C|^{1/2}`$ over a floor of $`1 - w`$, relative to the uniform density $`1/V`$.
    pub fn of_probabilities(mut hypotheses: Vec<PoseHypothesis>, uniform: &UniformComponent) -> Self {
        let largest = hypotheses.iter().map(|hypothesis| hypothesis.weight).fold(0.0, f64::max);
        for hypothesis in &mut hypotheses {
            hypothesis.weight /= uniform.share_of(&hypothesis.gaussian);
        }
        Self { peaks: hypotheses, floor: (1.0 - largest).max(0.0) }
    }
}

/// The uniform component of a belief: the robot may be anywhere in the map.
///
/// ```
/// # use nalgebra::Vector3;
/// # use wayfix_appearance_cml::{GaussianMixtureLikelihood, PoseHypothesis, UniformComponent};
/// # use wayfix_estimation_traits::Pose2;
/// # use wayfix_gaussian_core::Gaussian;
/// # let pose = Gaussian::from_sigmas(Pose2::new(1.0, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1))?;
/// let height = |volume: f64| {
///     let (hypotheses, uniform) = (vec![PoseHypothesis::new(0.9, pose.clone())], UniformComponent { weight: 1.0, volume });
///     GaussianMixtureLikelihood::of_probabilities(hypotheses, &uniform).peaks[0].weight
/// };
/// // The same pose is twice as informative in a map of twice the extent.
/// assert!((height(200.0) / height(100.0) - 2.0).abs() < 1e-12);
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UniformComponent {
    /// Its weight relative to those of the Gaussian components.
    pub weight: f64,
    /// The extent of the map, m² rad.
    pub volume: f64,
}

impl UniformComponent {
    /// The integral of a peak of height 1 over the uniform density: $`(2π)^{3/2} |C|^{1/2} / V`$.
    pub(super) fn share_of(&self, peak: &Gaussian<Pose2<f64>>) -> f64 {
        TAU * TAU.sqrt() * peak.covariance().determinant().sqrt() / self.volume
    }
}
