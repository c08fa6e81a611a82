//! What is learned before the robot drives: the appearance of every state, its variation, and the end states of moves.

mod appearance;
mod disturbance;
mod likelihood;
mod motion;
mod noise;
mod p_value;
mod params;
mod response;
mod source;
mod transitions;
mod traverse;
mod whitener;

pub use appearance::AppearanceModel;
pub use disturbance::{N_DISTURBANCES, UnknownShiftAndLight};
pub(crate) use likelihood::DisturbanceBelief;
pub use likelihood::LikelihoodTail;
pub use motion::{LearnedMotion, LoggedMove};
pub use noise::NoiseCovarianceParams;
pub use p_value::PValueStatistics;
pub use params::AppearanceLearningParams;
pub use source::{OneViewPerPicture, SceneViews, ViewSource};
pub use transitions::TransitionCounts;
pub use traverse::{RouteAppearanceModel, RouteAppearanceParams};
