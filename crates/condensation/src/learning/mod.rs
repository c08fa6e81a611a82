//! What is learned before the robot drives: how every state looks and how that varies, where moves lead.

mod appearance;
mod disturbance;
mod likelihood;
mod noise;
mod p_value;
mod params;
mod response;
mod source;
mod transitions;
mod traverse;
mod whitener;

pub use appearance::Appearance;
pub use disturbance::{Disturbance, N_DISTURBANCES};
pub(crate) use likelihood::DisturbanceBelief;
pub use likelihood::Tail;
pub use noise::NoiseParams;
pub use p_value::PValues;
pub use params::AppearanceParams;
pub use source::{PictureViews, SceneViews, ViewSource};
pub use transitions::MoveLog;
pub use traverse::{Traverse, TraverseParams};
