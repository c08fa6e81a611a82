use std::collections::BTreeMap;

use crate::error::{check_state, checked};
use crate::{CondensationError, DiscreteStateSpace, SparseTransition};

/// Counts of the end states of moves, from which transition probabilities are learned. [Kasprzak & Szynkiewicz, Sec. 2.2]
///
/// ```
/// use wayfix_condensation::{PositionGrid, GridMove, TransitionCounts, TransitionModel};
/// let grid = PositionGrid::new(3, 1)?;
/// let right = GridMove { dx: 1, dy: 0 };
/// let mut log = TransitionCounts::new(&grid);
/// for to in [1, 1, 0, 1] {
///     log.record(0, right, to)?;
/// }
/// let learned = log.transition(right, 1e-9)?;
/// let mut predicted = [0.0; 3];
/// learned.predict(&[1.0, 0.0, 0.0], &mut predicted);
/// assert!((predicted[1] - 0.75).abs() < 1e-6);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct TransitionCounts<'a, S: DiscreteStateSpace> {
    space: &'a S,
    counts: Vec<BTreeMap<(usize, usize), u32>>, // by action: from, to
}

impl<'a, S: DiscreteStateSpace> TransitionCounts<'a, S>
where
    S::Action: PartialEq,
{
    /// Nothing moved yet.
    pub fn new(space: &'a S) -> Self {
        Self { space, counts: vec![BTreeMap::new(); space.actions().len()] }
    }

    /// Counts one move.
    ///
    /// # Errors
    /// [`CondensationError::State`], or [`CondensationError::Empty`] for an action that the space does not know.
    pub fn record(&mut self, from: usize, action: S::Action, to: usize) -> Result<(), CondensationError> {
        check_state(from, self.space.n_states())?;
        check_state(to, self.space.n_states())?;
        let action = self.index(action)?;
        *self.counts[action].entry((from, to)).or_default() += 1;
        Ok(())
    }

    /// $`p(s' \mid s, a)`$: the counted shares, beside `strength` moves that end in the intended state.
    ///
    /// A Dirichlet prior, so that a state never left still has a row.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when `strength` is not positive, [`CondensationError::Empty`] for an unknown action.
    pub fn transition(
        &self,
        action: S::Action,
        strength: f64,
    ) -> Result<SparseTransition, CondensationError> {
        checked(
            "strength of the prior",
            strength,
            strength.is_finite() && strength > 0.0,
            "finite and positive",
        )?;
        let counts = &self.counts[self.index(action)?];
        let rows = (0..self.space.n_states()).map(|from| {
            let seen =
                || counts.range((from, 0)..=(from, usize::MAX)).map(|(&(_, to), &n)| (to, f64::from(n)));
            let total = strength + seen().map(|(_, n)| n).sum::<f64>();
            let expected = (self.space.step(from, action), strength / total);
            seen().map(|(to, n)| (to, n / total)).chain([expected]).collect::<Vec<_>>()
        });
        SparseTransition::from_rows(rows)
    }

    fn index(&self, action: S::Action) -> Result<usize, CondensationError> {
        let found = self.space.actions().iter().position(|known| *known == action);
        found.ok_or(CondensationError::Empty { what: "such action" })
    }
}
