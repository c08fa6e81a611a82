use std::collections::VecDeque;

use super::reference::Reference;

/// Images kept for a restart, half a second: references learned during an occlusion that ends in a loss are unreliable.
const LENGTH: usize = 12;

/// The references of the last images.
#[derive(Clone, Debug)]
pub(super) struct History(VecDeque<Reference>);

impl History {
    pub(super) fn at_start(reference: &Reference) -> Self {
        Self(VecDeque::from([reference.clone()]))
    }

    pub(super) fn push(&mut self, reference: &Reference) {
        if self.0.len() == LENGTH {
            self.0.pop_front();
        }
        self.0.push_back(reference.clone());
    }

    /// Returns the oldest reference and drops all later ones.
    pub(super) fn restart(&mut self) -> &Reference {
        self.0.truncate(1);
        &self.0[0]
    }
}
