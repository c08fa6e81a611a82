/// One scan of a planar laser: a range for every beam, at equal angles.
///
/// Ranges are stored as measured: NaN, infinite, zero, negative and those of [`range_max`](Self::range_max) or more mean no echo.
/// [`echoes`](Self::echoes) skips them.
/// ```
/// use wayfix_sensor_log::LaserScan;
/// let scan = LaserScan {
///     angle_min: -0.1,
///     angle_increment: 0.1,
///     range_max: 50.0,
///     beam_period: 0.0,
///     ranges: vec![2.0, f64::NAN, 81.9],
/// };
/// assert_eq!(scan.echoes().collect::<Vec<_>>(), [(-0.1, 2.0)]);
/// assert_eq!(scan.bearing(1), 0.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct LaserScan {
    /// Direction of the first beam from the sensor, radians, 0 ahead, counter-clockwise.
    pub angle_min: f64,
    /// From one beam to the next, radians; negative for a clockwise sweep.
    pub angle_increment: f64,
    /// Ranges from here on are no echo, m; infinite if the log does not state it.
    pub range_max: f64,
    /// Time between beams, s; the stamp is that of the first. 0 if the log does not state it.
    pub beam_period: f64,
    /// Metres, in the order of the beams.
    pub ranges: Vec<f64>,
}

impl LaserScan {
    /// Direction of a beam, radians.
    pub fn bearing(&self, beam: usize) -> f64 {
        self.angle_min + beam as f64 * self.angle_increment
    }

    /// Bearing and range of every beam that came back.
    pub fn echoes(&self) -> impl Iterator<Item = (f64, f64)> + '_ {
        let is_echo = |range: f64| range.is_finite() && range > 0.0 && range < self.range_max;
        let beams = self.ranges.iter().enumerate();
        beams.filter(move |(_, range)| is_echo(**range)).map(|(beam, range)| (self.bearing(beam), *range))
    }

    /// Whether the numbers common to all beams are finite; ranges may have any value.
    pub(crate) fn has_finite_angles(&self) -> bool {
        [self.angle_min, self.angle_increment, self.beam_period].iter().all(|number| number.is_finite())
            && !self.range_max.is_nan()
    }
}
