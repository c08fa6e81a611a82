use std::fmt;

/// Nanoseconds on the clock of a log.
///
/// Integers are exact; floating-point seconds since 1970 would lose the last digits.
/// ```
/// use wayfix_sensor_log::Stamp;
/// let stamp = Stamp::from_seconds(1_248_446_189.249).expect("finite");
/// assert_eq!(stamp.nanoseconds(), 1_248_446_189_249_000_000);
/// assert!((stamp.seconds_since(Stamp::from_nanoseconds(1_248_446_189_000_000_000)) - 0.249).abs() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Stamp(u64);

impl Stamp {
    /// The stamp `nanoseconds` after the clock's epoch.
    pub const fn from_nanoseconds(nanoseconds: u64) -> Self {
        Self(nanoseconds)
    }
    /// The stamp `seconds` after the clock's epoch, to the nearest microsecond (a double near 1.2e9 holds no more);
    /// `None` when negative, not finite or beyond the year 2554.
    pub fn from_seconds(seconds: f64) -> Option<Self> {
        let microseconds = (seconds * 1e6).round();
        (0.0..=1.8e16).contains(&microseconds).then(|| Self(microseconds as u64 * 1000))
    }
    /// Nanoseconds after the clock's epoch.
    pub const fn nanoseconds(self) -> u64 {
        self.0
    }
    /// Seconds after the clock's epoch.
    pub fn seconds(self) -> f64 {
        self.0 as f64 * 1e-9
    }
    /// Seconds from `earlier` to this stamp; negative if `earlier` is later.
    pub fn seconds_since(self, earlier: Self) -> f64 {
        (self.0 as i128 - earlier.0 as i128) as f64 * 1e-9
    }
}

impl fmt::Display for Stamp {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{:09} s", self.0 / 1_000_000_000, self.0 % 1_000_000_000)
    }
}
