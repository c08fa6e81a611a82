//! What the measurements of a run say about robot and map, and which directions of the map nothing has ever constrained.
//!
//! SLAM sees distances between robot and landmarks, never places: whoever moves the whole world leaves every measurement as it was. Those directions
//! stay as uncertain as the start was, however long the robot drives, unless an anchor or an external sensor ties the map to the world.
//! [Andrade-Cetto 2005, Sec. 2.2]

mod direction;
mod linearized_update;
mod null_space;
mod recorder;

pub use direction::UnobservableDirection;
pub use recorder::ObservabilityRecorder;
