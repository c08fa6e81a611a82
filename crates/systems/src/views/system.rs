use std::{cell::Cell, sync::Arc};

use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_condensation::{
    Appearance, Arrival, FeatureTable, Grid, Localizer, Move, Navigator, Picture, RunReport, SceneViews,
    Slip, StateSpace, ViewGrid, World,
};

use super::{FeatureKind, Normalization, ViewsError, ViewsParams};

/// Places times lights of which a look takes about half a second.
const MAX_HYPOTHESES: usize = 500_000;

/// Streams of a seed from here on are of moves that go wrong, those below of starts, goals and choices.
const SLIPS: u64 = 1 << 32;

/// How a scene is divided into views, and what is measured of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Width and height of a view, pixels.
    pub view: usize,
    /// Pixels between neighbouring views.
    pub step: usize,
    /// What is measured.
    pub feature: FeatureKind,
    /// How light is made that of learning.
    pub normalization: Normalization,
}

/// A scene that was learned, and the same scene as it is seen now. Only the world of a trial knows where the robot is.
#[derive(Clone, Debug)]
pub struct ViewSystem {
    views: ViewGrid,
    appearance: Arc<Appearance>,
    seen: FeatureTable,
    navigator: Navigator<Grid>,
    params: ViewsParams,
}

/// One drive from a random place to a random goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Trial {
    /// Where it began.
    pub start: usize,
    /// Where it should end.
    pub goal: usize,
    /// Where it ended.
    pub end: usize,
    /// What the robot thinks.
    pub report: RunReport,
    /// Belief in the true place after every look.
    pub belief_in_truth: Vec<f64>,
}

/// The state of a trial after a view.
pub struct Step<'a> {
    /// Moves so far.
    pub number: usize,
    /// Where the robot is.
    pub at: usize,
    /// Where it wants to go.
    pub goal: usize,
    /// The belief.
    pub localizer: &'a Localizer,
}

impl ViewSystem {
    /// Learns `learned` and looks at `real`.
    ///
    /// # Errors
    /// [`ViewsError::Sizes`], [`ViewsError::NoContrast`], [`ViewsError::TooManyStates`]; [`ViewsError::Condensation`] when no view fits into the
    /// scene or a parameter is out of its range.
    pub fn learn(
        learned: &Picture,
        real: &Picture,
        setup: &Setup,
        params: &ViewsParams,
    ) -> Result<Self, ViewsError> {
        let size = |picture: &Picture| (picture.width(), picture.height());
        if size(learned) != size(real) {
            return Err(ViewsError::Sizes { learned: size(learned), real: size(real) });
        }
        for (which, picture) in [("learned scene", learned), ("real scene", real)] {
            let first = picture.pixels()[0];
            if picture.pixels().iter().all(|pixel| *pixel == first) {
                return Err(ViewsError::NoContrast { which });
            }
        }
        let views = ViewGrid::new(size(learned), (setup.view, setup.view), setup.step)?;
        let appearance_params = setup.normalization.appearance(params);
        let (n_states, n_conditions) = (views.grid().n_states(), appearance_params.lights.len());
        if n_states.saturating_mul(n_conditions) > MAX_HYPOTHESES {
            return Err(ViewsError::TooManyStates { n_states, n_conditions, max: MAX_HYPOTHESES });
        }
        let feature = setup.feature.feature(params.dominance);
        let source = SceneViews::new(learned, &views)?;
        let appearance = Arc::new(Appearance::learn(&source, &*feature, appearance_params)?);
        Localizer::new(Arc::clone(&appearance), params.localizer)?; // refuses bad parameters now, not in the first trial
        let seen = feature.extract_all(&setup.normalization.apply(real, learned)?, &views)?;
        let navigator = Navigator::new(*views.grid(), params.navigator)?;
        Ok(Self { views, appearance, seen, navigator, params: params.clone() })
    }

    /// The views.
    pub fn views(&self) -> &ViewGrid {
        &self.views
    }

    /// What was learned.
    pub fn appearance(&self) -> &Appearance {
        &self.appearance
    }

    /// The features of every view as it is now.
    pub fn seen(&self) -> &FeatureTable {
        &self.seen
    }

    /// Drives trial number `index`, whose start, goal and random actions the seed decides; `watch` is shown every look.
    ///
    /// # Errors
    /// [`ViewsError::Condensation`].
    pub fn trial(&self, seed: u64, index: u64, mut watch: impl FnMut(Step<'_>)) -> Result<Trial, ViewsError> {
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
        let mut localizer = Localizer::new(Arc::clone(&self.appearance), self.params.localizer)?;
        let mut belief_in_truth = Vec::new();
        let mut observe = |number: usize, localizer: &Localizer| {
            belief_in_truth.push(localizer.belief()[at.get()]);
            watch(Step { number, at: at.get(), goal, localizer });
        };
        let report = self.navigator.run(goal, &mut localizer, &mut drive, &mut observe, &mut rng)?;
        Ok(Trial { start, goal, end: at.get(), report, belief_in_truth })
    }
}

impl Trial {
    /// Whether the robot says that it is at the goal, and is. Unsure is no success.
    pub fn succeeded(&self) -> bool {
        self.report.arrival == Arrival::Reached && self.end == self.goal
    }

    /// Whether the robot says that it is at the goal, and is not.
    pub fn is_false_arrival(&self) -> bool {
        self.report.arrival == Arrival::Reached && self.end != self.goal
    }
}

/// The robot as it really is.
struct Drive<'a> {
    grid: Grid,
    seen: &'a FeatureTable,
    at: &'a Cell<usize>,
    slip: Slip,
    rng: ChaCha8Rng,
}

impl World<Move> for Drive<'_> {
    /// As often as the model says nothing happens, or another action.
    fn act(&mut self, action: Move) {
        let u: f64 = self.rng.random();
        let done = match u {
            u if u < self.slip.stay_probability => Move::STAY,
            u if u < self.slip.stay_probability + self.slip.other_action_probability => {
                Move::ALL[self.rng.random_range(0..Move::ALL.len())]
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
