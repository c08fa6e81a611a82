//! Range scans of a laser.

mod laser_scan;
mod summary;

pub use laser_scan::LaserScan;
pub use summary::LogScanStatistics;
