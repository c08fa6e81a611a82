use std::{cell::Cell, sync::Arc};

use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_condensation::{
    AppearanceModel, DiscreteStateSpace, GridMove, LearnedMotion, NavigationEnvironment, NavigationOutcome,
    NavigationReport, Navigator, PositionGrid, RgbImage, SceneViews, SlipProbabilities, StateDescriptorTable,
    ViewGrid, ViewLocalizer,
};
use wayfix_table_log::MoveTable;

use super::{DescriptorKind, LightNormalization, ViewsError, ViewsParams, logged::learned_motion};

/// Maximum product of places and lights; one update then takes about half a second.
pub(super) const MAX_HYPOTHESES: usize = 500_000;

/// First random stream of failed moves; lower streams are for starts, goals and choices.
const SLIPS: u64 = 1 << 32;

/// Division of a scene into views, and the feature measured in them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ViewSystemConfig {
    /// Width and height of a view, pixels.
    pub view: usize,
    /// Pixels between neighbouring views.
    pub step: usize,
    /// The feature.
    pub feature: DescriptorKind,
    /// Normalization of the light.
    pub normalization: LightNormalization,
}

/// A learned scene, and the same scene as it is now. Only the simulated world of a trial knows the true place.
#[derive(Clone, Debug)]
pub struct ViewSystem {
    views: ViewGrid,
    appearance: Arc<AppearanceModel>,
    learned: StateDescriptorTable,
    seen: StateDescriptorTable,
    feature: DescriptorKind,
    motion: Option<LearnedMotion>,
    navigator: Navigator<PositionGrid>,
    params: ViewsParams,
}

/// One drive from a random place to a random goal.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewTrial {
    /// Number of the drive.
    pub index: u64,
    /// First place.
    pub start: usize,
    /// Goal place.
    pub goal: usize,
    /// Last place.
    pub end: usize,
    /// Report of the navigator.
    pub report: NavigationReport,
    /// Belief in the true place after every update.
    pub belief_in_truth: Vec<f64>,
}

/// The state of a trial after a view.
pub struct ViewTrialStep<'a> {
    /// Moves so far.
    pub number: usize,
    /// True place of the robot.
    pub at: usize,
    /// Goal place.
    pub goal: usize,
    /// The belief.
    pub localizer: &'a ViewLocalizer,
}

impl ViewSystem {
    /// Learns `learned` and computes the features of `real`.
    ///
    /// # Errors
    /// Returns [`ViewsError::Sizes`], [`ViewsError::NoContrast`], [`ViewsError::TooManyStates`], or [`ViewsError::Condensation`] if no view fits
    /// into the scene or a parameter is out of range.
    pub fn learn(
        learned: &RgbImage,
        real: &RgbImage,
        setup: &ViewSystemConfig,
        params: &ViewsParams,
    ) -> Result<Self, ViewsError> {
        let size = |picture: &RgbImage| (picture.width() as usize, picture.height() as usize);
        if size(learned) != size(real) {
            return Err(ViewsError::Sizes { learned: size(learned), real: size(real) });
        }
        for (which, picture) in [("learned scene", learned), ("real scene", real)] {
            let first = picture.pixels().next();
            if picture.pixels().all(|pixel| Some(pixel) == first) {
                return Err(ViewsError::NoContrast { which });
            }
        }
        let views = ViewGrid::new(size(learned), (setup.view, setup.view), setup.step)?;
        let appearance_params = setup.normalization.appearance(params);
        let (n_states, n_conditions) = (views.grid().n_states(), appearance_params.light_changes.len());
        if n_states.saturating_mul(n_conditions) > MAX_HYPOTHESES {
            return Err(ViewsError::TooManyStates { n_states, n_conditions, max: MAX_HYPOTHESES });
        }
        let feature = setup.feature.feature(params.dominant_gray_criterion);
        let source = SceneViews::new(learned, &views)?;
        let appearance = Arc::new(AppearanceModel::learn(&source, &*feature, appearance_params)?);
        ViewLocalizer::new(Arc::clone(&appearance), params.localizer)?; // rejects invalid parameters before the first trial
        let seen = feature.extract_all(&setup.normalization.apply(real, learned)?, &views)?;
        let learned = feature.extract_all(learned, &views)?;
        let navigator = Navigator::new(*views.grid(), params.navigator)?;
        let (feature, motion, params) = (setup.feature, None, params.clone());
        Ok(Self { views, appearance, learned, seen, feature, motion, navigator, params })
    }

    /// The robot assumes that moves slip as they did in a logged drive, and not as `navigator.slip` says. [Kasprzak & Szynkiewicz, Eqs. 3–5]
    ///
    /// # Errors
    /// Returns [`ViewsError::NoMoves`].
    pub fn with_moves(self, moves: &MoveTable) -> Result<Self, ViewsError> {
        let motion = learned_motion(self.views.grid(), moves)?;
        let transitions = motion.transitions().to_vec();
        let navigator = Navigator::with_transitions(*self.views.grid(), transitions, self.params.navigator)?;
        Ok(Self { navigator, motion: Some(motion), ..self })
    }

    /// The grid of views.
    pub fn views(&self) -> &ViewGrid {
        &self.views
    }

    /// The learned appearance.
    pub fn appearance(&self) -> &AppearanceModel {
        &self.appearance
    }

    /// The features of every view of the learned scene.
    pub fn learned(&self) -> &StateDescriptorTable {
        &self.learned
    }

    /// The feature.
    pub fn feature(&self) -> DescriptorKind {
        self.feature
    }

    /// Transitions and diffusion, if they were learned from logged moves.
    pub fn motion(&self) -> Option<&LearnedMotion> {
        self.motion.as_ref()
    }

    /// The features of every view of the real scene.
    pub fn seen(&self) -> &StateDescriptorTable {
        &self.seen
    }

    /// Drives trial number `index`; the seed determines its start, goal and random actions. Calls `watch` after every update.
    ///
    /// # Errors
    /// Returns [`ViewsError::Condensation`].
    pub fn trial(
        &self,
        seed: u64,
        index: u64,
        mut watch: impl FnMut(ViewTrialStep<'_>),
    ) -> Result<ViewTrial, ViewsError> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(index);
        let grid = *self.views.grid();
        let start = rng.random_range(0..grid.n_states());
        let goal = rng.random_range(0..grid.n_states());
        let at = Cell::new(start);
        let mut slips = ChaCha8Rng::seed_from_u64(seed);
        slips.set_stream(SLIPS + index);
        let mut drive =
            Drive { grid, seen: &self.seen, at: &at, slip: self.params.navigator.slip, rng: slips };
        let mut localizer = ViewLocalizer::new(Arc::clone(&self.appearance), self.params.localizer)?;
        let mut belief_in_truth = Vec::new();
        let mut observe = |number: usize, localizer: &ViewLocalizer| {
            belief_in_truth.push(localizer.belief()[at.get()]);
            watch(ViewTrialStep { number, at: at.get(), goal, localizer });
        };
        let report = self.navigator.run(goal, &mut localizer, &mut drive, &mut observe, &mut rng)?;
        Ok(ViewTrial { index, start, goal, end: at.get(), report, belief_in_truth })
    }
}

impl ViewTrial {
    /// Whether the robot reports the goal and is there. An uncertain end is no success.
    pub fn succeeded(&self) -> bool {
        self.report.arrival == NavigationOutcome::Reached && self.end == self.goal
    }

    /// Whether the robot reports the goal and is not there.
    pub(crate) fn is_false_arrival(&self) -> bool {
        self.report.arrival == NavigationOutcome::Reached && self.end != self.goal
    }
}

/// True state of the robot in a trial.
struct Drive<'a> {
    grid: PositionGrid,
    seen: &'a StateDescriptorTable,
    at: &'a Cell<usize>,
    slip: SlipProbabilities,
    rng: ChaCha8Rng,
}

impl NavigationEnvironment<GridMove> for Drive<'_> {
    /// Executes an action; with the model's probabilities nothing happens, or another action.
    fn act(&mut self, action: GridMove) {
        let u: f64 = self.rng.random();
        let done = match u {
            u if u < self.slip.stay_probability => GridMove::STAY,
            u if u < self.slip.stay_probability + self.slip.other_action_probability => {
                GridMove::ALL[self.rng.random_range(0..GridMove::ALL.len())]
            }
            _ => action,
        };
        self.at.set(self.grid.step(self.at.get(), done));
    }

    fn observe(&mut self, features: &mut [f64]) {
        if let Some(row) = self.seen.get(self.at.get()) {
            features.copy_from_slice(row);
        }
    }
}
