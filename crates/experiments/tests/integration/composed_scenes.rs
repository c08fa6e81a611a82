//! The paper's tables on composed scenes: the sizes, the figures and their meaning.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use approx::assert_abs_diff_eq;
use std::fs;
use wayfix_condensation::{DiscreteStateSpace, RgbImage, ViewGrid};
use wayfix_evaluation::report::{FullReport, Metric, ReportRun};
use wayfix_scene_sim::scenery::{ImagingConditions, Scenery};
use wayfix_systems::views::{
    self, DescriptorKind, LightNormalization, ViewSystemConfig, ViewsParams, ViewsRun,
};

use crate::common::experiments;

fn figure(metrics: &[Metric], name: &str) -> f64 {
    metrics.iter().find(|metric| metric.name == name).expect(name).value
}

/// Ten drives through coloured waves that did not change since they were learned.
fn unchanged() -> ViewsRun {
    let wave = |i: usize| {
        let (x, y) = ((i % 160) as f64, (i / 160) as f64);
        [x / 23.0 + (y / 31.0).sin(), x * y / 3000.0, y / 19.0]
            .map(|phase| (60.0 * phase.sin() + 120.0) as u8)
    };
    let picture = RgbImage::from_raw(160, 120, (0..160 * 120).flat_map(wave).collect()).unwrap();
    let setup = ViewSystemConfig {
        view: 64,
        step: 16,
        feature: DescriptorKind::MeanVar,
        normalization: LightNormalization::None,
    };
    views::run(&picture, &picture, &setup, &ViewsParams::default(), 10, 1, &|| ()).unwrap()
}

#[test]
fn views_of_the_composed_scenes_are_as_many_as_in_the_paper() {
    for (scenery, n_states) in Scenery::ALL.into_iter().zip([352, 234, 594, 150]) {
        let view = (Scenery::VIEW_PX, Scenery::VIEW_PX);
        let views = ViewGrid::new(scenery.size_px(), view, scenery.step_px).unwrap();
        assert_eq!(views.grid().n_states(), n_states, "{}", scenery.name);
    }
}

#[test]
fn a_visit_that_is_no_camera_is_refused() {
    let lab = Scenery::named("lab").unwrap();
    assert!(
        views::composed_scene_pair(
            &lab,
            &ImagingConditions { gamma: f64::NAN, ..ImagingConditions::dimmed() }
        )
        .is_err()
    );
}

/// At distance 0 the tail holds everything; different views are at some distance.
#[test]
fn views_that_did_not_change_are_the_same() {
    let run = unchanged();
    let metrics = views::p_value_metrics(&run.system).unwrap();
    assert_eq!(
        [figure(&metrics, "p_value_same_state_min"), figure(&metrics, "p_value_same_state_max")],
        [1.0, 1.0]
    );
    assert!(figure(&metrics, "p_value_between_states_mean") < 0.5, "{metrics:?}");
}

#[test]
fn moves_saved_are_counted_pair_by_pair() {
    let informed = unchanged();
    let mut greedy = informed.clone();
    // Two moves more on the even drives, none on the odd ones: 1 on the mean, and a paired variance of 10 / 9.
    greedy.trials.iter_mut().step_by(2).for_each(|trial| trial.report.steps += 2);
    let metrics = views::compare_choices(&greedy, &informed);
    assert_abs_diff_eq!(figure(&metrics, "steps_saved_by_informed_mean"), 1.0, epsilon = 1e-12);
    let half_width = 2.262 * (10.0_f64 / 9.0 / 10.0).sqrt(); // t(0.975, 9) from a table
    assert_abs_diff_eq!(figure(&metrics, "steps_saved_by_informed_low95"), 1.0 - half_width, epsilon = 1e-3);
    assert_eq!(
        figure(&metrics, "steps_to_certainty_saved_by_informed_mean"),
        0.0,
        "certainty came when it came"
    );
    // A drive that was never certain counts with all its moves.
    greedy.trials[0].report.steps_to_certainty = None;
    let before = informed.trials[0].report.steps_to_certainty.unwrap();
    let more = (greedy.trials[0].report.steps - before) as f64 / 10.0;
    let metrics = views::compare_choices(&greedy, &informed);
    assert_abs_diff_eq!(figure(&metrics, "steps_to_certainty_saved_by_informed_mean"), more, epsilon = 1e-12);
}

const PLAN: &str = r#"
[[run]]
name = "lab"
experiment = "tables"
scene = "lab"
normalization = ["whole-scene"]
trials = 3

[[run]]
name = "attic"
experiment = "tables"
scene = "attic"
"#;

/// What `wayfix-experiments regress views` reports of a plan that needs no file.
fn regress() -> Vec<ReportRun> {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("views.toml"), PLAN).unwrap();
    let out = folder.path().join("report");
    let paths = [folder.path(), out.as_path()].map(|path| path.to_str().unwrap().to_owned());
    let outcome = experiments(["regress", "views", "--quick", "--fixtures", &paths[0], "--out", &paths[1]]);
    assert_eq!(outcome.code, 1, "a scene that does not exist fails: {}", outcome.stderr);
    let report: FullReport = serde_json::from_slice(&fs::read(out.join("report.json")).unwrap()).unwrap();
    report.suites.into_iter().flat_map(|suite| suite.runs).collect()
}

#[test]
fn tables_need_no_files_and_are_the_same_every_time() {
    let (first, again) = (regress(), regress());
    assert_eq!(first[0].metrics, again[0].metrics);
    let successes = first[0]
        .metrics
        .iter()
        .find(|metric| metric.name == "dominant_grays_scene_normalized_successes")
        .unwrap();
    assert_eq!(successes.paper, Some(51.0), "Table 3");
    assert!(
        first[0]
            .metrics
            .iter()
            .any(|metric| metric.name == "fourier6_scene_normalized_p_value_same_state_mean")
    );
    assert!(first[1].error.as_ref().is_some_and(|error| error.contains("attic")), "{:?}", first[1].error);
}
