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

    /// Of a robot that may be anywhere.
    pub(super) fn great() -> Self {
        Self { missed: 0.0, settled: false }
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

    fn after(start: Doubt, fits: &[(Fit, usize)]) -> Doubt {
        let views = fits.iter().flat_map(|(fit, n)| std::iter::repeat_n(*fit, *n));
        views.fold(start, |doubt, fit| doubt.after(fit, &RelocationParams::default()))
    }

    #[test]
    fn who_misses_what_should_be_there_doubts_and_who_sees_nothing_known_does_not() {
        assert!(!after(Doubt::none(), &[(Fit::Unknown, 1000)]).is_great());
        // 1 - (7/8)^n reaches 0.85 at n = 14.2.
        assert!(!after(Doubt::none(), &[(Fit::Missed, 14)]).is_great());
        assert!(after(Doubt::none(), &[(Fit::Missed, 15)]).is_great());
    }

    #[test]
    fn doubt_lasts_until_one_view_is_sure() {
        assert!(after(Doubt::none(), &[(Fit::Missed, 15), (Fit::Recognized, 50)]).is_great());
        assert!(!after(Doubt::great(), &[(Fit::Sure, 1)]).is_great());
        let never = RelocationParams { doubt: 1.0, ..RelocationParams::default() };
        let doubt = (0..100).fold(Doubt::none(), |doubt, _| doubt.after(Fit::Missed, &never));
        assert!(!doubt.is_great());
    }
}
