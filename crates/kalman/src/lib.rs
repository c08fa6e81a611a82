//! Kalman filters in linear, extended, unscented, square-root, information and switching forms.

mod carry;
mod check;
mod consistency;
mod error;
mod filter;
mod form;
mod forms;
mod gating;
mod innovation;
mod linear;
mod linearize;
mod observing;
mod product;
mod smoother;
mod stacked;
mod switching;
mod update;

pub use consistency::{Consistency, nees};
pub use error::KalmanError;
pub use filter::{ExtendedKalmanFilter, GaussianFilter};
pub use form::Form;
pub use forms::{
    Extended, FactoredGaussian, Information, InformationBelief, IteratedExtended, PlainExtended, Sequential, SquareRoot, Unscented,
};
pub use innovation::Innovation;
pub use linear::{KalmanFilter, LinearMotion, LinearSensor};
pub use observing::Observing;
pub use smoother::RtsSmoother;
pub use stacked::{Stack, Stacked};
pub use switching::{Candidate, Gpb2, Imm, JumpMarkov, JumpMarkovParams, MarkovChain, ModelBank};
pub use update::Update;

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;
