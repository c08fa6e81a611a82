//! Hypotheses about the colours, and their agreement with the contour.

pub(super) mod agreement;
pub(super) mod candidate;
pub(super) mod color_similarity;
pub(super) mod each;
pub(super) mod samples;
