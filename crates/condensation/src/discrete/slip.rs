use crate::error::probability;
use crate::{CondensationError, DiscreteStateSpace, SparseTransition};

/// How moves go wrong: with these probabilities the robot stays where it is, or does one of the other actions instead.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct SlipProbabilities {
    /// That nothing happens.
    pub stay_probability: f64,
    /// That another action happens, each of them equally likely.
    pub other_action_probability: f64,
}

impl SlipProbabilities {
    /// $`p(s' \mid s, a)`$ of an action in a space. [Kasprzak & Szynkiewicz, Sec. 2.2]
    ///
    /// ```
    /// use wayfix_condensation::{PositionGrid, GridMove, SlipProbabilities, TransitionModel};
    /// let grid = PositionGrid::new(3, 1)?;
    /// let right = SlipProbabilities { stay_probability: 0.25, other_action_probability: 0.0 }.transition(&grid, GridMove { dx: 1, dy: 0 })?;
    /// let mut predicted = [0.0; 3];
    /// right.predict(&[1.0, 0.0, 0.0], &mut predicted);
    /// assert_eq!(predicted, [0.25, 0.75, 0.0]);
    /// # Ok::<(), wayfix_condensation::CondensationError>(())
    /// ```
    ///
    /// # Errors
    /// [`CondensationError::Parameter`] when the probabilities are none, or exceed one together.
    pub fn transition<S: DiscreteStateSpace>(
        &self,
        space: &S,
        action: S::Action,
    ) -> Result<SparseTransition, CondensationError> {
        probability("probability to stay", self.stay_probability)?;
        probability("probability to stray", self.other_action_probability)?;
        let goes = probability(
            "probability of the intended action",
            1.0 - self.stay_probability - self.other_action_probability,
        )?;
        let each = self.other_action_probability / space.actions().len() as f64;
        let rows = (0..space.n_states()).map(|state| {
            let mut row = vec![(space.step(state, action), goes)];
            if self.stay_probability > 0.0 {
                row.push((state, self.stay_probability));
            }
            if self.other_action_probability > 0.0 {
                row.extend(space.actions().iter().map(|&other| (space.step(state, other), each)));
            }
            row
        });
        SparseTransition::from_rows(rows)
    }
}
