use nalgebra::{ComplexField, DefaultAllocator};
use wayfix_estimation_traits::{LikelihoodModel, LogWeight, Manifold, SensorModel, UpdateAlloc};

use crate::{covariance::check_symmetric, density::NormalTerms};

/// Any [`SensorModel`] as a likelihood: $`\log N(z ⊟ h(x); 0, R(x))`$.
///
/// $`-∞`$ where the sensor gives no measurement: a prediction that is not finite or a noise that is not positive definite.
///
/// ```
/// use nalgebra::{Matrix1, Vector1, Vector2};
/// use wayfix_estimation_traits::{LikelihoodModel, SensorModel};
/// use wayfix_gaussian_core::GaussianLikelihood;
/// struct Range;
/// impl SensorModel for Range {
///     type State = Vector2<f64>;
///     type Measurement = Vector1<f64>;
///     fn expected(&self, state: &Vector2<f64>) -> Vector1<f64> {
///         Vector1::new(state.norm())
///     }
///     fn noise(&self, _: &Vector2<f64>) -> Matrix1<f64> {
///         Matrix1::new(0.01)
///     }
/// }
/// let likelihood = GaussianLikelihood(Range);
/// let measured = Vector1::new(5.0);
/// let log_weight = likelihood.log_likelihood(&measured);
/// assert!(log_weight(&Vector2::new(3.0, 4.0)) > log_weight(&Vector2::new(3.0, 4.1)));
/// assert_eq!(log_weight(&Vector2::new(f64::NAN, 0.0)), f64::NEG_INFINITY);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct GaussianLikelihood<S>(pub S);

impl<S: SensorModel> LikelihoodModel for GaussianLikelihood<S>
where
    DefaultAllocator: UpdateAlloc<<S::State as Manifold>::Dim, <S::Measurement as Manifold>::Dim>,
{
    type State = S::State;
    type Measurement = S::Measurement;

    fn log_likelihood(&self, measurement: &S::Measurement) -> impl Fn(&S::State) -> LogWeight {
        move |state| {
            let noise = self.0.noise(state);
            let innovation = self.0.expected(state).local(measurement);
            let usable = innovation.iter().all(ComplexField::is_finite)
                && noise.nrows() == innovation.nrows()
                && check_symmetric("sensor noise", &noise).is_ok();
            if !usable {
                return LogWeight::NEG_INFINITY;
            }
            NormalTerms::new("sensor noise", &innovation, &noise)
                .map_or(LogWeight::NEG_INFINITY, |terms| terms.log_density())
        }
    }
}
