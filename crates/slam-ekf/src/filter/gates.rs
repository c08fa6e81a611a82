use statrs::distribution::{ChiSquared, ContinuousCDF};

/// Chi-squared quantiles of one probability, computed once: a filter asks for them with every observation.
#[derive(Clone, Debug)]
pub(super) struct Gates {
    probability: f64,
    quantiles: [f64; LARGEST],
}

/// Measurements of more dimensions than a spatial pose are computed when they are asked for.
const LARGEST: usize = 6;

impl Gates {
    pub(super) fn from_probability(probability: f64) -> Self {
        Self { probability, quantiles: std::array::from_fn(|i| quantile(i + 1, probability)) }
    }

    pub(super) fn threshold(&self, degrees_of_freedom: usize) -> f64 {
        match degrees_of_freedom.checked_sub(1).and_then(|i| self.quantiles.get(i)) {
            Some(&quantile) => quantile,
            None => quantile(degrees_of_freedom, self.probability),
        }
    }
}

fn quantile(degrees_of_freedom: usize, probability: f64) -> f64 {
    ChiSquared::new(degrees_of_freedom as f64)
        .map_or(0.0, |distribution| distribution.inverse_cdf(probability))
}
