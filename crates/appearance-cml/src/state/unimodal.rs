use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::{Gaussian, GaussianMixture};

use crate::{AppearanceMapError, check};

/// When a mixture counts as one place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct UnimodalParams {
    /// Least share of the weight in the heaviest component. Default 0.8.
    pub min_weight: f64,
    /// Greatest σ of its position, m. Default infinite: how far a robot may drift through unknown ground is for its user to say.
    pub max_sigma: f64,
}

impl Default for UnimodalParams {
    fn default() -> Self {
        Self { min_weight: 0.8, max_sigma: f64::INFINITY }
    }
}

impl UnimodalParams {
    /// Whether the numbers have a meaning.
    ///
    /// # Errors
    /// Names the first that has none.
    pub fn validate(&self) -> Result<(), AppearanceMapError> {
        check::share("least weight of the one component", self.min_weight)?;
        check::positive("greatest σ of the one component (m)", self.max_sigma.min(f64::MAX))
    }
}

/// The heaviest component, when it is heavy and narrow enough to stand for the whole mixture.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_appearance_cml::{UnimodalParams, unimodal};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_gaussian_core::{Gaussian, GaussianMixture};
/// let at = |x: f64| Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(0.1, 0.1, 0.1));
/// let sure = GaussianMixture::from_weights(vec![(0.1, at(0.0)?), (0.9, at(4.0)?)])?;
/// assert_eq!(unimodal(&sure, &UnimodalParams::default()).map(|g| g.mean().x()), Some(4.0));
/// let torn = GaussianMixture::from_weights(vec![(0.4, at(0.0)?), (0.6, at(4.0)?)])?;
/// assert!(unimodal(&torn, &UnimodalParams::default()).is_none());
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
pub fn unimodal<'a>(
    mixture: &'a GaussianMixture<Pose2<f64>>,
    params: &UnimodalParams,
) -> Option<&'a Gaussian<Pose2<f64>>> {
    let weights = mixture.weights();
    let heaviest = (0..weights.len()).max_by(|&i, &j| weights[i].total_cmp(&weights[j]))?;
    let component = &mixture.components()[heaviest];
    let sigmas = component.sigmas();
    let narrow = sigmas.x.hypot(sigmas.y) <= params.max_sigma;
    (weights[heaviest] >= params.min_weight && narrow).then_some(component)
}
