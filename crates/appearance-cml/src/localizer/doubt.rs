use super::RelocationParams;
use super::fit::Fit;
use super::running_share::RunningShare;

/// Whether the robot recognizes where it thinks it is.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub(super) struct Doubt {
    /// Share of the last views that were not recognized where they should have been.
    missed: RunningShare,
    is_great: bool,
}

impl Doubt {
    /// As great as it takes.
    pub(super) fn great(params: &RelocationParams) -> Self {
        Self { missed: RunningShare(params.doubt), is_great: true }
    }

    pub(super) fn is_great(self) -> bool {
        self.is_great
    }

    /// It begins when the share passes that of the parameters, and ends when it falls below half of that.
    pub(super) fn after(self, fit: Fit, params: &RelocationParams) -> Self {
        if fit == Fit::Unknown {
            return self;
        }
        let missed = self.missed.after(fit == Fit::Missed, params.views);
        let least = if self.is_great { 0.5 * params.doubt } else { params.doubt };
        Self { missed, is_great: missed.0 >= least }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(fits: &[(Fit, usize)]) -> Doubt {
        let params = RelocationParams { doubt: 0.5, ..RelocationParams::default() };
        let views = fits.iter().flat_map(|(fit, n)| std::iter::repeat_n(*fit, *n));
        views.fold(Doubt::default(), |doubt, fit| doubt.after(fit, &params))
    }

    #[test]
    fn who_misses_what_should_be_there_doubts_and_who_sees_nothing_known_does_not() {
        assert!(!after(&[(Fit::Unknown, 1000)]).is_great());
        // 1 - (7/8)^n reaches a half at n = 5.2.
        assert!(!after(&[(Fit::Missed, 5)]).is_great());
        assert!(after(&[(Fit::Missed, 6)]).is_great());
    }

    #[test]
    fn doubt_lasts_until_half_of_it_is_gone() {
        // 0.55 · (7/8)^n falls below a quarter at n = 5.9.
        assert!(after(&[(Fit::Missed, 6), (Fit::Recognized, 5)]).is_great());
        assert!(!after(&[(Fit::Missed, 6), (Fit::Recognized, 6)]).is_great());
    }
}
