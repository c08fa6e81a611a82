//! Integrity monitoring: does the estimated pose agree with the measurements?
//!
//! | question | type |
//! | --- | --- |
//! | Have the measurements changed? | [`CusumTest`]: Page's cumulative sum |
//! | Which of two hypotheses holds? | [`ProbabilityRatioTest`]: Wald's sequential test |
//! | Has the robot been kidnapped, and where is it now? | [`RelocalizationTest`]: Shiryaev–Roberts over distance, the present hypothesis against the alternatives of a search |
//!
//! The crate knows no sensor. A localizer gives log-likelihoods and the distance that it drives.

mod cusum;
mod error;
mod params;
mod ratio_test;
mod relocalization;

pub use cusum::CusumTest;
pub use error::IntegrityError;
pub use params::RelocalizationParams;
pub use ratio_test::{ProbabilityRatioTest, RatioVerdict};
pub use relocalization::{AlternativeHypothesis, RelocalizationCandidate, RelocalizationTest};
