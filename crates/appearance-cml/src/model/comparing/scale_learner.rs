use std::collections::VecDeque;

use super::super::interpolate::GROUP_SIZE;
use crate::{ViewDescriptor, ViewDifferenceModel, ViewDifferenceSample};

/// Learns the scale of view differences along the path: over one step, and over the radius of a group of places.
#[derive(Clone, Debug)]
pub(crate) struct ScaleLearner<D> {
    recent: VecDeque<(f64, D)>,
    odometer: f64,
}

impl<D> Default for ScaleLearner<D> {
    fn default() -> Self {
        Self { recent: VecDeque::new(), odometer: 0.0 }
    }
}

impl<D: ViewDescriptor + Clone> ScaleLearner<D> {
    /// Adds a view at a distance of `distance` metres from the previous one. A robot at rest gives no information about the scale.
    pub(crate) fn observe(&mut self, distance: f64, view: &D, scale: &mut ViewDifferenceModel) {
        if distance <= scale.step() / 2.0 && !self.recent.is_empty() {
            return;
        }
        self.odometer += distance;
        let lag = |&(odometer, ref earlier): &(f64, D)| ViewDifferenceSample {
            lag: self.odometer - odometer,
            distance: view.compare(earlier).distance,
        };
        if let Some(sample) = self.recent.back().map(lag) {
            scale.add_near(sample);
        }
        let ahead = (self.recent.len() == GROUP_SIZE).then(|| self.recent.pop_front()).flatten();
        if let Some(sample) = ahead.as_ref().map(lag) {
            scale.add_ahead(sample);
        }
        self.recent.push_back((self.odometer, view.clone()));
    }

    /// The next view is not connected with the previous ones.
    pub(crate) fn interrupt(&mut self) {
        self.recent.clear();
    }
}
