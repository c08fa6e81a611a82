//! What the command says about directions that nothing constrains.

use crate::common::{Outcome, Scratch, run_slam, walk};

#[test]
fn the_free_directions_of_a_map_without_anchors_are_named() {
    let scratch = Scratch::new();
    let log = scratch.file("walk.txt", walk(40));
    for estimator in ["ekf", "smoother"] {
        names_three(&run_slam(&log, &["--observability", "--estimator", estimator]));
    }
    assert!(run_slam(&log, &[]).json()["metrics"]["n_unobservable_directions"].is_null());
}

fn names_three(outcome: &Outcome) {
    // A planar map of relative detections may be moved and turned, and nothing else of it is free.
    assert_eq!(outcome.metric("n_unobservable_directions"), 3.0);
    assert_eq!(outcome.metric("state_dimension"), 4.0 + 2.0 * outcome.metric("n_landmarks"));
    for name in
        ["translation of everything along x", "translation of everything along y", "rotation of everything"]
    {
        assert!(outcome.stderr.contains(name), "{}", outcome.stderr);
    }
}
