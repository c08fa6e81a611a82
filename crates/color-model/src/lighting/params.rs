use nalgebra::Vector3;

use crate::ColorModelError;

/// Parameters of a lighting filter.
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_model::{ColorMeans, LightingFilter, LightingFilterParams};
/// # use wayfix_gaussian_core::Gaussian;
/// # let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0]), DMatrix::identity(3, 3) * 400.0)?;
/// let mut light = LightingFilter::new(prior.clone(), LightingFilterParams::default())?;
/// light.update(&ColorMeans::new([(Some(Vector3::new(130.0, 128.0, 128.0)), 500)]))?;
/// assert!((light.mean()[0] - (100.0 + 30.0 * 400.0 / 464.0)).abs() < 1e-9); // a mean has variance 64 for any number of pixels
/// let exact = LightingFilterParams { mean_color_variance: Vector3::zeros(), ..LightingFilterParams::default() };
/// assert!(LightingFilter::new(prior, exact).is_err());
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LightingFilterParams {
    /// Variance of a pixel about the mean of its colour, $`ν`$ (Y, U, V), the same for all colours: shade over the field, vignetting, noise.
    /// [Schulz & Fox 2004, Eq. 1]
    pub pixel_color_variance: Vector3<f64>,
    /// Variance of an image's mean of a colour about the light's, (Y, U, V). The paper uses $`ν`$: the part of a colour in one image has its own
    /// shade, which averaging over pixels does not remove.
    pub mean_color_variance: Vector3<f64>,
    /// Process noise of the light.
    pub lighting_drift: LightingDrift,
    /// Treatment of colours that an image does not show.
    pub unseen_colors: UnseenColorRule,
}

/// Process model of the light.
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_model::{ColorMeans, LightingDrift, LightingFilter, LightingFilterParams};
/// # use wayfix_gaussian_core::Gaussian;
/// # let prior = Gaussian::new(DVector::from_vec(vec![100.0, 128.0, 128.0]), DMatrix::identity(3, 3) * 400.0)?;
/// let with = |lighting_drift| LightingFilter::new(prior.clone(), LightingFilterParams { lighting_drift, ..Default::default() });
/// let mut walk = with(LightingDrift::RandomWalk(Vector3::new(2.0, 1.0, 1.0)))?;
/// walk.predict(60.0)?;
/// assert_eq!(walk.covariance()[(0, 0)], 400.0 + 2.0 * 60.0);
/// let mut back = with(LightingDrift::TowardsPrior(120.0))?;
/// back.predict(60.0)?;
/// assert_eq!(back.covariance()[(0, 0)], 400.0); // that of the prior: nothing was learned
/// # Ok::<(), wayfix_color_model::ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum LightingDrift {
    /// $`Σ ← Σ + R\,Δt`$ with a diagonal $`R`$ (Y, U, V), the same for all colours, per second. [Schulz & Fox 2004, Eq. 6] The variance of unseen
    /// colours grows, to a billion times that of an image's mean; correlations fade.
    RandomWalk(#[cfg_attr(feature = "schema", schemars(with = "[f64; 3]"))] Vector3<f64>),
    /// An Ornstein-Uhlenbeck process back to the prior with this time constant, seconds: $`θ ← μ_0 + a (θ - μ_0)`$, $`Σ ← a^2 Σ + (1 - a^2) Σ_0`$,
    /// $`a = e^{-Δt/τ}`$. Colours drift with the correlations of the prior, and colours unseen for a long time return to the
    /// prior.
    TowardsPrior(f64),
}

/// Treatment of colours that an image does not show.
/// ```
/// # use nalgebra::{DMatrix, DVector, Vector3};
/// # use wayfix_color_model::{ColorMeans, ColorModelError, LightingFilter, LightingFilterParams, UnseenColorRule};
/// # use wayfix_gaussian_core::Gaussian;
/// # let prior = Gaussian::new(DVector::from_element(6, 128.0), DMatrix::identity(6, 6) * 400.0)?;
/// let unseen_variance = |unseen_colors| {
///     let params = LightingFilterParams { unseen_colors, ..LightingFilterParams::default() };
///     let mut light = LightingFilter::new(prior.clone(), params)?;
///     light.update(&ColorMeans::new([(Some(Vector3::repeat(128.0)), 500), (None, 0)]))?;
///     Ok::<_, ColorModelError>(light.covariance()[(3, 3)])
/// };
/// assert_eq!(unseen_variance(UnseenColorRule::Marginalize)?, 400.0); // the colours are not correlated
/// assert!((unseen_variance(UnseenColorRule::Regress)? - 400.0 * 64.0 / 464.0).abs() < 1e-9);
/// # Ok::<(), ColorModelError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum UnseenColorRule {
    /// Observes only the seen rows, which is exact. Unseen colours change by their correlations.
    #[default]
    Marginalize,
    /// Fills in unseen colours with their conditional means and observes all. [Schulz & Fox 2004, footnote 1] The variance of unseen colours
    /// then shrinks without a measurement.
    Regress,
}

impl Default for LightingFilterParams {
    /// Standard deviations of 12, 6, 6 for pixels (a tenth of a colour of medium brightness) and of two thirds of that for means; return to the prior
    /// within minutes, as when a cloud passes. Priors learned from images replace the variances.
    fn default() -> Self {
        Self {
            pixel_color_variance: Vector3::new(144.0, 36.0, 36.0),
            mean_color_variance: Vector3::new(64.0, 16.0, 16.0),
            lighting_drift: LightingDrift::TowardsPrior(120.0),
            unseen_colors: UnseenColorRule::Marginalize,
        }
    }
}

impl LightingFilterParams {
    /// Maximum variance of component `i` of the state: a billion times that of an image's mean. An update then leaves a billionth of the
    /// covariance, seven digits above rounding.
    pub(super) fn max_variance(&self, i: usize) -> f64 {
        1e9 * self.mean_color_variance[i % 3]
    }

    pub(super) fn check(&self) -> Result<(), ColorModelError> {
        let within = |what, value: f64, least: f64| {
            if value >= least && value <= 1e12 {
                Ok(())
            } else {
                Err(ColorModelError::OutOfRange { what, value })
            }
        };
        self.pixel_color_variance.iter().try_for_each(|v| within("pixel_color_variance", *v, 1e-12))?;
        self.mean_color_variance.iter().try_for_each(|v| within("mean_color_variance", *v, 1e-12))?;
        match self.lighting_drift {
            LightingDrift::TowardsPrior(seconds) => within("time constant of the drift (s)", seconds, 1e-12),
            LightingDrift::RandomWalk(rate) => rate.iter().try_for_each(|v| within("drift rate", *v, 0.0)),
        }
    }
}
