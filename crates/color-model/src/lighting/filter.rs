use std::sync::Arc;

use nalgebra::{DMatrix, DVector, Vector3};
use wayfix_color_map::ColorId;
use wayfix_gaussian_core::Gaussian;

use super::{ColorDensity, ColorMeans, LightingParams, Unseen, drift::drift, update::observe};
use crate::ColorModelError;

/// A Kalman filter over the means of all map colours at once, $`θ ∼ N(μ, Σ)`$ with $`θ = (θ[1], …, θ[M])`$ in YUV: what one kind of light does.
///
/// Colours vary together, so a colour that nobody has seen yet follows from those that were seen. [Schulz & Fox 2004, Eqs. 2-6]
///
/// ```
/// use nalgebra::{DMatrix, DVector, Vector3};
/// use wayfix_color_map::ColorId;
/// use wayfix_color_model::{ColorMeans, LightingFilter, LightingParams};
/// use wayfix_gaussian_core::Gaussian;
/// // Two colours that become brighter together: correlation 0.9 of standard deviations of 30.
/// let mut covariance = DMatrix::from_diagonal_element(6, 6, 900.0);
/// for i in 0..3 {
///     (covariance[(i, i + 3)], covariance[(i + 3, i)]) = (810.0, 810.0);
/// }
/// let prior = Gaussian::new(DVector::from_element(6, 128.0), covariance)?;
/// let mut light = LightingFilter::new(prior, LightingParams::default())?;
/// light.update(&ColorMeans::new([(Some(Vector3::new(60.0, 128.0, 128.0)), 900), (None, 0)]))?;
/// let unseen = light.color(ColorId(1)).mean;
/// assert!((unseen.x - 71.0).abs() < 2.0); // 128 - 68 · 810/964
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LightingFilter {
    prior: Arc<Gaussian<DVector<f64>>>,
    params: LightingParams,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
}

impl LightingFilter {
    /// A filter that knows the `prior` of $`3M`$ numbers.
    ///
    /// # Errors
    /// When the prior's dimension is not a positive multiple of three, it is not positive definite, or a parameter is out of range.
    pub fn new(prior: Gaussian<DVector<f64>>, params: LightingParams) -> Result<Self, ColorModelError> {
        params.check()?;
        let n = prior.mean().len();
        if n == 0 || !n.is_multiple_of(3) {
            let expected = n.next_multiple_of(3).max(3);
            return Err(ColorModelError::Dimension { what: "numbers of a lighting prior", expected, got: n });
        }
        if prior.covariance().clone().cholesky().is_none() || !prior.mean().iter().all(|v| v.is_finite()) {
            return Err(ColorModelError::NotPositiveDefinite { what: "lighting prior" });
        }
        let (mean, covariance) = (prior.mean().clone(), prior.covariance().clone());
        Ok(Self { prior: Arc::new(prior), params, mean, covariance })
    }

    /// How many colours.
    pub fn n_colors(&self) -> usize {
        self.mean.len() / 3
    }

    /// The parameters.
    pub fn params(&self) -> &LightingParams {
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

    /// How the pixels of a colour are distributed (Eq. 9).
    ///
    /// # Panics
    /// When there is no such colour; [`n_colors`](Self::n_colors) tells.
    pub fn color(&self, color: ColorId) -> ColorDensity {
        let at = 3 * usize::from(color.0);
        let mean = self.mean.fixed_rows::<3>(at).into_owned();
        let mut covariance = self.covariance.fixed_view::<3, 3>(at, at).into_owned();
        for i in 0..3 {
            covariance[(i, i)] += self.params.pixel_noise[i];
        }
        ColorDensity { mean, covariance }
    }

    /// The densities of all colours, in the order of the map.
    pub fn colors(&self) -> impl Iterator<Item = ColorDensity> {
        (0..self.n_colors()).map(|at| self.color(ColorId(at as u8)))
    }

    /// Lets the light drift for `seconds` (Eq. 6).
    ///
    /// # Errors
    /// When the time is negative or not finite; nothing has changed then.
    pub fn predict(&mut self, seconds: f64) -> Result<(), ColorModelError> {
        if !(seconds >= 0.0 && seconds.is_finite()) {
            return Err(ColorModelError::OutOfRange { what: "seconds of drift", value: seconds });
        }
        drift(self.params.drift, seconds, &self.prior, &mut self.mean, &mut self.covariance);
        Ok(())
    }

    /// Learns from the colour means of one image (Eqs. 3-5). Gives the log evidence $`\ln p(\bar v | \bar v_{1:k-1})`$, nats.
    ///
    /// # Errors
    /// When there are more or fewer colours, or a mean is not finite; nothing has changed then.
    pub fn update(&mut self, means: &ColorMeans) -> Result<f64, ColorModelError> {
        let (expected, got) = (self.n_colors(), means.n_colors());
        if expected != got {
            return Err(ColorModelError::Dimension { what: "colours of an image", expected, got });
        }
        if means.seen().any(|(_, mean)| !mean.iter().all(|v| v.is_finite())) {
            return Err(ColorModelError::NotFinite { what: "mean of a colour" });
        }
        let filled = match self.params.unseen {
            Unseen::Marginalize => None,
            Unseen::Regress => Some(self.regressed(means)),
        };
        let log_evidence = means.seen().map(|(color, mean)| self.observe(color, &mean)).sum();
        for (color, mean) in filled.into_iter().flatten() {
            self.observe(color, &mean);
        }
        Ok(log_evidence)
    }

    fn observe(&mut self, color: ColorId, mean: &Vector3<f64>) -> f64 {
        let (at, noise) = (3 * usize::from(color.0), self.params.mean_noise);
        (0..3).map(|i| observe(&mut self.mean, &mut self.covariance, at + i, mean[i], noise[i])).sum()
    }

    /// What the colours that were not seen look like most likely, given those that were.
    fn regressed(&self, means: &ColorMeans) -> Vec<(ColorId, Vector3<f64>)> {
        let mut given = self.clone();
        for (color, mean) in means.seen() {
            given.observe(color, &mean);
        }
        let all = (0..self.n_colors()).map(|at| ColorId(at as u8));
        all.filter(|color| means.mean(*color).is_none())
            .map(|color| (color, given.color(color).mean))
            .collect()
    }
}
