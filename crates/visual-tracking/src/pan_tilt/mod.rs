//! A camera on a pan/tilt head that keeps its target centred. [Andrade-Cetto 2005, Sec. 3.1]

mod active;
mod aim;
mod hardware;
mod simulated;

pub use active::{ActiveEstimate, ActiveTracker};
pub use aim::PanTiltAim;
pub use hardware::PanTiltHead;
pub use simulated::{PanTiltLimits, SimulatedPanTilt};
