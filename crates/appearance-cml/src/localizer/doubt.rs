use super::RelocationParams;

/// Whether the robot recognizes where it thinks it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Doubt {
    /// Average over the last views: 1 for those not recognized where they should have been.
    missed: f64,
    /// Since it doubted last it has been sure once.
    settled: bool,
}

/// How a view fits the place where the robot thinks it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fit {
    /// No reference is known to be there for certain: nothing can be said.
    Unknown,
    /// References are there, and none of them looks like the view.
    Missed,
    /// Some reference there looks somewhat like the view.
    Recognized,
    /// One looks much like it.
    Sure,
}

impl Doubt {
    pub(super) fn none() -> Self {
        Self { missed: 0.0, settled: true }
    }

    pub(super) fn is_great(self) -> bool {
        !self.settled
    }

    pub(super) fn after(self, fit: Fit, params: &RelocationParams) -> Self {
        let miss = match fit {
            Fit::Unknown => return self,
            Fit::Missed => 1.0,
            Fit::Recognized | Fit::Sure => 0.0,
        };
        let missed = self.missed + (miss - self.missed) / params.views.max(1.0);
        let settled = missed < params.doubt && (self.settled || fit == Fit::Sure);
        Self { missed, settled: settled || params.doubt >= 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(share: f64, fits: &[(Fit, usize)]) -> Doubt {
        let params = RelocationParams { doubt: share, ..RelocationParams::default() };
        let views = fits.iter().flat_map(|(fit, n)| std::iter::repeat_n(*fit, *n));
        views.fold(Doubt::none(), |doubt, fit| doubt.after(fit, &params))
    }

    #[test]
    fn who_misses_what_should_be_there_doubts_and_who_sees_nothing_known_does_not() {
        assert!(!after(0.5, &[(Fit::Unknown, 1000)]).is_great());
        // 1 - (7/8)^n reaches a half at n = 5.2.
        assert!(!after(0.5, &[(Fit::Missed, 5)]).is_great());
        assert!(after(0.5, &[(Fit::Missed, 6)]).is_great());
        assert!(!after(1.0, &[(Fit::Missed, 1000)]).is_great(), "1 never doubts");
    }

    #[test]
    fn doubt_lasts_until_one_view_is_sure() {
        assert!(after(0.5, &[(Fit::Missed, 6), (Fit::Recognized, 50)]).is_great());
        assert!(!after(0.5, &[(Fit::Missed, 6), (Fit::Recognized, 50), (Fit::Sure, 1)]).is_great());
    }
}
