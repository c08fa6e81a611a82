use std::collections::VecDeque;

use crate::ReferenceId;

/// The references that the robot has just made.
///
/// They know of the pose what the robot knew when it made them, and no more: while they are in sight they only hold it back. The paper's
/// answer is to learn with a delay; views that reach further than the delay need this one.
#[derive(Clone, Debug, Default)]
pub(super) struct Trail {
    made: VecDeque<(f64, ReferenceId)>,
    odometer: f64,
}

/// Way after which a reference speaks, in reaches of a match: one to be out of its sight, the rest for the delay of learning.
const REACHES: f64 = 2.0;

impl Trail {
    /// The robot has gone `way` metres; views match over `reach` metres.
    pub(super) fn moved(&mut self, way: f64, reach: f64) {
        self.odometer += way;
        while self.made.front().is_some_and(|(at, _)| self.odometer - at > REACHES * reach) {
            self.made.pop_front();
        }
    }

    pub(super) fn made(&mut self, id: ReferenceId) {
        self.made.push_back((self.odometer, id));
    }

    pub(super) fn holds(&self, id: ReferenceId) -> bool {
        self.made.iter().any(|(_, made)| *made == id)
    }
}
