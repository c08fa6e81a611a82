//! The forms of a Gaussian filter.

mod extended;
mod information;
mod iterated;
mod sequential;
mod square_root;
mod unscented;

pub use extended::ExtendedKalmanAlgorithm;
pub use information::{InformationBelief, InformationFilterAlgorithm};
pub use iterated::IteratedExtendedKalmanAlgorithm;
pub use sequential::SequentialUpdateAlgorithm;
pub use square_root::{FactoredGaussian, SquareRootKalmanAlgorithm};
pub use unscented::UnscentedKalmanAlgorithm;
