use wayfix_estimation_traits::Pose2;

/// Whether somebody surveyed the map, as far as the robot has come.
///
/// Where it has set out to build a map the place is surveyed too, by whoever has put it there, and no other: a map that was surveyed has such places far
/// apart. One that was begun at several known starts, or whose headings have become as sure in many laps, is not told from it.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Survey {
    first: Option<Pose2<f64>>,
    is_wide: bool,
}

/// How far apart they are, as a multiple of the radius in which a place counts as surveyed.
const WIDE: f64 = 5.0;

impl Survey {
    /// The robot is at a place that was surveyed.
    pub(super) fn passed(&mut self, at: &Pose2<f64>, radius: f64) {
        let first = self.first.get_or_insert(*at);
        self.is_wide |= (at.translation - first.translation).norm() > WIDE * radius;
    }

    /// Whether such places have been passed that are far apart.
    pub(super) fn is_wide(self) -> bool {
        self.is_wide
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn where_a_robot_set_out_is_no_survey() {
        let mut survey = Survey::default();
        let mut pass = |x: f64| {
            survey.passed(&Pose2::new(x, 0.0, 0.0), 2.0);
            survey.is_wide()
        };
        assert!(!pass(1.0) && !pass(3.0) && !pass(-2.0));
        assert!(pass(11.5));
        assert!(pass(1.0), "it remains known");
    }
}
