use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3};
use wayfix_color_map::ColorId;
use wayfix_gaussian_core::{Gaussian, check_covariance};
use wayfix_kalman::update_component;

use super::{ColorDensity, ColorMeans, LightingFilterParams, UnseenColorRule};
use crate::ColorModelError;

/// A Kalman filter over the means of all map colours, $`θ ∼ N(μ, Σ)`$ with $`θ = (θ[1], …, θ[M])`$ in YUV, for one kind of light.
///
/// Colours are correlated, so colours not seen yet are estimated from those that were. [Schulz & Fox 2004, Eqs. 2–6]
/// ```
/// use nalgebra::{DMatrix, DVector, Vector3};
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::{ColorMeans, LightingFilter, LightingFilterParams};
/// use wayfix_gaussian_core::Gaussian;
/// // Two colours that become brighter together: correlation 0.9 of standard deviations of 30.
/// let mut covariance = DMatrix::from_diagonal_element(6, 6, 900.0);
/// for i in 0..3 {
///     (covariance[(i, i + 3)], covariance[(i + 3, i)]) = (810.0, 810.0);
/// }
/// let prior = Gaussian::new(DVector::from_element(6, 128.0), covariance)?;
/// let mut light = LightingFilter::new(prior, LightingFilterParams::default())?;
/// light.update(&ColorMeans::new([(Some(Vector3::new(60.0, 128.0, 128.0)), 900), (None, 0)]))?;
/// let unseen = light.color(ColorId(1)).mean;
/// assert!((unseen.x - 71.0).abs() < 2.0); // 128 - 68 · 810/964
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LightingFilter {
    prior: Arc<Gaussian<DVector<f64>>>,
    params: LightingFilterParams,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl LightingFilter {
    /// A filter with the `prior` of $`3M`$ numbers.
    /// # Errors
    /// Returns an error if the prior's dimension is not a positive multiple of three, it has no density, a mean lies beyond a million or a variance beyond a
    /// billion times that of an image's mean (next to which the mean would be without noise), or a parameter is out of range.
    pub fn new(prior: Gaussian<DVector<f64>>, params: LightingFilterParams) -> Result<Self, ColorModelError> {
        params.check()?;
        let n = prior.mean().len();
        if n == 0 || !n.is_multiple_of(3) || n > 3 * MOST_COLORS {
            let expected = n.next_multiple_of(3).clamp(3, 3 * MOST_COLORS);
            return Err(ColorModelError::Dimension { what: "numbers of a lighting prior", expected, got: n });
        }
        if prior.covariance().nrows() != n {
            let got = prior.covariance().nrows();
            return Err(ColorModelError::Dimension { what: "rows of a prior covariance", expected: n, got });
        }
        check_covariance("lighting prior", prior.covariance())?;
        prior.mean().iter().try_for_each(|mean| check_value("prior mean of a colour", *mean))?;
        if let Some(i) = (0..n).find(|&i| prior.covariance()[(i, i)] > params.max_variance(i)) {
            let value = prior.covariance()[(i, i)];
            return Err(ColorModelError::OutOfRange { what: "prior variance", value });
        }
        let (mean, covariance) = (prior.mean().clone(), prior.covariance().clone());
        Ok(Self { prior: Arc::new(prior), params, mean, covariance })
    }

    /// The prior before the first image.
    pub fn prior(&self) -> &Gaussian<DVector<f64>> {
        &self.prior
    }

    /// Merges weighted filters: the mixture's mean and covariance.
    ///
    /// Returns `None` without any weight, or for filters of different dimensions.
    pub(super) fn merged<'a>(weighted: impl Iterator<Item = (f64, &'a Self)> + Clone) -> Option<Self> {
        let total: f64 = weighted.clone().map(|(weight, _)| weight).sum();
        let mut merged = weighted.clone().next()?.1.clone();
        let n = merged.mean.len();
        if weighted.clone().any(|(_, filter)| filter.mean.len() != n) || !(total > 0.0 && total.is_finite()) {
            return None;
        }
        let (origin, mut shift, mut products) =
            (merged.mean.clone(), DVector::zeros(n), DMatrix::zeros(n, n));
        for (weight, filter) in weighted {
            let from_origin = &filter.mean - &origin;
            shift.axpy(weight / total, &from_origin, 1.0);
            products.ger(weight / total, &from_origin, &from_origin, 1.0);
            products += &filter.covariance * (weight / total);
        }
        products.ger(-1.0, &shift, &shift, 1.0);
        merged.mean = origin + shift;
        merged.covariance = products;
        Some(merged)
    }

    /// Number of colours.
    pub fn n_colors(&self) -> usize {
        self.mean.len() / 3
    }

    /// The parameters.
    pub fn params(&self) -> &LightingFilterParams {
        &self.params
    }

    /// $`μ`$, three numbers a colour.
    pub fn mean(&self) -> &DVector<f64> {
        &self.mean
    }

    /// $`Σ`$.
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Distribution of the pixels of a colour. [Schulz & Fox 2004, Eq. 9] For a colour that does not exist all numbers are NaN, which every
    /// function of
    /// densities rejects.
    pub fn color(&self, color: ColorId) -> ColorDensity {
        self.colors().nth(color.index()).unwrap_or_else(ColorDensity::unknown)
    }

    /// The densities of all colours, in the order of the map.
    pub fn colors(&self) -> impl Iterator<Item = ColorDensity> {
        ColorDensity::all(&self.mean, &self.covariance, self.params.pixel_color_variance)
    }

    /// Lets the light drift for `seconds`. [Schulz & Fox 2004, Eq. 6]
    ///
    /// # Errors
    /// Returns an error if the time is negative or not finite; the state is then unchanged.
    pub fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        check_seconds(seconds)?;
        let LightingFilterParams { lighting_drift: drift, .. } = self.params;
        drift.move_mean(seconds, &self.prior, &mut self.mean);
        drift.widen(seconds, &self.prior, |i| self.params.max_variance(i), &mut self.covariance);
        Ok(())
    }

    /// Updates the filter with the colour means of one image. [Schulz & Fox 2004, Eqs. 3–5] Returns the log evidence
    /// $`\ln p(\bar v | \bar v_{1:k-1})`$, nats.
    /// # Errors
    /// Returns an error if there are more or fewer colours, or a mean is not finite or beyond a million; the state is then unchanged.
    pub fn update(&mut self, means: &ColorMeans) -> Result<f64, ColorModelError> {
        means.check(self.n_colors())?;
        let log_evidences = means.seen().map(|(color, mean)| self.observe(color, &mean));
        let log_evidence = log_evidences.sum::<Result<f64, _>>()?;
        if self.params.unseen_colors == UnseenColorRule::Regress {
            self.observe_regressed(means)?;
        }
        Ok(log_evidence)
    }

    /// The noise of a mean is diagonal, so a colour takes three updates of a component.
    fn observe(&mut self, color: ColorId, mean: &Vector3<f64>) -> Result<f64, ColorModelError> {
        let (at, noise) = (3 * color.index(), self.params.mean_color_variance);
        let mut update =
            |i| update_component(&mut self.mean, &mut self.covariance, at + i, mean[i], noise[i]);
        Ok(update(0)? + update(1)? + update(2)?)
    }

    /// Fills in unseen colours with their conditional means given the seen ones, so their means do not change.
    fn observe_regressed(&mut self, means: &ColorMeans) -> Result<(), ColorModelError> {
        let all = (0..=u8::MAX).map(ColorId).take(self.n_colors());
        for color in all.filter(|color| means.mean(*color).is_none()) {
            let most_likely = self.mean.fixed_rows::<3>(3 * color.index()).into_owned();
            self.observe(color, &most_likely)?;
        }
        Ok(())
    }
}

/// As many as a [`ColorId`] can name.
const MOST_COLORS: usize = 1 << u8::BITS;

pub(super) fn check_seconds(seconds: f64) -> Result<(), ColorModelError> {
    if seconds >= 0.0 && seconds.is_finite() {
        Ok(())
    } else {
        Err(ColorModelError::OutOfRange { what: "seconds of drift", value: seconds })
    }
}

/// Bound on pixel values, enough for very deep images; squares of larger values could overflow.
pub(super) fn check_value(what: &'static str, value: f64) -> Result<(), ColorModelError> {
    if !value.is_finite() {
        Err(ColorModelError::NotFinite { what })
    } else if value.abs() > 1e6 {
        Err(ColorModelError::OutOfRange { what, value })
    } else {
        Ok(())
    }
}
