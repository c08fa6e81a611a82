/// When a search comes although no doubt calls for one, by what became of those before.
///
/// A wrong place may explain what is seen quite well, so that only another gives it away: the younger a place, the more often it is looked at. Searches
/// that confirm it one after the other, while everything is seen as well as usual, become rarer; those in vain come more often.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Routine {
    /// Searches since the place was sure and the light with it.
    n_in_vain: usize,
    /// Searches in a row that found the robot where it believed to be.
    n_confirmed: u32,
    /// Frames since the robot was looked for.
    n_since: usize,
}

/// How many times the frames between searches double.
const MOST_DOUBLINGS: u32 = 2;

impl Default for Routine {
    /// Before the first frame: nothing is sure.
    fn default() -> Self {
        Self { n_in_vain: 1, n_confirmed: 0, n_since: 0 }
    }
}

impl Routine {
    /// Whether the robot is to be looked for in the next frame, `every` so many frames while a place is neither confirmed nor doubted.
    pub(crate) fn is_due(&self, every: usize, is_sound: bool) -> bool {
        let is_doubted = self.n_in_vain > 1 || !is_sound;
        let rarer = 1 << self.n_confirmed.min(MOST_DOUBLINGS);
        let every = if is_doubted { every.div_ceil(2) } else { every.saturating_mul(rarer) };
        every > 0 && self.n_since + 1 >= every
    }

    /// The next frame, in which the robot is looked for or not.
    pub(crate) fn next(self, is_looked_for: bool) -> Self {
        Self { n_since: if is_looked_for { 0 } else { self.n_since + 1 }, ..self }
    }

    /// After a frame in which the place was sure or not, and things were seen as well as usual or not.
    pub(crate) fn after(self, is_search: bool, is_sure: bool, is_as_usual: bool) -> Self {
        let n_in_vain = if is_sure { 0 } else { self.n_in_vain + usize::from(is_search) };
        let n_confirmed = match (is_as_usual, is_search, is_sure) {
            (true, true, true) => self.n_confirmed.saturating_add(1),
            (true, false, _) => self.n_confirmed,
            _ => 0,
        };
        Self { n_in_vain, n_confirmed, ..self }
    }

    /// Searches since the place was sure and the light with it.
    pub(crate) fn n_in_vain(&self) -> usize {
        self.n_in_vain
    }

    /// Frames since the robot was looked for.
    pub(crate) fn n_since(&self) -> usize {
        self.n_since
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The frames, of so many, in which the robot is looked for.
    fn searches(
        n_frames: usize,
        is_sure: impl Fn(usize) -> bool,
        is_as_usual: impl Fn(usize) -> bool,
    ) -> Vec<usize> {
        let mut routine = Routine::default();
        let mut searches = Vec::new();
        for frame in 1..=n_frames {
            let is_search = routine.is_due(10, true);
            searches.extend(is_search.then_some(frame));
            routine = routine.next(is_search).after(is_search, is_sure(frame), is_as_usual(frame));
        }
        searches
    }

    #[test]
    fn a_place_that_is_confirmed_is_looked_for_less_often_and_one_that_is_not_more_often() {
        assert_eq!(searches(160, |_| true, |_| true), [10, 30, 70, 110, 150]);
        assert_eq!(searches(35, |_| false, |_| true), [10, 15, 20, 25, 30, 35]);
        // Once it is sure again the next one comes as usual.
        assert_eq!(searches(45, |frame| frame > 16, |_| true), [10, 15, 25, 45]);
    }

    #[test]
    fn a_view_that_fits_worse_than_usual_ends_the_rest() {
        assert_eq!(searches(60, |_| true, |frame| frame != 35), [10, 30, 40, 60]);
        assert_eq!(searches(50, |_| true, |_| false), [10, 20, 30, 40, 50]);
    }

    #[test]
    fn never_is_never() {
        let routine = (0..1000).fold(Routine::default(), |routine, _| routine.next(false));
        assert!(!routine.is_due(0, true) && !routine.is_due(0, false));
    }
}
