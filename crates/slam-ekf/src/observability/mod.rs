//! The information of a run's measurements about robot and map, and the directions of the map that no measurement constrains.
//!
//! SLAM measures relative positions of robot and landmarks: a common displacement of robot and map changes no measurement. Along those directions the
//! uncertainty stays that of the start, however long the robot drives, unless an anchor or an external sensor ties the map to the world.
//! [Andrade-Cetto 2005, Sec. 2.2]

mod direction;
mod linearized_update;
mod null_space;
mod recorder;

pub use direction::UnobservableDirection;
pub use recorder::ObservabilityRecorder;
