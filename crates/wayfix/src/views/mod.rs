//! State condensation on pictures: in which of the views of a scene the robot is, from what the whole view looks like.
//!
//! A [`ViewSystem`] learns one picture of a scene and drives in another one, seen on another day; [`run`] makes many drives between random
//! places, [`summarize`] gives their figures and [`pictures`] shows them. [`corridor`] does the same along a corridor that was driven twice.

pub mod corridor;
mod error;
mod feature;
mod figures;
mod normalization;
mod params;
mod pictures;
mod real_scene;
mod register;
mod run;
mod scene;
mod system;

pub use error::ViewsError;
pub use feature::FeatureKind;
pub use figures::summarize;
pub use normalization::Normalization;
pub use params::ViewsParams;
use pictures::shade;
pub use pictures::{belief_film, pictures};
pub use real_scene::RealScene;
pub use register::mean_shift;
pub use run::{ViewsRun, run};
pub use scene::{Scene, read_scene};
pub use system::{Setup, Step, Trial, ViewSystem};
