use nalgebra::{DVector, Vector3};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{FilterBank, JumpMarkovFilter, JumpMarkovFilterParams, SequentialUpdateAlgorithm};

use super::{
    super::filter::check_seconds,
    LightingTracker,
    models::{LightMotion, seen},
};
use crate::{ColorDensity, ColorMeans, ColorModelError, LightingFilter, LightingFilterBank};

/// The switching filter of [Schulz & Fox 2004, §III.A.3]: one filter per light, of which only the active one learns. It keeps the most probable
/// histories of the active light, instead of particles that sample them.
/// ```
/// use nalgebra::{DMatrix, DVector, Vector3};
/// use wayfix_color_model::{ColorMeans, JumpMarkovLightingTracker, LightingTracker, LightingFilterBank, LightingFilter, LightingFilterParams};
/// use wayfix_gaussian_core::Gaussian;
/// use wayfix_kalman::{JumpMarkovFilterParams, MarkovChain};
/// let light = |y: f64| {
///     let prior = Gaussian::new(DVector::from_vec(vec![y, 128.0, 128.0]), DMatrix::identity(3, 3) * 100.0)?;
///     LightingFilter::new(prior, LightingFilterParams::default())
/// };
/// let bank = LightingFilterBank::new(vec![light(60.0)?, light(160.0)?], MarkovChain::sticky(2, 0.98)?)?;
/// let mut tracker = JumpMarkovLightingTracker::new(&bank, JumpMarkovFilterParams::default())?;
/// for y in [150.0, 151.0, 66.0] {
///     tracker.predict(0.04)?;
///     tracker.update(&ColorMeans::new([(Some(Vector3::new(y, 128.0, 128.0)), 500)]))?;
/// }
/// assert_eq!(tracker.active(), 0);
/// assert!((tracker.colors()?[0].mean.x - 63.7).abs() < 0.1); // 60 + 6 · 100 / 164
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone)]
pub struct JumpMarkovLightingTracker {
    filter: JumpMarkovFilter<LightMotion, SequentialUpdateAlgorithm>,
    n_colors: usize,
    mean_color_variance: Vector3<f64>,
    pixel_color_variance: Vector3<f64>,
}

impl JumpMarkovLightingTracker {
    /// Starts from the state of the bank's members. Noise is that of the first member.
    /// # Errors
    /// Returns an error if no history is to be kept.
    pub fn new(bank: &LightingFilterBank, params: JumpMarkovFilterParams) -> Result<Self, ColorModelError> {
        let belief = |light: &LightingFilter| {
            Gaussian::from_parts_unchecked(light.mean().clone(), light.covariance().clone())
        };
        let beliefs: Vec<_> = bank.members().iter().map(|light| belief(light)).collect();
        let motions = bank.members().iter().map(|light| LightMotion::drift_of(light)).collect();
        let models: FilterBank<LightMotion, SequentialUpdateAlgorithm> =
            FilterBank::new(motions, SequentialUpdateAlgorithm, &beliefs)?;
        let noise = bank.members().first().map(|light| *light.params()).unwrap_or_default();
        Ok(Self {
            filter: JumpMarkovFilter::new(models, bank.chain().clone(), params)?,
            n_colors: bank.n_colors(),
            mean_color_variance: noise.mean_color_variance,
            pixel_color_variance: noise.pixel_color_variance,
        })
    }

    /// The light that is most probably on.
    pub fn active(&self) -> usize {
        self.filter.selected()
    }

    /// Probability of each light.
    pub fn probabilities(&self) -> Vec<f64> {
        self.filter.model_probabilities()
    }

    /// Estimate of the most probable light.
    pub fn estimate(&self) -> Gaussian<DVector<f64>> {
        self.filter.estimate()
    }
}

impl LightingTracker for JumpMarkovLightingTracker {
    fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        check_seconds(seconds)?;
        Ok(self.filter.predict(&seconds)?)
    }

    fn update(&mut self, means: &ColorMeans) -> Result<(), ColorModelError> {
        means.check(self.n_colors)?;
        if let Some((sensor, values)) = seen(means, &self.mean_color_variance)? {
            self.filter.update(&sensor, Some(&values))?;
        }
        Ok(())
    }

    fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError> {
        let belief = self.estimate();
        Ok(ColorDensity::all(belief.mean(), belief.covariance(), self.pixel_color_variance).collect())
    }
}
