use crate::MostProbableState;

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum NavigationOutcome {
    /// The robot is at the goal with the stated confidence.
    Reached,
    /// The steps are used up, and the belief in the goal is below the stated confidence.
    Unsure,
    /// With the stated confidence it is where no way leads to the goal.
    Unreachable,
}

/// What happened in a run. Whether the robot really is at the goal only its surroundings know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavigationReport {
    /// How it ended.
    pub arrival: NavigationOutcome,
    /// Moves that were made.
    pub steps: usize,
    /// Moves until the confidence first reached the value in the parameters, if it did.
    pub steps_to_certainty: Option<usize>,
    /// The most probable place at the end, with its probability.
    pub best: MostProbableState,
    /// Number of detected kidnappings, each with a new start.
    pub kidnappings: usize,
}
