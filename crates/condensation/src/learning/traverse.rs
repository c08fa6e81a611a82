use nalgebra::DMatrix;
use wayfix_estimation_traits::LogWeight;

use crate::error::{check_size, checked};
use crate::learning::noise::moments;
use crate::learning::whitener::Whitener;
use crate::{CondensationError, LikelihoodTail, StateDescriptorTable};

/// What is assumed of a traverse. None of it depends on the route.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct RouteAppearanceParams {
    /// Places so far apart count as the same, so that how their views differ is noise.
    pub same_place_tolerance: usize,
    /// Least variance of a component, as a share of its variance over the places.
    pub min_variance_share: f64,
    /// How fast likelihood falls with distance.
    pub likelihood_tail: LikelihoodTail,
}

impl Default for RouteAppearanceParams {
    /// Two places, as is usual for frames of video; the floor of [`NoiseCovarianceParams`](crate::NoiseCovarianceParams).
    fn default() -> Self {
        Self { same_place_tolerance: 2, min_variance_share: 3e-4, likelihood_tail: LikelihoodTail::default() }
    }
}

/// Places along a route, learned in the order of one traverse: how likely each of them is where a view was taken on another.
///
/// Nothing is known of the second traverse, so its noise is learned from the first: the covariance of the features is that of views
/// `tolerance` places apart. Errors of neighbouring views are correlated: a robot that drives a little more to the left sees
/// the same objects differently while they are in view. The measure is the correlation length of the features along the route,
///
/// ```math
/// τ = 1 + 2 \sum_{k \ge 1} ρ_k
/// ```
///
/// up to the first $`ρ_k \le 0`$, and the views of $`τ`$ places count as one: log-likelihoods are divided by $`τ`$. [Sokal 1997]
///
/// ```
/// use wayfix_condensation::{StateDescriptorTable, RouteAppearanceModel, RouteAppearanceParams};
/// let place = |k: usize| (0.3 * k as f64).sin();
/// let learned = StateDescriptorTable::from_rows(&(0..40).map(|k| vec![place(k), place(2 * k)]).collect::<Vec<_>>())?;
/// let traverse = RouteAppearanceModel::learn(&learned, &RouteAppearanceParams::default())?;
/// let log_likelihoods = traverse.log_likelihoods(&[place(7), place(14)])?;
/// assert!(log_likelihoods.iter().all(|l| *l <= log_likelihoods[7]));
/// assert!(traverse.log_likelihoods(&[f64::NAN, 0.0]).is_err());
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RouteAppearanceModel {
    places: Vec<Vec<f64>>, // whitened
    whitener: Whitener,
    correlation_length: f64,
    tail: LikelihoodTail,
}

impl RouteAppearanceModel {
    /// Learns the features of places in the order in which they were passed.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`], [`CondensationError::Empty`] when there are no two places that far apart,
    /// [`CondensationError::Gaussian`] when the features are too large for their noise.
    pub fn learn(
        features: &StateDescriptorTable,
        params: &RouteAppearanceParams,
    ) -> Result<Self, CondensationError> {
        let lag = checked(
            "same_place_tolerance",
            params.same_place_tolerance as f64,
            params.same_place_tolerance > 0,
            "at least 1",
        )? as usize;
        let floor = params.min_variance_share;
        checked("min_variance_share", floor, floor.is_finite() && floor >= 0.0, "finite and not negative")?;
        params.likelihood_tail.check()?;
        let n_pairs = features.n_states().saturating_sub(lag);
        if n_pairs == 0 {
            return Err(CondensationError::Empty { what: "places that far apart" });
        }
        let k = features.n_components();
        let mut noise = DMatrix::zeros(k, k);
        for (from, to) in features.rows().zip(features.rows().skip(lag)) {
            let difference = nalgebra::DVector::from_iterator(k, to.iter().zip(from).map(|(b, a)| b - a));
            noise.ger(1.0 / n_pairs as f64, &difference, &difference, 1.0);
        }
        for (i, (mean, variance)) in moments(features).into_iter().enumerate() {
            // A component that never varies has no spread to take a share of; it must not make the covariance singular.
            noise[(i, i)] += floor * variance + 1e-12 * (1.0 + mean * mean);
        }
        let whitener = Whitener::new(&noise)?;
        let whitened = |row: &[f64]| {
            let mut white = row.to_vec();
            whitener.whiten(&mut white);
            white
        };
        let places: Vec<Vec<f64>> = features.rows().map(whitened).collect();
        Ok(Self {
            correlation_length: correlation_length(&places),
            places,
            whitener,
            tail: params.likelihood_tail,
        })
    }

    /// How many places were learned.
    pub fn n_states(&self) -> usize {
        self.places.len()
    }

    /// $`τ`$: how many neighbouring views say as much as one.
    pub fn correlation_length(&self) -> f64 {
        self.correlation_length
    }

    /// $`\tfrac{1}{τ} \log p(m \mid s)`$ of every place, up to a common constant: for [`DiscreteFilter::update`](crate::DiscreteFilter::update).
    ///
    /// # Errors
    /// [`CondensationError::Dimension`] or [`CondensationError::NotFinite`].
    pub fn log_likelihoods(&self, measurement: &[f64]) -> Result<Vec<LogWeight>, CondensationError> {
        let n_components = self.places.first().map_or(0, Vec::len);
        check_size("measurement", n_components, measurement.len())?;
        if let Some((index, &value)) = measurement.iter().enumerate().find(|(_, value)| !value.is_finite()) {
            return Err(CondensationError::NotFinite { what: "measurement", index, value });
        }
        let mut white = measurement.to_vec();
        self.whitener.whiten(&mut white);
        let log_likelihood = |place: &Vec<f64>| {
            let squared_distance = place.iter().zip(&white).map(|(a, b)| (a - b).powi(2)).sum();
            self.tail.weigh(squared_distance, n_components).0 / self.correlation_length
        };
        Ok(self.places.iter().map(log_likelihood).collect())
    }
}

/// Sum of the autocorrelation of rows over positive lags until it is no longer positive, twice, and 1.
fn correlation_length(rows: &[Vec<f64>]) -> f64 {
    let n = rows.len();
    let k = rows.first().map_or(0, Vec::len);
    let mean: Vec<f64> = (0..k).map(|i| rows.iter().map(|row| row[i]).sum::<f64>() / n as f64).collect();
    let covariance = |lag: usize| {
        let product = |(a, b): (&Vec<f64>, &Vec<f64>)| -> f64 {
            (0..k).map(|i| (a[i] - mean[i]) * (b[i] - mean[i])).sum()
        };
        rows.iter().zip(&rows[lag..]).map(product).sum::<f64>() / (n - lag) as f64
    };
    let variance = covariance(0);
    if variance <= 0.0 {
        return 1.0;
    }
    let correlations = (1..n).map(|lag| covariance(lag) / variance);
    1.0 + 2.0 * correlations.take_while(|rho| *rho > 0.0).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;

    /// An autoregressive sequence of coefficient a has τ = (1 + a) / (1 − a), which is 9 for 0.8 and 1 for none.
    #[test]
    fn correlation_length_is_that_of_autoregression() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        for (a, expected, tolerance) in [(0.8, 9.0, 1.5), (0.0, 1.0, 0.2)] {
            let mut x = 0.0;
            let mut next = || {
                x = a * x + rng.random_range(-1.0..1.0);
                vec![x]
            };
            let rows: Vec<Vec<f64>> = (0..20_000).map(|_| next()).collect();
            let length = correlation_length(&rows);
            assert!(abs_diff_eq!(length, expected, epsilon = tolerance), "{length} for {a}");
        }
    }

    #[test]
    fn what_cannot_be_learned_from_is_refused() {
        let two = StateDescriptorTable::from_rows(&[vec![1.0], vec![2.0]]).unwrap();
        let learn = |params: RouteAppearanceParams| RouteAppearanceModel::learn(&two, &params);
        assert!(matches!(learn(RouteAppearanceParams::default()), Err(CondensationError::Empty { .. })));
        let params = RouteAppearanceParams { same_place_tolerance: 0, ..RouteAppearanceParams::default() };
        assert!(matches!(learn(params), Err(CondensationError::Parameter { .. })));
        let params = RouteAppearanceParams {
            same_place_tolerance: 1,
            min_variance_share: f64::NAN,
            ..RouteAppearanceParams::default()
        };
        assert!(matches!(learn(params), Err(CondensationError::Parameter { .. })));
        let traverse =
            learn(RouteAppearanceParams { same_place_tolerance: 1, ..RouteAppearanceParams::default() })
                .unwrap();
        assert!(matches!(traverse.log_likelihoods(&[1.0, 2.0]), Err(CondensationError::Dimension { .. })));
    }

    /// Places with the same appearance give no information and cause no error.
    #[test]
    fn a_route_without_features_leaves_all_places_equally_likely() {
        let grey = StateDescriptorTable::from_rows(&vec![vec![7.0, 0.0]; 9]).unwrap();
        let traverse = RouteAppearanceModel::learn(&grey, &RouteAppearanceParams::default()).unwrap();
        let log_likelihoods = traverse.log_likelihoods(&[7.0, 0.0]).unwrap();
        assert!(log_likelihoods.iter().all(|l| l.is_finite() && *l == log_likelihoods[0]));
    }
}
