use wayfix_condensation::{CondensationError, DiscreteStateSpace, SparseTransition};

/// Places joined by directed edges: a state space from outside the crate.
#[derive(Clone)]
pub(crate) struct PlaceGraph {
    successors: Vec<Vec<usize>>,
    actions: Vec<usize>,
}

impl PlaceGraph {
    /// `n_states` places and edges `(from, to)`; an action is the number of an edge out of the place.
    pub(crate) fn new(n_states: usize, edges: &[(usize, usize)]) -> Self {
        let mut successors = vec![Vec::new(); n_states];
        for &(from, to) in edges {
            successors[from].push(to);
        }
        let max_degree = successors.iter().map(Vec::len).max().unwrap_or(0);
        Self { successors, actions: (0..max_degree).collect() }
    }

    /// Each place keeps its mass but for `share`, which its edges carry away in equal parts.
    pub(crate) fn diffusion(&self, share: f64) -> Result<SparseTransition, CondensationError> {
        let rows = self.successors.iter().enumerate().map(|(state, next)| {
            let share = if next.is_empty() { 0.0 } else { share };
            let each = share / next.len().max(1) as f64;
            next.iter().map(|&to| (to, each)).chain([(state, 1.0 - share)]).collect::<Vec<_>>()
        });
        SparseTransition::from_rows(rows)
    }
}

impl DiscreteStateSpace for PlaceGraph {
    type Action = usize;

    fn n_states(&self) -> usize {
        self.successors.len()
    }

    fn actions(&self) -> &[usize] {
        &self.actions
    }

    /// Where there is no such edge, the robot stays.
    fn step(&self, state: usize, edge: usize) -> usize {
        self.successors[state].get(edge).copied().unwrap_or(state)
    }
}
