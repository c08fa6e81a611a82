//! The vocabulary of recursive estimation.
//!
//! Traits for what every estimator has, one axis of variation each, and no algorithm:
//!
//! | trait | says | implement it to |
//! | --- | --- | --- |
//! | [`Manifold`] | what a state or a measurement is | estimate something that is not a vector |
//! | [`LieGroup`] | that states compose | use invariant filters, compose poses |
//! | [`MotionModel`] | where the state goes, with Jacobian and noise | drive a Kalman filter |
//! | [`SampleMotion`] | the same, as a curried sampler | drive particles |
//! | [`SensorModel`] | what the sensor should read, with Jacobian and noise | correct a Kalman filter |
//! | [`LikelihoodModel`] | the same, as a curried log-likelihood | weigh particles |
//!
//! Each trait states its **laws**; [`laws`] holds suites that check them on your own types. [`laws::filter`](fn@laws::filter) checks
//! whole filters.
//! The concrete states that planar and spatial robots need are here too: [`Angle`], [`Pose2`], [`Pose3`].
//!
//! Conventions everywhere: SI units and radians, x forward, y left, z up (REP 103), angles in (−π, π],
//! tangent vectors in the body frame in the order `(x, y, θ)`.
//!
//! ```
//! use wayfix_estimation_traits::{Manifold, Pose2};
//! use nalgebra::Vector3;
//!
//! let pose = Pose2::new(1.0, 2.0, std::f64::consts::FRAC_PI_2);
//! let ahead = pose.retract(&Vector3::new(1.0, 0.0, 0.0)); // one metre ahead, in the body frame
//! assert!((ahead.translation.y - 3.0).abs() < 1e-12);
//! assert!((pose.local(&ahead) - Vector3::new(1.0, 0.0, 0.0)).norm() < 1e-12);
//! ```

mod alloc;
mod angle;
mod derivative;
pub mod laws;
mod lie_group;
mod manifold;
mod motion;
mod pose2;
mod pose3;
#[cfg(feature = "sampling")]
mod sample_motion;
mod scalar;
mod sensor;

pub use alloc::{StateAlloc, UpdateAlloc};
pub use angle::{Angle, wrap_angle};
pub use derivative::numerical_jacobian;
pub use lie_group::LieGroup;
pub use manifold::{Jacobian, Manifold, Tangent, TangentMatrix};
pub use motion::MotionModel;
pub use pose2::Pose2;
pub use pose3::Pose3;
#[cfg(feature = "sampling")]
pub use sample_motion::SampleMotion;
pub use scalar::{epsilon, to_f64};
pub use sensor::{LikelihoodModel, LogWeight, SensorModel};

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;
