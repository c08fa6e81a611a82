//! Ranges without bearings, to beacons of unknown place, by a receiver of unknown bias and scale.
//!
//! A range is $`z = e^{λ} |b - p| + β + v`$ with beacon $`b`$, position $`p`$, bias $`β`$, scale $`e^{λ}`$ and white noise $`v`$.
//! [`estimate`] finds path, beacons, calibration and noise in one batch, without a start for any of them.

mod batch;
mod calibration;
mod estimate;
mod input;
mod noise;
mod placement;
mod residuals;

pub use calibration::{Calibration, CalibrationPrior};
pub use estimate::{RangeOnlyEstimate, RangeOnlyParams, UnplacedBeacon, estimate};
pub use input::{Range, RangeOnlyInput};
pub use noise::RangeOnlyNoise;
pub use residuals::BeaconRange;
