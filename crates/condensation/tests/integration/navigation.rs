//! The loop as a whole, on a painted scene.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::sync::Arc;
use wayfix_condensation::{
    ActionSelection, AppearanceLearningParams, AppearanceModel, ColorMeanStdDescriptor, DiscreteStateSpace,
    DominantGraysDescriptor, Fft6Descriptor, GlobalDescriptor, LightChange, NavigationEnvironment,
    NavigationOutcome, NavigationReport, Navigator, NavigatorParams, RgbImage, SceneViews,
    ShortestPathLengths, StateDescriptorTable, ViewGrid, ViewLocalizer, ViewLocalizerParams, light_match,
    mapped, shifted,
};

use crate::common::{Drive, place_graph::PlaceGraph, scene};

struct Trial {
    views: ViewGrid,
    appearance: Arc<AppearanceModel>,
    seen: StateDescriptorTable,
}

impl Trial {
    fn new(
        feature: &dyn GlobalDescriptor,
        learned: &RgbImage,
        real: &RgbImage,
        params: &AppearanceLearningParams,
    ) -> Self {
        let views =
            ViewGrid::new((learned.width() as usize, learned.height() as usize), (64, 64), 16).unwrap();
        let source = SceneViews::new(learned, &views).unwrap();
        let appearance = Arc::new(AppearanceModel::learn(&source, feature, params).unwrap());
        Self { seen: feature.extract_all(real, &views).unwrap(), appearance, views }
    }

    fn run(
        &self,
        seed: u64,
        choice: ActionSelection,
        kidnapped: Option<(usize, usize)>,
    ) -> (NavigationReport, usize, ViewLocalizer) {
        let grid = *self.views.grid();
        let navigator =
            Navigator::new(grid, NavigatorParams { action_selection: choice, ..NavigatorParams::default() })
                .unwrap();
        let mut localizer =
            ViewLocalizer::new(self.appearance.clone(), ViewLocalizerParams::default()).unwrap();
        let start = (seed as usize * 37) % grid.n_states();
        let goal = (seed as usize * 53 + 11) % grid.n_states();
        let mut drive = Drive { grid, seen: self.seen.clone(), at: start, kidnapped, looks: 0 };
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let report = navigator.run(goal, &mut localizer, &mut drive, &mut |_, _| {}, &mut rng).unwrap();
        (report, drive.at.abs_diff(goal), localizer)
    }
}

const OTHER_LIGHT: LightChange = LightChange { gain: 0.7, offset: 20.0, gamma: 1.3 };

/// The goal, 100 of 100, on 20 runs a feature and mode: each of them must end at the true goal by the robot's own decision.
#[test]
fn every_feature_reaches_every_goal_in_another_light() {
    let learned = scene(240, 176, 3);
    let real = shifted(&OTHER_LIGHT.apply(&learned).unwrap(), 4, 3);
    let light = light_match(&real, &learned).unwrap();
    let matched = mapped(&real, &[light.inverse_table().unwrap(); 3]);
    let features: [&dyn GlobalDescriptor; 3] =
        [&ColorMeanStdDescriptor, &Fft6Descriptor, &DominantGraysDescriptor::default()];
    for (number, feature) in features.into_iter().enumerate() {
        let modes =
            [(&matched, AppearanceLearningParams::normalized()), (&real, AppearanceLearningParams::online())];
        for (scene, params) in modes {
            let trial = Trial::new(feature, &learned, scene, &params);
            for seed in 0..20 {
                let (report, off, _) = trial.run(seed, ActionSelection::Greedy, None);
                assert_eq!(
                    (report.arrival, off),
                    (NavigationOutcome::Reached, 0),
                    "feature {number}, run {seed}: {report:?}"
                );
            }
        }
    }
}

/// From no knowledge to the light that the scene was made with. The conditions start at gains of 0.6 and 0.85 and an offset of 0, so that
/// a gain within 8 % and an offset within 8 levels were told by the views.
#[test]
fn light_is_found_together_with_the_place() {
    let learned = scene(240, 176, 3);
    let trial = Trial::new(
        &ColorMeanStdDescriptor,
        &learned,
        &OTHER_LIGHT.apply(&learned).unwrap(),
        &AppearanceLearningParams::online(),
    );
    for seed in 0..5 {
        let (light, _) = trial.run(seed, ActionSelection::Greedy, None).2.disturbance();
        assert!(
            abs_diff_eq!(light.gain / 0.7, 1.0, epsilon = 0.08)
                && abs_diff_eq!(light.offset, 20.0, epsilon = 8.0),
            "run {seed}: {light:?}"
        );
    }
}

#[test]
fn informed_choice_arrives_too() {
    let learned = scene(240, 176, 3);
    let trial = Trial::new(
        &Fft6Descriptor,
        &learned,
        &shifted(&learned, -3, 4),
        &AppearanceLearningParams::normalized(),
    );
    for seed in 0..10 {
        let (report, off, _) = trial.run(seed, ActionSelection::Informed { hypotheses: 8 }, None);
        assert_eq!((report.arrival, off), (NavigationOutcome::Reached, 0), "run {seed}");
    }
}

#[test]
fn a_kidnapped_robot_notices_and_still_arrives() {
    let learned = scene(240, 176, 3);
    let trial =
        Trial::new(&ColorMeanStdDescriptor, &learned, &learned, &AppearanceLearningParams::normalized());
    let n = trial.views.grid().n_states();
    for seed in [1, 4, 7] {
        // Put far away at the third look, when it has long been sure.
        let away = ((seed as usize * 37) % n + n / 2) % n;
        let (report, off, _) = trial.run(seed, ActionSelection::Greedy, Some((3, away)));
        assert_eq!((report.arrival, off), (NavigationOutcome::Reached, 0), "run {seed}: {report:?}");
    }
}

/// Everything looks the same: the run ends after its steps, unsure, with finite beliefs.
#[test]
fn a_constant_scene_ends_unsure() {
    let grey = RgbImage::from_pixel(240, 176, [90; 3].into());
    let trial = Trial::new(&ColorMeanStdDescriptor, &grey, &grey, &AppearanceLearningParams::normalized());
    let (report, _, localizer) = trial.run(2, ActionSelection::Greedy, None);
    assert_eq!(
        (report.arrival, report.steps),
        (NavigationOutcome::Unsure, NavigatorParams::default().max_steps)
    );
    assert!(localizer.belief().iter().all(|p| p.is_finite()));
    assert_abs_diff_eq!(localizer.belief().iter().sum::<f64>(), 1.0, epsilon = 1e-9);
}

struct Walk {
    graph: PlaceGraph,
    at: usize,
}

impl NavigationEnvironment<usize> for Walk {
    fn act(&mut self, edge: usize) {
        self.at = self.graph.step(self.at, edge);
    }

    fn observe(&mut self, features: &mut [f64]) {
        features[0] = 10.0 * self.at as f64;
    }
}

#[test]
fn a_goal_without_a_way_is_unreachable() {
    let one_way = PlaceGraph::new(3, &[(0, 1), (1, 2)]);
    let routes = ShortestPathLengths::to_goal(&one_way, 1).unwrap();
    assert_eq!((routes.distance(0), routes.distance(2)), (Some(1), None));
    let graph = PlaceGraph::new(4, &[(0, 1), (1, 0), (2, 3), (3, 2)]);
    let places: Vec<Vec<f64>> = (0..4).map(|state| vec![10.0 * f64::from(state)]).collect();
    let appearance = Arc::new(
        AppearanceModel::from_spread(StateDescriptorTable::from_rows(&places).unwrap(), 0.1).unwrap(),
    );
    let navigator = Navigator::new(graph.clone(), NavigatorParams::default()).unwrap();
    let mut localizer = ViewLocalizer::new(appearance, ViewLocalizerParams::default()).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut walk = Walk { graph, at: 0 };
    let report = navigator.run(3, &mut localizer, &mut walk, &mut |_, _| {}, &mut rng).unwrap();
    assert_eq!(report.arrival, NavigationOutcome::Unreachable);
    assert!(navigator.run(9, &mut localizer, &mut walk, &mut |_, _| {}, &mut rng).is_err());
}
