use crate::discrete::lattice::n_cells;
use crate::error::check_state;
use crate::{CondensationError, DiscreteStateSpace, SparseTransition};

/// An action in a graph: take the edge of that number out of the place, or stay.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PlaceGraphMove {
    /// The k-th edge that leaves the place, counted in the order they were given; where there is none, the robot stays.
    Edge(usize),
    /// Nothing.
    Stay,
}

/// Places joined by directed edges.
///
/// ```
/// use wayfix_condensation::{PlaceGraphMove, PlaceGraph, DiscreteStateSpace};
/// let corridor = PlaceGraph::new(3, &[(0, 1), (1, 2), (1, 0)])?;
/// assert_eq!(corridor.step(1, PlaceGraphMove::Edge(1)), 0);
/// assert_eq!(corridor.step(2, PlaceGraphMove::Edge(0)), 2); // a dead end
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlaceGraph {
    successors: Vec<Vec<usize>>,
    actions: Vec<PlaceGraphMove>,
}

impl PlaceGraph {
    /// `n_states` places and edges `(from, to)`.
    ///
    /// # Errors
    /// [`CondensationError::Extent`] without places, [`CondensationError::State`] when an edge names one that does not exist.
    pub fn new(n_states: usize, edges: &[(usize, usize)]) -> Result<Self, CondensationError> {
        n_cells("graph", &[n_states])?;
        let mut successors = vec![Vec::new(); n_states];
        for &(from, to) in edges {
            check_state(from, n_states)?;
            check_state(to, n_states)?;
            successors[from].push(to);
        }
        let max_degree = successors.iter().map(Vec::len).max().unwrap_or(0);
        let actions = (0..max_degree).map(PlaceGraphMove::Edge).chain([PlaceGraphMove::Stay]).collect();
        Ok(Self { successors, actions })
    }

    /// Where the edges out of a place lead.
    pub fn successors(&self, state: usize) -> &[usize] {
        self.successors.get(state).map_or(&[], Vec::as_slice)
    }

    /// Diffusion over the edges: each place keeps its mass but for `share`, which its edges carry away in equal parts.
    ///
    /// A place without edges keeps all of it, so belief stays a distribution.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when `share` is no probability.
    pub fn diffusion(&self, share: f64) -> Result<SparseTransition, CondensationError> {
        let share = crate::error::probability("share that diffuses", share)?;
        let rows = self.successors.iter().enumerate().map(|(state, next)| {
            if next.is_empty() {
                return vec![(state, 1.0)];
            }
            let each = share / next.len() as f64;
            next.iter().map(|&to| (to, each)).chain([(state, 1.0 - share)]).collect()
        });
        SparseTransition::from_rows(rows)
    }
}

impl DiscreteStateSpace for PlaceGraph {
    type Action = PlaceGraphMove;

    fn n_states(&self) -> usize {
        self.successors.len()
    }

    fn actions(&self) -> &[PlaceGraphMove] {
        &self.actions
    }

    fn step(&self, state: usize, action: PlaceGraphMove) -> usize {
        match action {
            PlaceGraphMove::Edge(edge) => self.successors[state].get(edge).copied().unwrap_or(state),
            PlaceGraphMove::Stay => state,
        }
    }
}
