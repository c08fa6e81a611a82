use nalgebra::{DefaultAllocator, Dim};
use wayfix_estimation_traits::{LogWeight, Manifold, StateAlloc};

use super::log_sum_exp;
use crate::{Gaussian, GaussianError, gaussian::check_dimension};

/// A weighted sum of Gaussians $`\sum_i w_i N(μ_i, Σ_i)`$, normalized, with weights kept as logarithms.
///
/// ```
/// use nalgebra::Vector1;
/// use wayfix_gaussian_core::{Gaussian, GaussianMixture};
/// let at = |x: f64| Gaussian::from_sigmas(Vector1::new(x), &Vector1::new(1.0));
/// let mixture = GaussianMixture::from_log_weights(vec![(-2000.0, at(0.0)?), (-2000.0, at(4.0)?)])?;
/// assert!((mixture.weight(0) - 0.5).abs() < 1e-12);
/// # Ok::<(), wayfix_gaussian_core::GaussianError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct GaussianMixture<X: Manifold>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    pub(super) log_weights: Vec<LogWeight>,
    pub(super) components: Vec<Gaussian<X>>,
}

impl<X: Manifold> GaussianMixture<X>
where
    DefaultAllocator: StateAlloc<X::Dim>,
{
    /// A mixture of weighted components; weights need not be normalized.
    ///
    /// # Errors
    /// Returns an error if there are no components, dimensions differ, a weight is negative or not finite; [`GaussianError::NoWeight`] when all are zero.
    pub fn from_weights(weighted: Vec<(f64, Gaussian<X>)>) -> Result<Self, GaussianError> {
        if let Some(index) = weighted.iter().position(|(weight, _)| !(*weight >= 0.0 && weight.is_finite())) {
            return Err(GaussianError::Weight { index, value: weighted[index].0 });
        }
        Self::from_log_weights(
            weighted.into_iter().map(|(weight, gaussian)| (weight.ln(), gaussian)).collect(),
        )
    }

    /// A mixture of components with log weights in nats; $`-∞`$ is a weight of zero.
    ///
    /// # Errors
    /// As for [`from_weights`](Self::from_weights), with NaN and $`+∞`$ refused.
    pub fn from_log_weights(weighted: Vec<(LogWeight, Gaussian<X>)>) -> Result<Self, GaussianError> {
        let (mut log_weights, components): (Vec<_>, Vec<_>) = weighted.into_iter().unzip();
        let Some(first) = components.first() else { return Err(GaussianError::Empty { what: "components" }) };
        for component in &components {
            check_dimension("component", first.dim().value(), component.dim().value())?;
        }
        if let Some(index) = log_weights.iter().position(|l| l.is_nan() || *l == f64::INFINITY) {
            return Err(GaussianError::Weight { index, value: log_weights[index] });
        }
        let total = log_sum_exp(&log_weights);
        if total == f64::NEG_INFINITY {
            return Err(GaussianError::NoWeight { count: log_weights.len() });
        }
        log_weights.iter_mut().for_each(|l| *l -= total);
        Ok(Self { log_weights, components })
    }

    /// The Gaussians.
    pub fn components(&self) -> &[Gaussian<X>] {
        &self.components
    }
    /// Their log weights in nats; the weights add up to one.
    pub fn log_weights(&self) -> &[LogWeight] {
        &self.log_weights
    }
    /// The weight of component `index`; 0 where there is none.
    pub fn weight(&self, index: usize) -> f64 {
        self.log_weights.get(index).map_or(0.0, |l| l.exp())
    }
    /// All weights.
    pub fn weights(&self) -> Vec<f64> {
        self.log_weights.iter().map(|l| l.exp()).collect()
    }
    /// How many components.
    pub fn len(&self) -> usize {
        self.components.len()
    }
    /// Never: a mixture has a component.
    pub fn is_empty(&self) -> bool {
        self.components.is_empty()
    }
    /// The components with their log weights.
    pub fn into_log_weighted(self) -> Vec<(LogWeight, Gaussian<X>)> {
        self.log_weights.into_iter().zip(self.components).collect()
    }
}
