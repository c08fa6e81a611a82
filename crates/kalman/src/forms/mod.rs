//! The forms of a Gaussian filter.

mod extended;
mod information;
mod iterated;
mod sequential;
mod square_root;
mod unscented;

pub use extended::ExtendedForm;
pub use information::{InformationBelief, InformationForm};
pub use iterated::IteratedExtendedForm;
pub use sequential::SequentialForm;
pub use square_root::{FactoredGaussian, SquareRootForm};
pub use unscented::UnscentedForm;
