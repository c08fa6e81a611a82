use crate::error::check_size;
use crate::{CondensationError, TransitionModel};

/// How far from one the sum of a row may be: rounding of a few thousand terms stays far below.
pub(crate) const ROW_TOLERANCE: f64 = 1e-9;

/// Every probability written out, for small spaces and as the reference that the others are tested against.
///
/// ```
/// use wayfix_condensation::{DenseTransition, TransitionModel};
/// let to_the_right = DenseTransition::from_rows(&[vec![0.1, 0.9], vec![0.0, 1.0]])?;
/// let mut predicted = [0.0; 2];
/// to_the_right.predict(&[1.0, 0.0], &mut predicted);
/// assert_eq!(predicted, [0.1, 0.9]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DenseTransition {
    n_states: usize,
    rows: Vec<f64>, // p(to | from) at from · n + to
}

impl DenseTransition {
    /// From rows $`p(\cdot \mid s)`$, one a state.
    ///
    /// # Errors
    /// [`CondensationError::Empty`], [`CondensationError::Dimension`], [`CondensationError::Parameter`] for an entry that is no
    /// probability, or [`CondensationError::RowSum`].
    pub fn from_rows(rows: &[Vec<f64>]) -> Result<Self, CondensationError> {
        if rows.is_empty() {
            return Err(CondensationError::Empty { what: "states" });
        }
        for (state, row) in rows.iter().enumerate() {
            check_size("row of a transition", rows.len(), row.len())?;
            check_row(state, row.iter().copied())?;
        }
        Ok(Self { n_states: rows.len(), rows: rows.concat() })
    }
}

impl TransitionModel for DenseTransition {
    fn n_states(&self) -> usize {
        self.n_states
    }

    fn predict(&self, belief: &[f64], predicted: &mut [f64]) {
        predicted.fill(0.0);
        for (row, mass) in self.rows.chunks_exact(self.n_states).zip(belief) {
            for (to, p) in predicted.iter_mut().zip(row) {
                *to += mass * p;
            }
        }
    }
}

/// Whether a row holds probabilities that sum to one.
pub(crate) fn check_row(state: usize, row: impl Iterator<Item = f64>) -> Result<(), CondensationError> {
    let mut sum = 0.0;
    for p in row {
        sum += crate::error::probability("transition probability", p)?;
    }
    if (sum - 1.0).abs() <= ROW_TOLERANCE { Ok(()) } else { Err(CondensationError::RowSum { state, sum }) }
}
