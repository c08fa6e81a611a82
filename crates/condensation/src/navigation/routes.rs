use std::collections::VecDeque;

use crate::error::check_state;
use crate::{CondensationError, DiscreteStateSpace};

/// The number of actions from every state to a goal, if nothing goes wrong.
///
/// ```
/// use wayfix_condensation::{PositionGrid, ShortestPathLengths};
/// let row = PositionGrid::new(3, 1)?;
/// let routes = ShortestPathLengths::to_goal(&row, 1)?;
/// assert_eq!((routes.distance(0), routes.distance(1)), (Some(1), Some(0)));
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShortestPathLengths {
    goal: usize,
    distances: Vec<Option<u32>>,
}

impl ShortestPathLengths {
    /// Breadth first, backwards from the goal.
    ///
    /// # Errors
    /// [`CondensationError::State`] when the goal does not exist.
    pub fn to_goal<S: DiscreteStateSpace>(space: &S, goal: usize) -> Result<Self, CondensationError> {
        check_state(goal, space.n_states())?;
        let mut predecessors = vec![Vec::new(); space.n_states()];
        for state in 0..space.n_states() {
            for &action in space.actions() {
                predecessors[space.step(state, action)].push(state);
            }
        }
        let mut distances = vec![None; space.n_states()];
        distances[goal] = Some(0);
        let mut queue = VecDeque::from([(goal, 0)]);
        while let Some((state, distance)) = queue.pop_front() {
            for &from in &predecessors[state] {
                if distances[from].is_none() {
                    distances[from] = Some(distance + 1);
                    queue.push_back((from, distance + 1));
                }
            }
        }
        Ok(Self { goal, distances })
    }

    /// Where to.
    pub fn goal(&self) -> usize {
        self.goal
    }

    /// Actions from a state to the goal; none when there is no way.
    pub fn distance(&self, state: usize) -> Option<u32> {
        self.distances.get(state).copied().flatten()
    }

    /// The index of the first action that brings a state nearest to the goal, unless there is no way.
    pub(super) fn toward<S: DiscreteStateSpace>(&self, space: &S, state: usize) -> Option<usize> {
        let reach = |(index, &action): (usize, &S::Action)| {
            self.distance(space.step(state, action)).map(|distance| (distance, index))
        };
        space.actions().iter().enumerate().filter_map(reach).min().map(|(_, index)| index)
    }
}
