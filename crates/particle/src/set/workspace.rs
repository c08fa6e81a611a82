use crate::NormalizedWeights;

/// Memory that a set of particles uses again and again: fresh memory costs more time than resampling itself.
///
/// Not part of the set's value: a clone starts without, and all are equal.
#[derive(Debug)]
pub(super) struct Workspace<X> {
    /// Empty between calls, so that no dead particle keeps what it shares alive.
    pub(super) states: Vec<X>,
    pub(super) log_weights: Vec<f64>,
    pub(super) weights: NormalizedWeights,
    pub(super) ancestors: Vec<usize>,
}

impl<X> Default for Workspace<X> {
    fn default() -> Self {
        Self {
            states: vec![],
            log_weights: vec![],
            weights: NormalizedWeights::placeholder(),
            ancestors: vec![],
        }
    }
}

impl<X> Clone for Workspace<X> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<X> PartialEq for Workspace<X> {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}
