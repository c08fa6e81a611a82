use std::collections::VecDeque;

use super::reference::Reference;

/// Pictures between something that covers the target and the loss of it, half a second: what was learned meanwhile is not to be trusted.
const LENGTH: usize = 12;

/// How the target looked in the last pictures.
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

    /// The oldest, of which nothing that followed is left.
    pub(super) fn restart(&mut self) -> &Reference {
        self.0.truncate(1);
        &self.0[0]
    }
}
