/// A recursive filter: predict with a control, correct with a measurement, ask for the estimate.
///
/// **Laws** ([`laws::filter`](fn@crate::laws::filter) checks them):
/// 1. after an `Err` the filter is exactly as it was before the call,
/// 2. the same calls give the same bits,
/// 3. measurements that pin the state down move the estimate to it. (A published filter computed its gain and never applied it.)
pub trait BayesFilter {
    /// What moves the state.
    type Control: ?Sized;
    /// What corrects it.
    type Measurement: ?Sized;
    /// What is known of the state: a Gaussian, a set of particles, a table.
    type Estimate;
    /// What an update tells: innovation, gate, weights.
    type Report;
    /// Why a call was refused.
    type Error;

    /// Prior of the next step.
    ///
    /// # Errors
    /// When the control is not usable; the filter is unchanged.
    fn predict(&mut self, control: &Self::Control) -> Result<(), Self::Error>;

    /// Posterior given a measurement.
    ///
    /// # Errors
    /// When the measurement is not usable; the filter is unchanged.
    fn update(&mut self, measurement: &Self::Measurement) -> Result<Self::Report, Self::Error>;

    /// What is known now.
    fn estimate(&self) -> Self::Estimate;
}
