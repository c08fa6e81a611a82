//! Range scans to walls.

mod breakpoints;
mod curvature_test;
mod extraction;
mod extractor;
mod hypothesis;
mod merge;
mod noise;
mod params;
mod pieces;
mod points;
mod scan;

pub use extraction::{BeamCounts, LineExtraction, WallSegment};
pub use extractor::{LineExtractor, extract};
pub use hypothesis::WallHypothesis;
pub use noise::RangeBearingNoise;
pub use params::{LineExtractionParams, SplitMethod};
pub use scan::Scan;
