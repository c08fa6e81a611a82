use nalgebra::DefaultAllocator;
use wayfix_estimation_traits::{Manifold, UpdateAlloc};

use crate::Innovation;

/// The outcome of a measurement. A gate never rejects silently.
///
/// ```
/// use nalgebra::{Matrix1, Vector1};
/// use wayfix_gaussian_core::{ChiSquaredGate, Gaussian};
/// use wayfix_kalman::{KalmanFilter, LinearMotion, LinearSensor, GatedUpdate};
/// let prior = Gaussian::new(Vector1::new(0.0), Matrix1::new(1.0))?;
/// let mut filter = KalmanFilter::new(LinearMotion::stationary(Matrix1::new(0.0))?, prior)?;
/// let sensor = LinearSensor::new(Matrix1::new(1.0), Matrix1::new(1.0))?;
/// let gate = ChiSquaredGate::from_probability(1, 0.99)?;
/// let outcome = filter.update_gated(&sensor, Some(&Vector1::new(50.0)), &gate)?;
/// match outcome {
///     GatedUpdate::Rejected { innovation, threshold } => assert!(innovation.nis() > threshold),
///     _ => unreachable!("35 sigma"),
/// }
/// assert_eq!(filter.estimate().mean()[0], 0.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub enum GatedUpdate<X: Manifold, Z: Manifold<Scalar = X::Scalar>>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    /// The measurement was used.
    Accepted {
        /// Its innovation.
        innovation: Innovation<X, Z>,
    },
    /// The gate rejected the measurement as an outlier; the filter is unchanged.
    Rejected {
        /// Its innovation.
        innovation: Innovation<X, Z>,
        /// The largest normalized innovation squared that would have passed.
        threshold: f64,
    },
    /// There was no measurement; the filter is unchanged.
    Missing,
}

impl<X: Manifold, Z: Manifold<Scalar = X::Scalar>> GatedUpdate<X, Z>
where
    DefaultAllocator: UpdateAlloc<X::Dim, Z::Dim>,
{
    /// The innovation of the measurement, used or not; `None` if there was none.
    pub fn innovation(&self) -> Option<&Innovation<X, Z>> {
        match self {
            Self::Accepted { innovation } | Self::Rejected { innovation, .. } => Some(innovation),
            Self::Missing => None,
        }
    }
    /// Whether the measurement corrected the filter.
    pub fn is_accepted(&self) -> bool {
        matches!(self, Self::Accepted { .. })
    }
}
