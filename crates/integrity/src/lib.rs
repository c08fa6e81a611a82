//! Integrity monitoring: does the estimated pose agree with the measurements?
//!
//! | question | type |
//! | --- | --- |
//! | Have the measurements changed? | [`CusumTest`]: Page's cumulative sum |
//! | Which of two hypotheses holds? | [`ProbabilityRatioTest`]: Wald's sequential test |
//! | Has the robot been kidnapped? | [`ShiryaevRobertsTest`]: Shiryaev–Roberts over distance |
//! | Where is it now? | [`RelocalizationTest`]: the present hypothesis against the alternatives of a search |
//!
//! The crate knows no sensor. A localizer gives log-likelihoods and the distance that it drives.

mod change_test;
mod cusum;
mod error;
mod params;
mod ratio_test;
mod relocalization;

pub use change_test::ShiryaevRobertsTest;
pub use cusum::CusumTest;
pub use error::IntegrityError;
pub use params::RelocalizationParams;
pub use ratio_test::{ProbabilityRatioTest, RatioVerdict};
pub use relocalization::{AlternativeHypothesis, RelocalizationCandidate, RelocalizationTest};
