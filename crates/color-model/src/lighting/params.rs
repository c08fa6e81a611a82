use nalgebra::Vector3;

use crate::ColorModelError;

/// What a lighting filter is tuned by.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(default, deny_unknown_fields)
)]
pub struct LightingParams {
    /// Variance of a pixel about the mean of its colour, $`ν`$ (Y, U, V), the same for all colours: shade over the field, vignetting, noise.
    pub pixel_noise: Vector3<f64>,
    /// Variance of an image's mean of a colour about the light's, (Y, U, V). The paper takes $`ν`$: the part of a colour that one image shows
    /// has a shade of its own, which no number of pixels averages out.
    pub mean_noise: Vector3<f64>,
    /// How the light changes by itself.
    pub drift: Drift,
    /// What becomes of colours that an image does not show.
    pub unseen: Unseen,
}

/// How the light changes by itself.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Drift {
    /// $`Σ ← Σ + R\,Δt`$ with a diagonal $`R`$ (Y, U, V), the same for all colours, per second. [Schulz & Fox 2004, Eq. 6] Unseen colours
    /// become ever more uncertain, beyond what any venue looks like; correlations fade.
    RandomWalk(#[cfg_attr(feature = "schema", schemars(with = "[f64; 3]"))] Vector3<f64>),
    /// An Ornstein-Uhlenbeck process back to the prior with this time constant, seconds: $`θ ← μ_0 + a (θ - μ_0)`$,
    /// $`Σ ← a^2 Σ + (1 - a^2) Σ_0`$, $`a = e^{-Δt/τ}`$. Colours drift together as they vary together from venue to venue, and
    /// whatever is not seen for long is known as well as before the first look: neither better nor worse.
    TowardsPrior(f64),
}

/// What becomes of colours that an image does not show.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Unseen {
    /// Only the rows that were seen are observed: exact. The others follow by their correlations.
    #[default]
    Marginalize,
    /// They are filled in with their conditional means and then taken as observed. [Schulz & Fox 2004, footnote 1] Their variance
    /// shrinks although nobody saw them.
    Regress,
}

impl Default for LightingParams {
    /// Standard deviations of 12, 6, 6 for pixels and 8, 4, 4 for means; back to the prior within minutes.
    fn default() -> Self {
        Self {
            pixel_noise: Vector3::new(144.0, 36.0, 36.0),
            mean_noise: Vector3::new(64.0, 16.0, 16.0),
            drift: Drift::TowardsPrior(120.0),
            unseen: Unseen::Marginalize,
        }
    }
}

impl LightingParams {
    /// The largest variance that number `i` of the state may have: a billion times that of an image's mean. There a look leaves a billionth of
    /// the covariance, which is seven digits above rounding.
    pub(super) fn max_variance(&self, i: usize) -> f64 {
        1e9 * self.mean_noise[i % 3]
    }

    pub(super) fn check(&self) -> Result<(), ColorModelError> {
        let within = |what, value: f64, least: f64| {
            if value >= least && value <= 1e12 {
                Ok(())
            } else {
                Err(ColorModelError::OutOfRange { what, value })
            }
        };
        self.pixel_noise.iter().try_for_each(|v| within("variance of a pixel", *v, 1e-12))?;
        self.mean_noise.iter().try_for_each(|v| within("variance of an image's mean", *v, 1e-12))?;
        match self.drift {
            Drift::TowardsPrior(seconds) => within("time constant of the drift (s)", seconds, 1e-12),
            Drift::RandomWalk(rate) => rate.iter().try_for_each(|v| within("drift rate", *v, 0.0)),
        }
    }
}
