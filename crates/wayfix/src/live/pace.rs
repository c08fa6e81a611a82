use std::{thread, time::Duration};

use wayfix_sensor_log::Stamp;
use wayfix_system_core::Stopwatch;

use super::LiveServerError;

/// Longest pause between messages; a first stamp of 0 before present-day stamps would pause for decades.
const LONGEST_PAUSE: Duration = Duration::from_secs(5);

/// Delays messages to the pace of the log.
/// ```
/// use wayfix::live::PlaybackPace;
/// assert!(PlaybackPace::new(2.0).is_ok());
/// assert!(PlaybackPace::new(-1.0).is_err() && PlaybackPace::new(f64::NAN).is_err());
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PlaybackPace {
    factor: f64,
    begun: Option<Begun>,
}

#[derive(Clone, Copy, Debug)]
struct Begun {
    since: Stopwatch,
    latest: Stamp,
    /// Due time of the latest message, after the first.
    due: Duration,
}

impl PlaybackPace {
    /// `factor` times as fast as the log was recorded; 0 disables the delay. Pauses longer than five seconds are cut to five.
    /// # Errors
    /// Returns [`LiveServerError::Pace`].
    pub fn new(factor: f64) -> Result<Self, LiveServerError> {
        if !factor.is_finite() || factor < 0.0 {
            return Err(LiveServerError::Pace { factor });
        }
        Ok(Self { factor, begun: None })
    }

    /// Waits until a message with this stamp is due; the first is due at once.
    pub(crate) fn wait_for(&mut self, stamp: Stamp) {
        let (since, due) = self.due(stamp);
        thread::sleep(due.saturating_sub(since.elapsed()));
    }

    /// The due time, and its reference.
    fn due(&mut self, stamp: Stamp) -> (Stopwatch, Duration) {
        let factor = self.factor;
        let start = || Begun { since: Stopwatch::start(), latest: stamp, due: Duration::ZERO };
        let begun = self.begun.get_or_insert_with(start);
        if factor > 0.0 && stamp > begun.latest {
            let pause = stamp.seconds_since(begun.latest) / factor;
            begun.due += Duration::try_from_secs_f64(pause).unwrap_or(LONGEST_PAUSE).min(LONGEST_PAUSE);
            begun.latest = stamp;
        }
        (begun.since, begun.due)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dues(factor: f64, seconds: &[f64]) -> Vec<Duration> {
        let mut pace = PlaybackPace::new(factor).expect("a factor");
        let due = |seconds: &f64| pace.due(Stamp::from_seconds(*seconds).expect("a stamp")).1;
        seconds.iter().map(due).collect()
    }

    #[test]
    fn a_message_is_due_by_its_stamp_and_the_factor() {
        let ms = Duration::from_millis;
        assert_eq!(dues(1.0, &[100.0, 100.5, 103.0]), [ms(0), ms(500), ms(3000)]);
        assert_eq!(dues(4.0, &[100.0, 103.0, 101.0, 103.0, 104.0]), [0, 750, 750, 750, 1000].map(ms));
        assert_eq!(dues(0.0, &[100.0, 103.0, 104.0]), [ms(0); 3]);
    }

    #[test]
    fn a_stamp_of_another_age_stops_nothing() {
        let seconds = Duration::from_secs;
        assert_eq!(dues(1.0, &[0.0, 1.7e9, 1.7e9 + 1.0]), [seconds(0), LONGEST_PAUSE, seconds(6)]);
        assert_eq!(dues(f64::MIN_POSITIVE, &[0.0, 1.0]), [seconds(0), LONGEST_PAUSE]);
    }
}
