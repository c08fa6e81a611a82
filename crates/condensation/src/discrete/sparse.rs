use crate::discrete::chunks::{CHUNK, map_chunks};
use crate::discrete::dense::check_row;
use crate::error::check_state;
use crate::{CondensationError, TransitionModel};

/// The probabilities that are not zero, stored by where they lead, so that every state gathers what reaches it.
///
/// ```
/// use wayfix_condensation::{SparseTransition, TransitionModel};
/// let around = SparseTransition::from_rows([vec![(1, 1.0)], vec![(2, 1.0)], vec![(0, 0.5), (2, 0.5)]])?;
/// let mut predicted = [0.0; 3];
/// around.predict(&[0.0, 0.0, 1.0], &mut predicted);
/// assert_eq!(predicted, [0.5, 0.0, 0.5]);
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SparseTransition {
    starts: Vec<usize>, // of each target's entries, and one past the last
    entries: Vec<(u32, f64)>,
}

impl SparseTransition {
    /// From rows of `(target, probability)`, one a state. A target may come twice; its probabilities add.
    ///
    /// # Errors
    /// [`CondensationError::Empty`], [`CondensationError::State`], [`CondensationError::Parameter`] for an entry that is no
    /// probability, or [`CondensationError::RowSum`].
    pub fn from_rows(
        rows: impl IntoIterator<Item = impl IntoIterator<Item = (usize, f64)>>,
    ) -> Result<Self, CondensationError> {
        let mut triples = Vec::new(); // target, source, probability
        let mut n_states = 0;
        for (source, row) in rows.into_iter().enumerate() {
            let begin = triples.len();
            triples.extend(row.into_iter().map(|(target, p)| (target, source, p)));
            check_row(source, triples[begin..].iter().map(|triple| triple.2))?;
            n_states += 1;
        }
        crate::discrete::lattice::n_cells("transition", &[n_states])?;
        let mut starts = vec![0; n_states + 1];
        for &(target, _, _) in &triples {
            check_state(target, n_states)?;
            starts[target + 1] += 1;
        }
        for target in 0..n_states {
            starts[target + 1] += starts[target];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0, 0.0); triples.len()];
        for (target, source, p) in triples {
            entries[next[target]] = (source as u32, p);
            next[target] += 1;
        }
        Ok(Self { starts, entries })
    }

    /// `(source, probability)` of everything that leads to `target`.
    pub fn into_state(&self, target: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = match (self.starts.get(target), self.starts.get(target + 1)) {
            (Some(&start), Some(&end)) => start..end,
            _ => 0..0,
        };
        self.entries[range].iter().map(|&(source, p)| (source as usize, p))
    }
}

impl TransitionModel for SparseTransition {
    fn n_states(&self) -> usize {
        self.starts.len() - 1
    }

    fn predict(&self, belief: &[f64], predicted: &mut [f64]) {
        map_chunks(predicted, CHUNK, |first, chunk| {
            for (target, to) in chunk.iter_mut().enumerate().map(|(i, to)| (first + i, to)) {
                let entries = &self.entries[self.starts[target]..self.starts[target + 1]];
                *to = entries.iter().map(|&(source, p)| belief[source as usize] * p).sum();
            }
        });
    }
}
