use std::collections::VecDeque;

use crate::{Descriptor, ViewDifferenceSample, ViewDistanceScale};

/// The last few views along the way, between which the scale of distances is measured.
#[derive(Clone, Debug)]
pub(super) struct ScaleLearner<D> {
    recent: VecDeque<(f64, D)>,
    odometer: f64,
}

impl<D> Default for ScaleLearner<D> {
    fn default() -> Self {
        Self { recent: VecDeque::new(), odometer: 0.0 }
    }
}

/// Views that the second lag spans.
const LAG: usize = 4;
/// A shorter way between two views counts as standing still, m.
const LEAST_WAY: f64 = 0.005;

impl<D: Descriptor + Clone> ScaleLearner<D> {
    /// Measures a view that was taken `way` metres after the last one.
    pub(super) fn observe(&mut self, way: f64, view: &D, scale: &mut ViewDistanceScale) {
        if way < LEAST_WAY && !self.recent.is_empty() {
            return;
        }
        self.odometer += way;
        let lag = |&(odometer, ref earlier): &(f64, D)| ViewDifferenceSample {
            lag: self.odometer - odometer,
            distance: view.compare(earlier).distance,
        };
        if let Some(sample) = self.recent.back().map(lag) {
            scale.add_near(sample);
        }
        let ahead = (self.recent.len() == LAG).then(|| self.recent.pop_front()).flatten();
        if let Some(sample) = ahead.as_ref().map(lag) {
            scale.add_ahead(sample);
        }
        self.recent.push_back((self.odometer, view.clone()));
    }

    /// What comes next is not connected with what was before.
    pub(super) fn interrupt(&mut self) {
        self.recent.clear();
    }
}
