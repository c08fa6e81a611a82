use std::sync::Arc;

use nalgebra::{DVector, Vector3};
use wayfix_gaussian_core::{Gaussian, GaussianError, moment_matched};
use wayfix_kalman::{Gpb2Filter, ImmFilter, MarkovChain, SequentialUpdateAlgorithm};

use super::{
    super::filter::check_seconds,
    LightingTracker,
    models::{LightMotion, seen},
};
use crate::{ColorDensity, ColorMeans, ColorModelError, LightingFilter, LightingFilterBank};

/// The interacting multiple model filter for a light that switches occasionally.
///
/// Its models share one state, so an inactive light of the bank cannot keep its own. They differ in the motion of the state: it drifts, or
/// it switches to one of the bank's lights and restarts at its prior. [Blom & Bar-Shalom 1988]
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_model::{ColorMeans, LightingFilter, LightingFilterBank, LightingFilterParams, LightingTracker};
/// # use wayfix_color_model::ImmLightingTracker;
/// # use wayfix_gaussian_core::Gaussian;
/// # use wayfix_kalman::MarkovChain;
/// # let light = |y: f64| {
/// #     let prior = Gaussian::new(DVector::from_vec(vec![y, 128.0, 128.0]), DMatrix::identity(3, 3) * 100.0)?;
/// #     LightingFilter::new(prior, LightingFilterParams::default())
/// # };
/// let bank = LightingFilterBank::new(vec![light(60.0)?, light(160.0)?], MarkovChain::sticky(2, 0.98)?)?;
/// let mut tracker = ImmLightingTracker::new(&bank)?;
/// for y in [150.0, 66.0, 150.0] {
///     tracker.predict(0.04)?;
///     tracker.update(&ColorMeans::new([(Some(Vector3::new(y, 128.0, 128.0)), 500)]))?;
/// }
/// assert!(tracker.probabilities()[2] > 0.99); // it has just switched to the second light
/// assert!((tracker.colors()?[0].mean.x - 153.9).abs() < 0.1); // 160 - 10 · 100 / 164: the 150 of the first image is forgotten
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone)]
pub struct ImmLightingTracker {
    filter: ImmFilter<LightMotion, SequentialUpdateAlgorithm>,
    noise: Noise,
}

/// As [`ImmLightingTracker`], with mixing after the next image, so that two images determine a switch. [Bar-Shalom et al. 2001, §11.6.5]
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_model::{ColorMeans, LightingFilter, LightingFilterBank, LightingFilterParams, LightingTracker};
/// # use wayfix_color_model::Gpb2LightingTracker;
/// # use wayfix_gaussian_core::Gaussian;
/// # use wayfix_kalman::MarkovChain;
/// # let light = |y: f64| {
/// #     let prior = Gaussian::new(DVector::from_vec(vec![y, 128.0, 128.0]), DMatrix::identity(3, 3) * 100.0)?;
/// #     LightingFilter::new(prior, LightingFilterParams::default())
/// # };
/// # let bank = LightingFilterBank::new(vec![light(60.0)?, light(160.0)?], MarkovChain::sticky(2, 0.98)?)?;
/// let mut tracker = Gpb2LightingTracker::new(&bank)?;
/// let mut see = |y: f64| {
///     tracker.predict(0.04)?;
///     tracker.update(&ColorMeans::new([(Some(Vector3::new(y, 128.0, 128.0)), 500)]))?;
///     Ok::<_, wayfix_color_model::ColorModelError>(tracker.probabilities())
/// };
/// let [_, second, third] = [see(150.0)?, see(66.0)?, see(66.0)?];
/// assert!(second[1] > 0.99 && third[0] > 0.9); // a switch to the first light, then drift
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone)]
pub struct Gpb2LightingTracker {
    filter: Gpb2Filter<LightMotion, SequentialUpdateAlgorithm>,
    noise: Noise,
}

#[derive(Clone, Copy)]
struct Noise {
    n_colors: usize,
    mean: Vector3<f64>,
    pixel: Vector3<f64>,
}

impl ImmLightingTracker {
    /// Starts from the mixture of the bank's priors. Noise and drift are those of the first member; the probability of a switch is the chain's
    /// mean.
    /// # Errors
    /// Returns an error if the priors have no common Gaussian.
    pub fn new(bank: &LightingFilterBank) -> Result<Self, ColorModelError> {
        let Models { motions, chain, start, noise } = Models::of(bank)?;
        Ok(Self { filter: ImmFilter::new(motions, chain, SequentialUpdateAlgorithm, &start)?, noise })
    }

    /// Probabilities that the light drifts, and that it has just switched to each member of the bank.
    pub fn probabilities(&self) -> Vec<f64> {
        self.filter.model_probabilities()
    }
}

impl Gpb2LightingTracker {
    /// As [`ImmLightingTracker::new`].
    ///
    /// # Errors
    /// Returns an error if the priors have no common Gaussian.
    pub fn new(bank: &LightingFilterBank) -> Result<Self, ColorModelError> {
        let Models { motions, chain, start, noise } = Models::of(bank)?;
        Ok(Self { filter: Gpb2Filter::new(motions, chain, SequentialUpdateAlgorithm, &start)?, noise })
    }

    /// As [`ImmLightingTracker::probabilities`].
    pub fn probabilities(&self) -> Vec<f64> {
        self.filter.model_probabilities()
    }
}

struct Models {
    motions: Vec<LightMotion>,
    chain: MarkovChain,
    start: Gaussian<DVector<f64>>,
    noise: Noise,
}

impl Models {
    fn of(bank: &LightingFilterBank) -> Result<Self, ColorModelError> {
        let priors: Vec<_> = bank.members().iter().map(|light| light.prior().clone()).collect();
        let start = moment_matched(bank.chain().initial(), &priors).map_err(GaussianError::from)?;
        let params =
            bank.members().first().map(|light: &Arc<LightingFilter>| *light.params()).unwrap_or_default();
        let drift = LightMotion::Drift { drift: params.lighting_drift, prior: Arc::new(start.clone()) };
        let switches = priors.into_iter().map(|prior| LightMotion::Switch { to: Arc::new(prior) });
        let row = switching(bank.chain());
        Ok(Self {
            motions: std::iter::once(drift).chain(switches).collect(),
            // The probability of a switch does not depend on the last model.
            chain: MarkovChain::new(&vec![row.clone(); row.len()], &row)?,
            start,
            noise: Noise {
                n_colors: bank.n_colors(),
                mean: params.mean_color_variance,
                pixel: params.pixel_color_variance,
            },
        })
    }
}

/// Probabilities that the light drifts on, and that it switches to each member: means over the previous members.
fn switching(chain: &MarkovChain) -> Vec<f64> {
    let n = chain.n_models();
    let mean = |probability: &dyn Fn(usize) -> f64| (0..n).map(probability).sum::<f64>() / n as f64;
    let to = |j: usize| mean(&|i| if i == j { 0.0 } else { chain.probability(i, j) });
    std::iter::once(mean(&|i| chain.probability(i, i))).chain((0..n).map(to)).collect()
}

/// Both filters have the same calls, but no trait in common.
macro_rules! light_tracker {
    ($tracker:ty) => {
        impl LightingTracker for $tracker {
            fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
                check_seconds(seconds)?;
                Ok(self.filter.predict(&seconds)?)
            }

            fn update(&mut self, means: &ColorMeans) -> Result<(), ColorModelError> {
                means.check(self.noise.n_colors)?;
                if let Some((sensor, values)) = seen(means, &self.noise.mean)? {
                    self.filter.update(&sensor, &values)?;
                }
                Ok(())
            }

            fn colors(&self) -> Result<Vec<ColorDensity>, ColorModelError> {
                let belief = self.filter.estimate()?;
                Ok(ColorDensity::all(belief.mean(), belief.covariance(), self.noise.pixel).collect())
            }
        }
    };
}

light_tracker!(ImmLightingTracker);
light_tracker!(Gpb2LightingTracker);
