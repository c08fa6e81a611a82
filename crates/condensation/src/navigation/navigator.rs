use rand::Rng;
use wayfix_integrity::CusumTest;

use crate::error::{check_size, checked};
use crate::navigation::report::{NavigationOutcome, NavigationReport};
use crate::{
    ActionSelection, CondensationError, DiscreteStateSpace, MeasurementOutcome, ShortestPathLengths,
    SlipProbabilities, SparseTransition, ViewLocalizer,
};

/// Where a robot moves and takes views: a simulation, or the robot itself.
pub trait NavigationEnvironment<A> {
    /// Does an action, as well as it can.
    fn act(&mut self, action: A);

    /// Writes the features of what is seen now.
    fn observe(&mut self, features: &mut [f64]);
}

/// When a run is over, and how actions are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct NavigatorParams {
    /// Confidence at which the robot stops at the goal.
    pub goal_confidence: f64,
    /// Number of consecutive views with that confidence: one view can be wrong.
    pub n_confirmations: usize,
    /// Most moves of a run.
    pub max_steps: usize,
    /// How actions are chosen.
    pub action_selection: ActionSelection,
    /// How moves go wrong.
    pub slip: SlipProbabilities,
    /// Mean number of false alarms per view of the test for a kidnapped robot.
    pub false_alarms_per_view: f64,
}

impl Default for NavigatorParams {
    /// Stops at 99.9 % in three views, at the latest after 80 moves.
    fn default() -> Self {
        Self {
            goal_confidence: 0.999,
            n_confirmations: 3,
            max_steps: 80,
            action_selection: ActionSelection::Greedy,
            slip: SlipProbabilities::default(),
            false_alarms_per_view: 1e-6,
        }
    }
}

/// The loop of self-localization on the way to a goal. [Kasprzak & Szynkiewicz, Sec. 2.2]
#[derive(Clone, Debug)]
pub struct Navigator<S: DiscreteStateSpace> {
    space: S,
    transitions: Vec<SparseTransition>, // by action
    params: NavigatorParams,
}

impl<S: DiscreteStateSpace> Navigator<S> {
    /// For a space and its moves.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`].
    pub fn new(space: S, params: NavigatorParams) -> Result<Self, CondensationError> {
        let transition = |&action: &S::Action| params.slip.transition(&space, action);
        let transitions = space.actions().iter().map(transition).collect::<Result<_, _>>()?;
        Self::with_transitions(space, transitions, params)
    }

    /// With custom transitions, for example learned from a log of moves: one for every action of the space.
    ///
    /// # Errors
    /// [`CondensationError::Parameter`], or [`CondensationError::Dimension`] when there are more or fewer than actions.
    pub fn with_transitions(
        space: S,
        transitions: Vec<SparseTransition>,
        params: NavigatorParams,
    ) -> Result<Self, CondensationError> {
        check_size("list of transitions", space.actions().len(), transitions.len())?;
        let confidence = params.goal_confidence;
        checked(
            "goal_confidence",
            confidence,
            confidence > 0.0 && confidence < 1.0,
            "between 0 and 1, both excluded",
        )?;
        CusumTest::from_false_alarm_rate(params.false_alarms_per_view)?;
        Ok(Self { space, transitions, params })
    }

    /// The states.
    pub fn space(&self) -> &S {
        &self.space
    }

    /// Drives to `goal`; `watch` gets the localizer after every view.
    ///
    /// # Errors
    /// [`CondensationError::State`] when the goal does not exist, [`CondensationError::Dimension`] when the localizer is of another space,
    /// [`CondensationError::NotFinite`] when the world shows features that are none.
    pub fn run<R: Rng + ?Sized>(
        &self,
        goal: usize,
        localizer: &mut ViewLocalizer,
        world: &mut impl NavigationEnvironment<S::Action>,
        watch: &mut impl FnMut(usize, &ViewLocalizer),
        rng: &mut R,
    ) -> Result<NavigationReport, CondensationError> {
        check_size("localizer", self.space.n_states(), localizer.belief().len())?;
        let routes = ShortestPathLengths::to_goal(&self.space, goal)?;
        let mut monitor = CusumTest::from_false_alarm_rate(self.params.false_alarms_per_view)?;
        let mut features = vec![0.0; localizer.appearance().n_components()];
        let (mut confirmed, mut steps_to_certainty, mut kidnappings) = (0, None, 0);
        let mut steps = 0;
        loop {
            world.observe(&mut features);
            let outcome = localizer.update(&features)?;
            kidnappings +=
                usize::from(start_over_if_elsewhere(&mut monitor, &outcome, localizer, &features)?);
            watch(steps, localizer);

            let best = localizer.best();
            let certain = best.confidence >= self.params.goal_confidence;
            confirmed = if certain { confirmed + 1 } else { 0 };
            if certain {
                steps_to_certainty.get_or_insert(steps);
            }
            let is_confirmed = confirmed >= self.params.n_confirmations.max(1);
            let report = |arrival| NavigationReport { arrival, steps, steps_to_certainty, best, kidnappings };
            if is_confirmed && best.state == goal {
                return Ok(report(NavigationOutcome::Reached));
            }
            if is_confirmed && routes.distance(best.state).is_none() {
                return Ok(report(NavigationOutcome::Unreachable));
            }
            if steps == self.params.max_steps {
                return Ok(report(NavigationOutcome::Unsure));
            }

            let choice = self.params.action_selection.choose(&self.space, &routes, localizer, rng);
            // From where there is no way to the goal any action may show that the robot is elsewhere.
            let action = choice.unwrap_or_else(|| steps % self.transitions.len());
            world.act(self.space.actions()[action]);
            localizer.predict(&self.transitions[action])?;
            steps += 1;
        }
    }
}

/// Forgets place and light when the measurements say that the robot is elsewhere, and begins again with this one.
fn start_over_if_elsewhere(
    monitor: &mut CusumTest,
    outcome: &MeasurementOutcome,
    localizer: &mut ViewLocalizer,
    features: &[f64],
) -> Result<bool, CondensationError> {
    let elsewhere = monitor.observe(outcome.log_likelihood_ratio())?;
    if elsewhere {
        localizer.reset();
        let _ = localizer.update(features)?; // impossible even for a uniform belief: the next view decides
    }
    Ok(elsewhere)
}
