//! The learning rules against numbers worked out by hand.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::Vector3;
use wayfix_appearance_cml::{
    AppearanceMap, AppearanceMapParams, ForgettingMode, ForgettingUncertainty, PlaceUpdateRule,
    ViewDescriptor, ViewDifference, ViewDifferenceSample, similarity,
};
use wayfix_estimation_traits::Pose2;
use wayfix_gaussian_core::Gaussian;

/// A view that is one number.
#[derive(Clone, Debug)]
struct Tone(f64);

impl ViewDescriptor for Tone {
    fn compare(&self, reference: &Self) -> ViewDifference {
        ViewDifference { distance: (self.0 - reference.0).abs(), rotation: 0.0 }
    }
}

const SIGMA: f64 = 0.1;

fn at(x: f64) -> Gaussian<Pose2<f64>> {
    Gaussian::from_sigmas(Pose2::new(x, 0.0, 0.0), &Vector3::new(SIGMA, SIGMA, SIGMA)).expect("positive")
}

/// Gate of Eqs. 12 and 15-17.
const GATE: f64 = 7.8;

/// The published rules with round numbers.
fn published() -> AppearanceMapParams {
    // A quarter of the way from a nugget of 0 to the sill at twice the difference of successive views, both in squares: E^max = 1.
    AppearanceMapParams {
        max_match_difference_share: 0.25,
        weight_learning_rate: 0.5,
        min_weight: 0.01,
        forgetting_rate: 0.4,
        ..AppearanceMapParams::as_published()
    }
}

/// A map whose views change by 1 over 1 m: match radius 1 m, d^gain = 2 m.
fn empty_map() -> AppearanceMap<Tone> {
    let mut map = AppearanceMap::default();
    map.scale_mut().add_near(ViewDifferenceSample { lag: 1.0, distance: 1.0 });
    map
}

fn map_of(views: &[(f64, f64)], params: &AppearanceMapParams) -> AppearanceMap<Tone> {
    let mut map = empty_map();
    for (tone, x) in views {
        map.learn(Tone(*tone), &at(*x), params, GATE).expect("a good pose");
    }
    map
}

fn weights(map: &AppearanceMap<Tone>) -> Vec<Vec<f64>> {
    map.references().values().map(|r| r.places.iter().map(|p| p.weight).collect()).collect()
}

#[test]
fn what_is_seen_again_gains_weight_and_counts() {
    let map = map_of(&[(0.0, 5.0), (0.0, 5.0)], &published());
    // Eq. 16 with S = 1 from 0: 0.5, then 0.5 + 0.5 · 0.5.
    assert_eq!(weights(&map), [[0.75]]);
    let place = &map.references().values().next().unwrap().places[0];
    // Eq. 11 gives each observation the whole share, and counts add.
    assert_eq!(place.count, 2.0);
    // Eq. 13 with normalized counts: the mean of two equal poses is that pose, not its double.
    assert_abs_diff_eq!(place.gaussian.mean().x(), 5.0, epsilon = 1e-12);
}

#[test]
fn counts_weigh_the_poses() {
    let map = map_of(&[(0.0, 0.0), (0.0, 0.0), (0.0, 0.0), (0.0, 0.2)], &published());
    let place = &map.references().values().next().unwrap().places[0];
    assert_abs_diff_eq!(place.gaussian.mean().x(), 0.05, epsilon = 1e-12);
    // Eq. 14: σ² + ¾·0.05² + ¼·0.15².
    let variance = SIGMA * SIGMA + 0.75 * 0.0025 + 0.25 * 0.0225;
    assert_abs_diff_eq!(place.gaussian.covariance()[(0, 0)], variance, epsilon = 1e-12);
}

#[test]
fn a_view_seen_elsewhere_fades_where_it_was() {
    let map = map_of(&[(0.0, 0.0), (0.0, 5.0)], &published());
    // Eq. 17 with S = 1: 0.5 · 0.5. The new place comes by Eq. 16 from 0.
    assert_eq!(weights(&map), [[0.25, 0.5]]);
}

#[test]
fn half_a_likeness_teaches_half() {
    let map = map_of(&[(0.0, 0.0), (0.6, 0.0)], &published());
    let gain = 0.5 * similarity(0.6, 1.0);
    assert_eq!(map.len(), 1, "a view within the limit is no reference");
    assert_abs_diff_eq!(weights(&map)[0][0], gain + (1.0 - gain) * 0.5, epsilon = 1e-12);
}

#[test]
fn missing_view_is_forgotten_only_actively() {
    let active = map_of(&[(0.0, 0.0), (3.0, 0.5)], &published());
    // Eqs. 18-19: b = 0.4 · (1 − 1/2) · 2/(0.1 + 0.1) is 2, clamped to 1: the published rate is not capped.
    assert_eq!(active.len(), 1);
    let slow = AppearanceMapParams { forgetting_rate: 0.04, ..published() };
    let active = map_of(&[(0.0, 0.0), (3.0, 0.5)], &slow);
    assert_abs_diff_eq!(weights(&active)[0][0], 0.5 * (1.0 - 0.2), epsilon = 1e-12);
    let passive = AppearanceMapParams { forgetting_mode: ForgettingMode::Passive, ..published() };
    assert_eq!(weights(&map_of(&[(0.0, 0.0), (3.0, 0.5)], &passive))[0], [0.5]);
    let far = map_of(&[(0.0, 0.0), (3.0, 1.1)], &published());
    assert_eq!(weights(&far)[0], [0.5], "beyond the radius nothing is forgotten");
}

#[test]
fn published_uncertainty_is_along_the_axes_of_the_map() {
    // σ of 0.3 m along the robot and 0.1 m across, which faces 45°: σx + σy = 2 √((0.09 + 0.01)/2).
    let params = AppearanceMapParams { forgetting_rate: 0.04, ..published() };
    let mut map = map_of(&[(0.0, 0.0)], &params);
    let pose = Pose2::new(0.5, 0.0, std::f64::consts::FRAC_PI_4);
    let pose = Gaussian::from_sigmas(pose, &Vector3::new(0.3, 0.1, 0.1)).expect("positive");
    map.learn(Tone(3.0), &pose, &params, GATE).expect("a good pose");
    let loss = 0.04 * 0.5 * 2.0 / (2.0 * 0.05_f64.sqrt());
    assert_abs_diff_eq!(weights(&map)[0][0], 0.5 * (1.0 - loss), epsilon = 1e-12);
}

#[test]
fn error_of_a_place_does_not_slow_forgetting() {
    let params = AppearanceMapParams {
        forgetting_uncertainty_kind: ForgettingUncertainty::AgainstPlace,
        ..published()
    };
    // As uncertain as the place itself: at the full rate, b = 0.4 · (1 − 1/2).
    let alike = map_of(&[(0.0, 0.0), (3.0, 0.5)], &params);
    assert_abs_diff_eq!(weights(&alike)[0][0], 0.5 * 0.8, epsilon = 1e-12);
    // σ of 2 m against 0.1 m: σ² = 2 (2 · 2² − 2 · 0.1²).
    let mut map = map_of(&[(0.0, 0.0)], &params);
    let pose = Gaussian::from_sigmas(Pose2::new(0.5, 0.0, 0.0), &Vector3::new(2.0, 2.0, 0.1));
    map.learn(Tone(3.0), &pose.expect("positive"), &params, GATE).expect("a good pose");
    let loss = 0.4 * 0.5 * 2.0 / (2.0 * (2.0 * 4.0 - 2.0 * 0.01_f64)).sqrt();
    assert_abs_diff_eq!(weights(&map)[0][0], 0.5 * (1.0 - loss), epsilon = 1e-12);
}

#[test]
fn forgotten_references_go_and_the_map_stays_bounded() {
    let params = AppearanceMapParams { forgetting_rate: 1.0, ..published() };
    let map = map_of(&[(0.0, 0.0), (3.0, 0.0)], &params);
    assert_eq!(map.len(), 1, "the old view of this very spot is gone at once");
    let few = AppearanceMapParams { max_references: 3, ..published() };
    let many: Vec<(f64, f64)> = (0..9).map(|k| (2.0 * f64::from(k), 10.0 * f64::from(k))).collect();
    assert_eq!(map_of(&many, &few).len(), 3);
}

#[test]
fn residuals_correct_places_without_drawing_them_together() {
    let params = AppearanceMapParams { place_update: PlaceUpdateRule::Residual, ..published() };
    let mut map = empty_map();
    for k in 0..5 {
        let view = Tone(0.1 * f64::from(k));
        map.teach(view, &at(0.2 * f64::from(k))).expect("a good pose");
    }
    let spread = |map: &AppearanceMap<Tone>| {
        let xs: Vec<f64> = map.references().values().map(|r| r.places[0].gaussian.mean().x()).collect();
        xs[4] - xs[0]
    };
    let before = spread(&map);
    for _ in 0..20 {
        map.learn(Tone(0.2), &at(0.4), &params, GATE).expect("a good pose");
    }
    // The published rule would pull all five towards 0.4 m; a residual of nothing moves nothing.
    assert!(abs_diff_eq!(spread(&map), before, epsilon = 0.02), "from {before} to {}", spread(&map));
}

#[test]
fn invalid_pose_leaves_the_map_unchanged() {
    let mut map = map_of(&[(0.0, 0.0)], &published());
    let before = weights(&map);
    let flat = Gaussian::from_parts_unchecked(Pose2::new(0.0, 0.0, 0.0), nalgebra::Matrix3::zeros());
    let nowhere =
        Gaussian::from_parts_unchecked(Pose2::new(f64::NAN, 0.0, 0.0), nalgebra::Matrix3::identity());
    for bad in [flat, nowhere] {
        assert!(map.learn(Tone(0.0), &bad, &published(), GATE).is_err());
        assert!(map.teach(Tone(0.0), &bad).is_err());
    }
    assert_eq!((map.len(), weights(&map)), (1, before));
}

#[test]
fn a_map_is_its_parts() {
    let map = map_of(&[(0.0, 0.0), (3.0, 1.0), (0.1, 0.1)], &published());
    let parts = || (map.search().clone(), map.references().clone(), map.scale().clone());
    let (search, references, scale) = parts();
    let again = AppearanceMap::from_parts(search, references, scale, map.next_id()).unwrap();
    assert_eq!(again.references(), map.references());
    let (search, mut references, scale) = parts();
    references.values_mut().next().unwrap().places[0].weight = f64::NAN;
    assert!(AppearanceMap::<Tone>::from_parts(search, references, scale, map.next_id()).is_err());
    let (search, references, scale) = parts();
    assert!(
        AppearanceMap::<Tone>::from_parts(search, references, scale, 0).is_err(),
        "numbers not yet given out"
    );
}
