use std::collections::BTreeMap;
use std::fmt;

use super::LaserScan;

/// Scan statistics; `Display` prints them for people.
/// ```
/// use wayfix_sensor_log::{LaserScan, LogScanStatistics};
/// let mut summary = LogScanStatistics::default();
/// let (angle_min, angle_increment, range_max, beam_period) = (0.0, 0.1, 8.0, 0.0);
/// summary.add(&LaserScan { angle_min, angle_increment, range_max, beam_period, ranges: vec![1.0, 9.0] });
/// assert_eq!((summary.n_beams, summary.n_without_echo), (2, 1));
/// assert_eq!(summary.to_string(), "1 of 2 beams; 50.0 % of the beams without echo");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Default)]
#[non_exhaustive]
pub struct LogScanStatistics {
    /// Number of scans by number of beams.
    pub sizes: BTreeMap<usize, u64>,
    /// Beams of all scans.
    pub n_beams: u64,
    /// Number of beams without echo.
    pub n_without_echo: u64,
}

impl LogScanStatistics {
    /// Counts a scan.
    pub fn add(&mut self, scan: &LaserScan) {
        let n_beams = scan.ranges.len();
        *self.sizes.entry(n_beams).or_default() += 1;
        self.n_beams += n_beams as u64;
        self.n_without_echo += (n_beams - scan.echoes().count()) as u64;
    }
}

impl fmt::Display for LogScanStatistics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let sizes: Vec<String> =
            self.sizes.iter().map(|(n_beams, count)| format!("{count} of {n_beams} beams")).collect();
        let percent = 100.0 * self.n_without_echo as f64 / self.n_beams.max(1) as f64;
        write!(f, "{}; {percent:.1} % of the beams without echo", sizes.join(", "))
    }
}
