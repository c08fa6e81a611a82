//! The colours of the target as a cloud in colour space, and how the cloud moves.

mod cloud;
mod dynamics;
mod learn;
mod principal;
mod state;
mod warp;

pub use cloud::ColorCloud;
pub use dynamics::ColorDynamics;
pub use learn::LearnedColorDynamics;
pub use principal::PrincipalColors;
pub use state::{COLOR_DIM, ColorDistributionState, ColorStateVector};
pub use warp::AffineColorMap;
