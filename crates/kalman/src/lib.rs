//! Kalman filters in linear, extended, unscented, square-root, information and switching forms.
//!
//! | You have | Take |
//! | --- | --- |
//! | matrices | [`KalmanFilter`] with [`LinearMotion`] and [`LinearSensor`] |
//! | models of your own, on vectors, poses or angles | [`GaussianFilter`] with a [`KalmanAlgorithm`]: [`ExtendedKalmanAlgorithm`], [`IteratedExtendedKalmanAlgorithm`], [`UnscentedKalmanAlgorithm`] |
//! | components of the state seen alone, with independent noise | [`update_component`] |
//! | sharp sensors, vague priors or single precision | the form [`SquareRootKalmanAlgorithm`] |
//! | large measurements with little state, or small with much | the forms [`InformationFilterAlgorithm`], [`SequentialUpdateAlgorithm`] |
//! | several measurements at once | [`StackedSensor`] sensors: the batch update |
//! | a whole recording | [`RtsSmoother`] |
//! | a target with several motion models | [`ImmFilter`], [`Gpb2Filter`] |
//! | conditions that switch, each with its own filter | [`FilterBank`], [`JumpMarkovFilter`] |
//! | noise parameters to validate | [`Innovation::nis`], [`nees`], [`ConsistencyStatistics`] |
//!
//! Every update returns its [`Innovation`]; gated ones an [`GatedUpdate`] with the outcome of the measurement. After an error the filter is
//! unchanged.
//!
//! ```
//! use nalgebra::{Matrix1, Matrix1x2, Matrix2, Vector1, Vector2};
//! use wayfix_gaussian_core::Gaussian;
//! use wayfix_kalman::{KalmanFilter, LinearMotion, LinearSensor};
//!
//! let motion = LinearMotion::new(Matrix2::new(1.0, 0.1, 0.0, 1.0), Matrix2::identity() * 1e-4)?;
//! let sensor = LinearSensor::new(Matrix1x2::new(1.0, 0.0), Matrix1::new(0.01))?;
//! let mut filter = KalmanFilter::new(motion, Gaussian::new(Vector2::zeros(), Matrix2::identity())?)?;
//! filter.predict(None)?;
//! let innovation = filter.update(&sensor, &Vector1::new(0.3))?;
//! assert!(innovation.nis() < 1.0);
//! assert!(filter.update(&sensor, &Vector1::new(f64::NAN)).is_err());
//! # Ok::<(), wayfix_kalman::KalmanError>(())
//! ```

mod algebra;
mod certificate;
mod check;
mod consistency;
mod error;
mod filter;
mod form;
mod forms;
mod innovation;
mod linear;
mod linearize;
mod smoother;
mod stacked;
mod switching;
mod update;

pub use consistency::{ConsistencyStatistics, nees};
pub use error::KalmanError;
pub use filter::{ExtendedKalmanFilter, GaussianFilter};
pub use form::KalmanAlgorithm;
pub use forms::{
    ExtendedKalmanAlgorithm, FactoredGaussian, InformationBelief, InformationFilterAlgorithm,
    IteratedExtendedKalmanAlgorithm, SequentialUpdateAlgorithm, SquareRootKalmanAlgorithm,
    UnscentedKalmanAlgorithm,
};
pub use innovation::Innovation;
pub use linear::{
    KalmanFilter, LinearInnovation, LinearMotion, LinearSensor, LinearUpdate, update_component,
};
pub use smoother::RtsSmoother;
pub use stacked::{StackedMeasurement, StackedSensor};
pub use switching::{
    FilterBank, FilterBankUpdate, Gpb2Filter, ImmFilter, JumpMarkovFilter, JumpMarkovFilterParams,
    MarkovChain,
};
pub use update::GatedUpdate;

/// The matrix library of every public signature, re-exported because its versions do not mix.
pub use nalgebra;

/// The code on the first page of the repository.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
