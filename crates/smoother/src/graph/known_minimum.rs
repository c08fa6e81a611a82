use std::collections::BTreeSet;

use crate::optimize::NOTHING_TO_GAIN;

/// The values are a minimum of the cost. Every variable has a residual, except those of [`without_residual`](Self::without_residual).
///
/// A residual that is zero at the values changes neither the cost nor its gradient there. So a minimum stays one when such residuals are added, as when a
/// pose is added where odometry has it.
pub(crate) struct KnownMinimum {
    pub(crate) cost: f64,
    /// The predicted decrease is below this share of the cost.
    pub(crate) relative_decrease: f64,
    /// Cost of the residuals added since: as much could be gained.
    added: f64,
    /// Numbers of variables added since.
    without_residual: BTreeSet<usize>,
}

impl KnownMinimum {
    pub(crate) fn new(cost: f64, relative_decrease: f64) -> Self {
        Self { cost, relative_decrease, added: 0.0, without_residual: BTreeSet::new() }
    }

    /// Whether every variable has a residual.
    pub(crate) fn is_complete(&self) -> bool {
        self.without_residual.is_empty()
    }

    /// With a further variable.
    pub(super) fn with_variable(mut self, index: usize) -> Self {
        self.without_residual.insert(index);
        self
    }

    /// With a further residual of this cost; `None` if the minimum moves.
    pub(super) fn with_cost(mut self, cost: f64) -> Option<Self> {
        self.added += cost;
        self.cost += cost;
        (self.added <= NOTHING_TO_GAIN).then_some(self)
    }

    /// Takes those of some variables that have no residual yet: they get one.
    pub(super) fn take_without_residual(&mut self, named: &[usize]) -> Vec<usize> {
        named.iter().copied().filter(|index| self.without_residual.remove(index)).collect()
    }
}
