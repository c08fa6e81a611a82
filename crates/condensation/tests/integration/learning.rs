//! What is learned, against what it was made of.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common::scene;
use approx::assert_abs_diff_eq;
use wayfix_condensation::{
    AppearanceLearningParams, AppearanceModel, ColorMeanStdDescriptor, CondensationError, DiscreteStateSpace,
    GlobalDescriptor, GridMove, LightChange, LikelihoodTail, OneViewPerPicture, PositionGrid, RgbImage,
    SceneViews, StateDescriptorTable, TransitionCounts, TransitionModel, UnknownShiftAndLight, View,
    ViewGrid, shifted,
};

/// SciPy: `chi2.sf(4, 2)`; each component is one sigma of noise times sqrt(2) away.
#[test]
fn p_value_is_the_chi_squared_tail() {
    // Spread of each component over the states: 1, of which noise has all.
    let table = StateDescriptorTable::from_rows(&[vec![-1.0, -1.0], vec![1.0, 1.0]]).unwrap();
    let appearance = AppearanceModel::from_spread(table, 1.0).unwrap();
    let off = 2.0_f64.sqrt();
    assert_abs_diff_eq!(
        appearance.p_value(1, &[1.0 + off, 1.0 - off]).unwrap(),
        0.1353352832366127,
        epsilon = 1e-12
    );
    let between = appearance.p_values_between_states().unwrap();
    assert_abs_diff_eq!(between.mean, (-4.0_f64).exp(), epsilon = 1e-12); // two apart in both: d² = 8
    assert!(appearance.p_value(2, &[0.0, 0.0]).is_err() && appearance.p_value(0, &[0.0]).is_err());
}

/// Views of a state in the real scene are alike, views of different states are not (what Tables 1 and 2 are about).
#[test]
fn the_same_place_is_told_from_others() {
    let learned = scene(240, 176, 5);
    let views = ViewGrid::new((240, 176), (64, 64), 16).unwrap();
    let source = SceneViews::new(&learned, &views).unwrap();
    let appearance =
        AppearanceModel::learn(&source, &ColorMeanStdDescriptor, &AppearanceLearningParams::normalized())
            .unwrap();
    let seen = ColorMeanStdDescriptor.extract_all(&shifted(&learned, 2, -2), &views).unwrap();
    let same = appearance.p_values_of(&seen).unwrap();
    let others = appearance.p_values_between_states().unwrap();
    assert!(same.mean > 0.9 && others.mean < 0.1, "{same:?} {others:?}");
}

#[test]
fn pictures_of_single_places_can_be_learned() {
    let pictures: Vec<RgbImage> = (0..4).map(|seed| scene(48, 32, seed)).collect();
    let source = OneViewPerPicture::new(&pictures).unwrap();
    let appearance =
        AppearanceModel::learn(&source, &ColorMeanStdDescriptor, &AppearanceLearningParams::normalized())
            .unwrap();
    let mut features = [0.0; 6];
    ColorMeanStdDescriptor.extract(&View::whole(&pictures[2]).unwrap(), &mut features);
    assert_eq!(appearance.features(0).unwrap().get(2).unwrap(), features);
    assert_abs_diff_eq!(appearance.p_value(2, &features).unwrap(), 1.0, epsilon = 1e-12);
    assert!(OneViewPerPicture::new(&[]).is_err() && OneViewPerPicture::new(&[RgbImage::new(5, 0)]).is_err());
}

#[test]
fn moves_are_learned_from_a_log() {
    let grid = PositionGrid::new(4, 1).unwrap();
    let right = GridMove { dx: 1, dy: 0 };
    let mut log = TransitionCounts::new(&grid);
    for to in [1, 1, 1, 0] {
        log.record(0, right, to).unwrap();
    }
    let mut predicted = [0.0; 4];
    log.transition(right, 1.0).unwrap().predict(&[0.5, 0.0, 0.5, 0.0], &mut predicted);
    // (3 + 1) / 5 of the first, and what was never tried goes where it should
    assert_abs_diff_eq!(predicted[0], 0.1, epsilon = 1e-15);
    assert_abs_diff_eq!(predicted[1], 0.4, epsilon = 1e-15);
    assert!(predicted[3] == 0.5);
    assert!(log.record(0, right, 4).is_err() && log.transition(right, 0.0).is_err());
    assert!(log.record(0, GridMove { dx: 5, dy: 0 }, 1).is_err());
    assert_eq!(grid.n_states(), 4);
}

#[test]
fn parameters_out_of_range_are_refused() {
    let learned = scene(48, 32, 1);
    let views = ViewGrid::new((48, 32), (16, 16), 8).unwrap();
    let source = SceneViews::new(&learned, &views).unwrap();
    let learn = |params: AppearanceLearningParams| {
        AppearanceModel::learn(&source, &ColorMeanStdDescriptor, &params).map(|_| ())
    };
    let normalized = AppearanceLearningParams::normalized;
    assert!(learn(normalized()).is_ok());
    let disturbance = UnknownShiftAndLight { dx: f64::NAN, ..normalized().shift_and_light_sigmas };
    assert!(learn(AppearanceLearningParams { shift_and_light_sigmas: disturbance, ..normalized() }).is_err());
    assert!(
        learn(AppearanceLearningParams {
            likelihood_tail: LikelihoodTail::StudentT { dof: 0.0 },
            ..normalized()
        })
        .is_err()
    );
    let none = AppearanceLearningParams { light_changes: vec![], ..normalized() };
    assert_eq!(learn(none), Err(CondensationError::Empty { what: "conditions" }));
    let dark = LightChange { gain: -1.0, ..LightChange::SAME };
    assert!(learn(AppearanceLearningParams { light_changes: vec![dark], ..normalized() }).is_err());
    assert!(
        AppearanceModel::from_spread(StateDescriptorTable::from_rows(&[vec![1.0]]).unwrap(), f64::NAN)
            .is_err()
    );
}
