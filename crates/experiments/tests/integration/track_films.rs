//! Trackers on films: what is judged, and that figures are the same for any number of threads.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use approx::assert_abs_diff_eq;
use wayfix_evaluation::report::Metric;
use wayfix_experiments::films::{FilmTrackingScore, table};
use wayfix_scene_sim::film::{FilmFrame, OcclusionEvent, SyntheticFilm};
use wayfix_systems::track::{TrackParams, TrackingMethod};
use wayfix_visual_tracking::{BoundingBox, TargetEstimate, TrackStatus};

fn film(n_frames: usize) -> SyntheticFilm {
    SyntheticFilm { n_frames, ..SyntheticFilm::named("snail").unwrap() }
}

/// What a tracker says that sees the true box of a frame and nothing more.
fn true_box(frame: &FilmFrame, status: TrackStatus) -> TargetEstimate {
    let [x, y, width, height] = frame.target.bounding_box().unwrap();
    let bounding_box = BoundingBox::from_corner(x, y, width, height).unwrap();
    TargetEstimate { bounding_box, outline: Vec::new(), status, quality: 1.0 }
}

#[test]
fn a_box_is_judged_by_its_box_and_an_outline_by_its_pixels() {
    let frame = film(1).frames().unwrap().next().unwrap();
    let boxed = true_box(&frame, TrackStatus::Tracked);
    let [x, y] = boxed.bounding_box.corner();
    let (right, bottom) = (x + boxed.bounding_box.width(), y + boxed.bounding_box.height());
    let outlined =
        TargetEstimate { outline: vec![[x, y], [right, y], [right, bottom], [x, bottom]], ..boxed.clone() };
    let mut score = FilmTrackingScore::default();
    score.add(&boxed, &frame).unwrap();
    score.add(&outlined, &frame).unwrap();
    assert_eq!(score.iou[0], 1.0);
    // The box holds every pixel of the shell, so that the overlap is the ratio of the areas.
    let ratio = frame.target.area() as f64 / boxed.bounding_box.area();
    assert_abs_diff_eq!(score.iou[1], ratio, epsilon = 1e-12);
    assert!(score.center_error[0] < 1e-12 && score.center_error[1] < 2.0);
}

#[test]
fn lost_target_has_zero_overlap_and_a_hidden_one_no_score() {
    let hidden = SyntheticFilm { occlusion: OcclusionEvent::Hidden, ..film(60) };
    let mut score = FilmTrackingScore::default();
    let (mut n_visible, mut n_hidden) = (0, 0);
    for frame in hidden.frames().unwrap() {
        score.add(&true_box(&frame, TrackStatus::Lost), &frame).unwrap();
        if frame.visible.area() == 0 { n_hidden += 1 } else { n_visible += 1 }
    }
    assert!(n_hidden > 0 && score.iou == vec![0.0; n_visible]);
    assert_eq!((score.n_lost, score.n_hidden, score.n_hidden_and_lost), (n_visible, n_hidden, n_hidden));
    assert!(score.center_error.is_empty());
}

#[test]
fn film_table_has_all_methods_for_any_thread_count() {
    let methods = [TrackingMethod::Contour, TrackingMethod::ContourFixedColors, TrackingMethod::Box];
    let figures = |n_threads: usize| -> Vec<Metric> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| table(&film(8), 3..6, &methods, &TrackParams::default())).unwrap().metrics
    };
    let alone = figures(1);
    assert_eq!(alone, figures(3));
    let of = |name: &str| alone.iter().find(|metric| metric.name == name).unwrap();
    for method in ["contour", "contour_fixed_colors", "box"] {
        assert_eq!(of(&format!("{method}_iou_mean")).spread.unwrap().n, 3);
    }
    // What is promised for the whole film; these are its first frames.
    assert!(of("contour_iou_mean").value >= 0.75 && of("contour_n_frames_lost").value == 0.0);
}
