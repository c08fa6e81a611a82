use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_sensor_log::Stamp;

use crate::EventCounts;

/// Largest lag searched, s: larger offsets indicate another clock.
const LARGEST_LAG: f64 = 1.0;
/// Maximum number of lags compared on each side.
const MOST_PERIODS: f64 = 50.0;
/// χ² threshold with one degree of freedom at probability 1e-6, for twice the gain in log likelihood.
const LIKELIHOOD_RATIO_THRESHOLD: f64 = 23.9;

/// Number of scans or images of which the turns are compared.
const MOST_TURNS: usize = 1 << 16;

/// Turns of the robot by odometry and as its sensor sees them, of the first 65,536 scans or images.
#[derive(Clone, Debug, Default)]
pub struct TurnHistory {
    /// The dead-reckoned pose at each scan or image.
    pub(super) odometry: Vec<(Stamp, Pose2<f64>)>,
    /// The turn since the previous one, rad.
    pub(super) seen: Vec<Option<f64>>,
}

impl TurnHistory {
    /// Adds a scan or image: the dead-reckoned pose there, and the turn since the previous one, estimated from the two alone, rad.
    pub fn push(&mut self, stamp: Stamp, dead_reckoning: Pose2<f64>, seen_turn: Option<f64>) {
        if self.seen.len() < MOST_TURNS {
            self.odometry.push((stamp, dead_reckoning));
            self.seen.push(seen_turn);
        }
    }

    /// Warns if odometry is stamped late relative to scans or images, and names the parameter that corrects it; `delay` is its current value.
    pub fn warn_of_lag(&self, events: &mut EventCounts, delay: f64) {
        let lag = odometry_lag(&self.odometry, &self.seen);
        if let Some(Lag { seconds: lag, is_at_the_edge: true }) = lag {
            events.warn(
                "odometry_lags",
                format!("odometry and what the sensor shows agree best at the largest shift tried, {:.2} s: their clocks differ by more, or one of them is wrong", lag.abs()),
            );
        } else if let Some(Lag { seconds: lag, .. }) = lag {
            let delay = delay + lag;
            events.warn(
                "odometry_lags",
                format!("odometry comes about {lag:.2} s later than what the sensor shows: their turns agree best there (the parameter `odometry_delay = {delay:.2}` corrects it)"),
            );
        }
    }
}

/// A shift of the odometry.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Lag {
    seconds: f64,
    /// Whether it is the largest that was tried.
    is_at_the_edge: bool,
}

/// Lag of the odometry: the shift, in whole scans, at which the turns of odometry agree best with `seen_turns`.
///
/// Returns `None` if no shift is significant, for example on a straight path.
fn odometry_lag(track: &[(Stamp, Pose2<f64>)], seen_turns: &[Option<f64>]) -> Option<Lag> {
    let odometry = Turns::of(track);
    let pairs = track.windows(2).zip(seen_turns.iter().skip(1));
    let stretches: Vec<(f64, f64, f64)> = pairs
        .filter_map(|(pair, seen)| Some((odometry.seconds(pair[0].0), odometry.seconds(pair[1].0), (*seen)?)))
        // Every lag is scored on the same intervals.
        .filter(|(begin, end, _)| *begin >= 2.0 * LARGEST_LAG && *end <= odometry.last() - 2.0 * LARGEST_LAG)
        .collect();
    let disagreement = |lag: f64| -> f64 {
        let error =
            |(begin, end, seen): &(f64, f64, f64)| seen - (odometry.at(end + lag) - odometry.at(begin + lag));
        stretches.iter().map(|stretch| error(stretch).powi(2)).sum()
    };
    let mut periods: Vec<f64> = stretches.iter().map(|(begin, end, _)| end - begin).collect();
    periods.sort_by(f64::total_cmp);
    let period = *periods.get(periods.len() / 2).filter(|period| **period > 0.0)?;
    let n_periods = (LARGEST_LAG / period).min(MOST_PERIODS) as i32;
    let shifts = (-n_periods..=n_periods).map(|n| (disagreement(f64::from(n) * period), n));
    let (_, n) = shifts.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let lag = f64::from(n) * period;
    let gain = stretches.len() as f64 * (disagreement(0.0) / disagreement(lag)).ln();
    // A shift that helps in both directions only smooths noise and is no lag.
    (gain > LIKELIHOOD_RATIO_THRESHOLD && disagreement(-lag) > disagreement(0.0))
        .then_some(Lag { seconds: lag, is_at_the_edge: n.abs() == n_periods && n_periods > 1 })
}

/// Heading by odometry, interpolated between the scans.
struct Turns {
    start: Stamp,
    /// Time since the start, s, and unwrapped heading, rad.
    headings: Vec<(f64, f64)>,
}

impl Turns {
    fn of(track: &[(Stamp, Pose2<f64>)]) -> Self {
        let start = track.first().map_or_else(Stamp::default, |(first, _)| *first);
        let mut headings = Vec::with_capacity(track.len());
        let mut last: Option<(Pose2<f64>, f64)> = None;
        for (stamp, dead_reckoning) in track {
            let heading = last
                .map_or(0.0, |(pose, heading)| heading + pose.inverse().compose(dead_reckoning).heading());
            last = Some((*dead_reckoning, heading));
            headings.push((stamp.seconds_since(start), heading));
        }
        Self { start, headings }
    }

    fn seconds(&self, stamp: Stamp) -> f64 {
        stamp.seconds_since(self.start)
    }

    fn last(&self) -> f64 {
        self.headings.last().map_or(0.0, |(seconds, _)| *seconds)
    }

    /// The heading at a time, interpolated; constant before the first and after the last.
    fn at(&self, seconds: f64) -> f64 {
        let next = self.headings.partition_point(|(at, _)| *at <= seconds);
        let before = next.checked_sub(1).and_then(|index| self.headings.get(index));
        match (before, self.headings.get(next)) {
            (Some((from, a)), Some((to, b))) => a + (b - a) * (seconds - from) / (to - from),
            (Some((_, heading)), None) | (None, Some((_, heading))) => *heading,
            (None, None) => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    const AMPLITUDE: f64 = 1.0;

    fn heading(seconds: f64, amplitude: f64) -> f64 {
        amplitude * (1.3 * seconds).sin()
    }

    /// The lag found for a robot with an oscillating turn rate, twenty seconds at 10 Hz, with odometry delayed by `lag`.
    fn found_lag(lag: f64, amplitude: f64) -> Option<f64> {
        let seconds: Vec<f64> = (0..200).map(|step| f64::from(step) * 0.1).collect();
        let at = |seconds: &f64| {
            let stamp = Stamp::from_seconds(*seconds).unwrap();
            (stamp, Pose2::new(0.0, 0.0, heading(seconds - lag, amplitude)))
        };
        let track: Vec<_> = seconds.iter().map(at).collect();
        let turns = seconds.windows(2).map(|pair| heading(pair[1], amplitude) - heading(pair[0], amplitude));
        // The scans err by ±1 mrad, alternating.
        let noisy = turns.zip([1e-3, -1e-3].into_iter().cycle()).map(|(turn, error)| Some(turn + error));
        odometry_lag(&track, &[None].into_iter().chain(noisy).collect::<Vec<_>>()).map(|lag| lag.seconds)
    }

    #[test]
    fn lag_of_odometry_is_found_to_the_nearest_scan() {
        for lag in [0.26, -0.15, 0.5] {
            let found = found_lag(lag, AMPLITUDE).unwrap();
            assert_abs_diff_eq!(found, lag, epsilon = 0.5 * 0.1 + 1e-9);
        }
    }

    #[test]
    fn no_lag_is_said_without_lag_or_without_turns() {
        assert_eq!(found_lag(0.0, AMPLITUDE), None);
        assert_eq!(found_lag(0.26, 0.0), None);
        assert_eq!(odometry_lag(&[], &[]), None);
    }
}
