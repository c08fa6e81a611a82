//! The forms of a Gaussian filter.

mod extended;
mod information;
mod iterated;
mod sequential;
mod square_root;
mod unscented;

pub use extended::Extended;
pub use information::{Information, InformationBelief};
pub use iterated::IteratedExtended;
pub use sequential::Sequential;
pub use square_root::{FactoredGaussian, SquareRoot};
pub use unscented::Unscented;
