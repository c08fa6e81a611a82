use wayfix_sensor_log::Stamp;
use wayfix_system_core::EventCounts;

/// Finds films that stand still: the noise of a camera makes no two pictures alike, unless compression drops it. A film of another frame rate repeats single pictures.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct FrozenFilmCheck {
    /// Time of the last picture that differs from the one before.
    changed: Option<Stamp>,
    n_repeats: usize,
}

/// Longest time that a picture may stay, s.
const MAX_SECONDS: f64 = 1.0;

impl FrozenFilmCheck {
    /// Says when a picture has not changed for too long; `is_repeated` tells whether it equals the one before.
    pub(super) fn check(&mut self, stamp: Stamp, is_repeated: bool, events: &mut EventCounts) {
        let changed = *self.changed.get_or_insert(stamp);
        if !is_repeated {
            *self = Self { changed: Some(stamp), n_repeats: 0 };
            return;
        }
        self.n_repeats += 1;
        if self.n_repeats == 1 || stamp.seconds_since(changed) <= MAX_SECONDS {
            return;
        }
        if events.get("film_frozen") > 0 {
            events.count("film_frozen");
        } else {
            let text = format!(
                "the picture of {changed} does not change for more than {MAX_SECONDS} s: if the camera hangs, the film says nothing about the target there"
            );
            events.warn("film_frozen", text);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn film_that_stands_for_more_than_a_second_is_said() {
        let (mut check, mut events) = (FrozenFilmCheck::default(), EventCounts::default());
        for (tenths, is_repeated) in
            [(0, false), (5, true), (10, true), (11, false), (30, true), (31, true), (32, true)]
        {
            check.check(Stamp::from_nanoseconds(tenths * 100_000_000), is_repeated, &mut events);
        }
        assert_eq!((events.get("film_frozen"), events.warnings().len()), (2, 1));
    }
}
