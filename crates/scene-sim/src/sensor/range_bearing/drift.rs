use super::RangeDependentSigma;
use crate::random::{GaussMarkovProcess, RandomStreamPurpose, RandomStreams};
use crate::{SimulationError, check};

/// Time-correlated errors of a target's range and bearing: a Gauss-Markov process per target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CorrelatedErrorParams {
    /// Standard deviation of the range's part. Default 0.
    pub range_sigma: RangeDependentSigma,
    /// Standard deviation of the bearing's part, radians. Default 0.
    pub bearing_sigma_rad: f64,
    /// Correlation time, seconds. Default 5.
    pub correlation_time_s: f64,
}

impl Default for CorrelatedErrorParams {
    fn default() -> Self {
        Self { range_sigma: RangeDependentSigma::default(), bearing_sigma_rad: 0.0, correlation_time_s: 5.0 }
    }
}

impl CorrelatedErrorParams {
    pub(super) fn validate(&self) -> Result<(), SimulationError> {
        self.range_sigma.validate()?;
        check::not_negative("σ of the bearing's drift (rad)", self.bearing_sigma_rad)?;
        check::not_negative("correlation time of the drift (s)", self.correlation_time_s)
    }
}

/// The drift of one target, running whether or not it is in view.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Drift {
    range: GaussMarkovProcess,
    bearing: GaussMarkovProcess,
}

impl Drift {
    pub(super) fn new(params: &CorrelatedErrorParams) -> Self {
        let process = GaussMarkovProcess::new(params.correlation_time_s);
        Self { range: process.clone(), bearing: process }
    }

    /// The errors of range and bearing, in units of their standard deviations.
    pub(super) fn advance(&mut self, step_s: f64, streams: &mut RandomStreams) -> (f64, f64) {
        let rng = streams.of(RandomStreamPurpose::Drift);
        (self.range.advance(step_s, rng), self.bearing.advance(step_s, rng))
    }
}
