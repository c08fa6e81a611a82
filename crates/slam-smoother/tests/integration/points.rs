//! The smoother of points: laws, a window against the batch, decisions that are taken back, hostile input.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    reason = "a panic is the verdict of a test, in its helpers too"
)]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{DMatrix, Matrix1, Matrix2, Matrix3, Vector1, Vector2};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_slam_smoother::{
    SlamSmootherError,
    points::{
        AntennaPosition, Detection, Heading, MountedRangeBearing, PointMapGaussian, PointSmoother,
        PoseObservation, SettledPose,
    },
};
use wayfix_smoother::laws;

use crate::circle::{MOUNT, Step, noise, params, run, start, steps, take};

fn gaussian(smoother: &PointSmoother) -> PointMapGaussian {
    let (landmarks, still) = (smoother.landmarks().into_keys(), Matrix3::zeros());
    smoother.gaussian(landmarks, &Pose2::identity(), &still).unwrap()
}

#[test]
fn smoother_goes_on_from_the_gaussian_of_its_window() {
    let (steps, _) = steps(80);
    let (mut whole, mut resumed) = (PointSmoother::new(params(Some(10.0)), &start()).unwrap(), None);
    let (mut expected, mut found) = (Vec::new(), Vec::new());
    for (k, step) in steps.iter().enumerate() {
        if k == 40 {
            let saved = gaussian(&whole);
            let from_saved = PointSmoother::new(params(Some(10.0)), &saved).unwrap();
            let again = gaussian(&from_saved);
            assert!(again.pose.local(&saved.pose).norm() < 1e-9 && again.landmarks.len() == 8);
            // The pose of a map is uncertain by 1e-4 m and 1e-5 rad at least.
            assert_abs_diff_eq!(again.covariance, saved.covariance, epsilon = 1e-7);
            resumed = Some(from_saved);
        }
        expected.extend(take(&mut whole, k, step));
        found.extend(resumed.as_mut().map(|resumed| take(resumed, k, step)).unwrap_or_default());
    }
    let mut resumed = resumed.unwrap();
    expected.extend(whole.finish().unwrap());
    found.extend(resumed.finish().unwrap());
    // Pose 0 of the resumed one is pose 40. Only the linearization of the saved window differs; a tenth of σ makes an error larger by 1 %.
    assert_eq!(found.len(), 41);
    let squared = |found: &SettledPose| {
        let expected = &expected[found.number + 40];
        let difference = found.pose.local(&expected.pose);
        difference.dot(&expected.covariance.cholesky().unwrap().solve(&difference))
    };
    let mean = found.iter().map(squared).sum::<f64>() / 41.0;
    assert!(mean < 3.0 * 0.1_f64.powi(2), "{mean}");
}

#[test]
fn gaussian_of_a_later_robot_has_the_noise_of_its_motion() {
    let smoother = PointSmoother::new(params(None), &start()).unwrap();
    let motion = Pose2::new(1.0, 0.5, 0.2);
    let moved = smoother.gaussian([], &motion, &noise()).unwrap();
    assert_eq!(moved.pose, motion);
    // The start is exact.
    let expected = PointMapGaussian::without_landmarks(motion, &noise(), 0.03);
    assert_abs_diff_eq!(moved.covariance, expected.covariance, epsilon = 1e-12);
    assert!(smoother.gaussian([3], &motion, &noise()).is_err());
    let exact = PointMapGaussian::without_landmarks(motion, &Matrix3::zeros(), 0.0);
    let smoother = PointSmoother::new(params(None), &exact).unwrap();
    assert_eq!(smoother.gaussian([], &Pose2::identity(), &Matrix3::zeros()).unwrap(), exact);
}

#[test]
fn start_that_is_no_gaussian_is_refused() {
    let good = PointMapGaussian {
        landmarks: vec![(4, Vector2::new(1.0, 2.0))],
        covariance: DMatrix::identity(6, 6) * 0.01,
        ..start()
    };
    assert!(PointSmoother::new(params(None), &good).unwrap().contains(4));
    let with = |row: usize, column: usize, entry: f64| {
        let mut bad = good.clone();
        bad.covariance[(row, column)] = entry;
        bad.covariance[(column, row)] = entry;
        bad
    };
    let mut small = good.clone();
    small.covariance = DMatrix::identity(4, 4);
    let nowhere = PointMapGaussian { pose: Pose2::new(f64::NAN, 0.0, 0.0), ..good.clone() };
    for bad in [with(0, 1, 0.02), with(2, 2, -1.0), with(4, 4, f64::NAN), small, nowhere] {
        assert!(PointSmoother::new(params(None), &bad).is_err(), "{}", bad.covariance);
    }
}

#[test]
fn residuals_of_points_keep_the_laws() {
    let [x, y, heading] = MOUNT;
    for turn in [0.0, 1e-8, 3.1, -3.1, -0.4] {
        let robot = Pose2::new(1.0, -2.0, turn);
        let seen = MountedRangeBearing { mount: Pose2::new(x, y, heading), range: 3.0, bearing: 0.2 };
        for point in [[4.0, 1.0], [-3.0, -2.0], [100.0, 3.0]] {
            laws::residual(&seen, (&robot, &Vector2::from(point), &Vector1::new(0.05))).unwrap();
        }
        let antenna = AntennaPosition { antenna: Vector2::new(1.0, 0.5), measured: Vector2::new(0.0, 2.0) };
        laws::residual(&antenna, (&robot,)).unwrap();
        laws::residual(&Heading { measured: 3.0 }, (&robot,)).unwrap();
    }
}

#[test]
fn window_that_drops_nothing_equals_the_batch() {
    let (steps, _) = steps(40);
    let (batch, of_batch) = run(None, &steps);
    let (window, of_window) = run(Some(1e6), &steps);
    assert!(
        abs_diff_eq!(batch.cost() / window.cost(), 1.0, epsilon = 1e-9),
        "{} {}",
        batch.cost(),
        window.cost()
    );
    assert_eq!(of_batch.len(), 41);
    for (a, b) in of_batch.iter().zip(&of_window) {
        // Both stop where a step gains less than 1e-8 of the cost.
        assert!(a.number == b.number && a.pose.local(&b.pose).norm() < 1e-4);
    }
}

#[test]
fn short_window_stays_bounded_and_near_the_truth() {
    let (steps, truth) = steps(150);
    let (smoother, settled) = run(Some(10.0), &steps);
    assert!(smoother.size().0 <= 12, "{:?}", smoother.size());
    assert_eq!(settled.iter().map(|pose| pose.number).collect::<Vec<_>>(), (0..=150).collect::<Vec<_>>());
    let mut nees = 0.0;
    for SettledPose { number, pose, covariance } in settled.iter().skip(1) {
        let error = pose.local(&truth[*number]);
        nees += error.dot(&covariance.cholesky().unwrap().solve(&error)) / 150.0;
    }
    // The errors of one run hang together: a mean of 3 with the spread of a few independent poses.
    assert!(nees < 9.0, "{nees}");
}

#[test]
fn export_has_a_line_for_each_variable_and_residual() {
    let (steps, _) = steps(40);
    let (batch, _) = run(None, &steps);
    let text = batch.export().unwrap();
    let count = |kind: &str| text.lines().filter(|line| line.split(' ').next() == Some(kind)).count();
    let n_detections: usize = steps.iter().map(|step| step.seen.len()).sum();
    assert_eq!([count("POSE"), count("LANDMARK"), count("LOG_SCALE")], [41, 8, 1]);
    assert_eq!([count("MOTION"), count("DETECTION")], [40, n_detections]);
    let numbers = |line: &str| line.split(' ').skip(1).map(|word| word.parse::<f64>().unwrap()).collect();
    let motion: Vec<f64> = text.lines().find(|line| line.starts_with("MOTION")).map(numbers).unwrap();
    let first = steps[0].motion;
    assert_eq!(motion[2..5], [first.x(), first.y(), first.heading()]);
    assert_eq!(motion.len(), 11);
    assert_abs_diff_eq!(motion[5], 1.0 / (0.0004 + 1e-8), epsilon = 1e-6);
    // The start is exact, its scale is not.
    let start: Vec<f64> = text.lines().find(|line| line.starts_with("START")).map(numbers).unwrap();
    assert_eq!((count("HELD"), start[..3].to_vec()), (1, vec![1.0, 1.0, 0.0]));
    assert_abs_diff_eq!(start[3], 0.03_f64.powi(-2), epsilon = 1e-6);
    let solution = batch.export_solution().unwrap();
    let count = |kind: &str| solution.lines().filter(|line| line.starts_with(kind)).count();
    assert_eq!((count("SOLUTION "), count("COST ")), (50, 1));
    let cost: f64 = solution.lines().next().unwrap()[5..].parse().unwrap();
    assert_eq!(cost, batch.cost());
}

#[test]
fn export_of_other_residuals_is_refused_with_their_number() {
    let (steps, _) = steps(40);
    let (window, _) = run(Some(10.0), &steps);
    assert_eq!(window.export(), Err(SlamSmootherError::NotExported { n_residuals: 1 }));
    let (mut batch, _) = run(None, &steps);
    let heading = PoseObservation::Heading { measured: 0.7, variance: Matrix1::new(1e-4) };
    batch.observe(&heading, &Pose2::identity()).unwrap();
    assert_eq!(batch.export(), Err(SlamSmootherError::NotExported { n_residuals: 1 }));
}

#[test]
fn landmark_that_is_taken_back_leaves_no_trace() {
    let (steps, _) = steps(30);
    let (_, expected) = run(Some(100.0), &steps);
    let mut smoother = PointSmoother::new(params(Some(100.0)), &start()).unwrap();
    for (k, step) in steps.iter().enumerate() {
        smoother.advance(step.motion, &noise(), None).unwrap();
        for (landmark, detection) in &step.seen {
            smoother.detect(*landmark, detection).unwrap();
        }
        if (5..15).contains(&k) {
            let wrong =
                Detection { range: 2.0 + k as f64, bearing: 0.1, covariance: Matrix2::identity() * 1e-3 };
            smoother.detect(99, &wrong).unwrap();
        }
        if k == 15 {
            assert!(smoother.contains(99));
            smoother.remove(99).unwrap();
        }
        smoother.step(k as f64).unwrap();
    }
    let found = smoother.finish().unwrap();
    assert!(!smoother.contains(99));
    for (a, b) in expected.iter().zip(&found) {
        assert!(a.pose.local(&b.pose).norm() < 1e-4, "{:?} {:?}", a.pose, b.pose);
    }
}

#[test]
fn merged_landmarks_are_one() {
    let (steps, _) = steps(30);
    let (whole, merged) = (run(Some(100.0), &steps).0, run_with_a_merge(Some(100.0), &steps));
    assert!(!merged.contains(40));
    assert!((merged.landmarks()[&4] - whole.landmarks()[&4]).norm() < 0.02);
}

#[test]
fn batch_with_a_merge_equals_the_batch_without_the_split() {
    let (steps, _) = steps(30);
    let (whole, merged) = (run(None, &steps).0, run_with_a_merge(None, &steps));
    assert_eq!(whole.size(), merged.size());
    assert!(abs_diff_eq!(merged.cost() / whole.cost(), 1.0, epsilon = 1e-8));
    assert!((merged.landmarks()[&4] - whole.landmarks()[&4]).norm() < 1e-4);
    let n_lines = |smoother: &PointSmoother| smoother.export().unwrap().lines().count();
    assert_eq!(n_lines(&whole), n_lines(&merged));
}

/// Landmark 4 is taken for a new one in the second half.
fn run_with_a_merge(lag: Option<f64>, steps: &[Step]) -> PointSmoother {
    let mut smoother = PointSmoother::new(params(lag), &start()).unwrap();
    for (k, step) in steps.iter().enumerate() {
        smoother.advance(step.motion, &noise(), None).unwrap();
        for (landmark, detection) in &step.seen {
            let name = if *landmark == 4 && k >= 15 { 40 } else { *landmark };
            smoother.detect(name, detection).unwrap();
        }
        smoother.step(k as f64).unwrap();
    }
    smoother.merge(4, 40).unwrap();
    smoother.finish().unwrap();
    smoother
}

#[test]
fn external_measurements_and_anchors_tie_the_map() {
    let mut smoother = PointSmoother::new(
        params(Some(10.0)),
        &PointMapGaussian::without_landmarks(Pose2::identity(), &(Matrix3::identity() * 4.0), 0.03),
    )
    .unwrap();
    let there = Pose2::new(3.0, 1.0, 0.5);
    let seen =
        |measured, covariance| PoseObservation::Position { antenna: Vector2::x(), measured, covariance };
    for k in 0..5 {
        smoother.advance(Pose2::identity(), &noise(), None).unwrap();
        smoother
            .observe(&seen(there.transform(&Vector2::x()), Matrix2::identity() * 0.01), &Pose2::identity())
            .unwrap();
        let heading = PoseObservation::Heading { measured: 0.5 + 0.2, variance: Matrix1::new(1e-4) };
        smoother.observe(&heading, &Pose2::new(0.0, 0.0, 0.2)).unwrap();
        let pose = PoseObservation::Pose {
            measured: there.compose(&Pose2::new(1.0, 0.0, 0.2)),
            covariance: Matrix3::identity() * 0.01,
        };
        smoother.observe(&pose, &Pose2::new(1.0, 0.0, 0.2)).unwrap();
        smoother.step(k as f64).unwrap();
    }
    assert!(smoother.pose().unwrap().local(&there).norm() < 0.02);
    smoother.add_anchor(7, Vector2::new(5.0, 5.0)).unwrap();
    let place =
        smoother.pose().unwrap().compose(&params(None).mount).inverse_transform(&Vector2::new(5.0, 5.0));
    let detection = Detection {
        range: place.norm(),
        bearing: place.y.atan2(place.x),
        covariance: Matrix2::identity() * 0.01,
    };
    smoother.detect(7, &detection).unwrap();
    smoother.finish().unwrap();
    assert_eq!(smoother.landmarks()[&7], Vector2::new(5.0, 5.0));
    // A landmark that becomes an anchor stays, with all that was seen of it; an anchor stays an anchor.
    smoother.detect(8, &detection).unwrap();
    smoother.add_anchor(8, Vector2::new(5.0, 5.1)).unwrap();
    smoother.add_anchor(7, Vector2::zeros()).unwrap();
    let n_residuals = smoother.size().1;
    smoother.finish().unwrap();
    assert_eq!(smoother.landmarks(), [(7, Vector2::new(5.0, 5.0)), (8, Vector2::new(5.0, 5.1))].into());
    assert_eq!(smoother.size().1, n_residuals);
}

#[test]
fn numbers_that_are_none_are_refused_and_change_nothing() {
    let mut smoother = PointSmoother::new(params(Some(10.0)), &start()).unwrap();
    smoother.advance(Pose2::new(1.0, 0.0, 0.0), &noise(), None).unwrap();
    let good = Detection { range: 2.0, bearing: 0.3, covariance: Matrix2::identity() * 0.01 };
    for bad in [
        Detection { range: 0.0, ..good },
        Detection { range: f64::NAN, ..good },
        Detection { bearing: f64::INFINITY, ..good },
        Detection { covariance: Matrix2::zeros(), ..good },
        Detection { covariance: Matrix2::identity() * f64::NAN, ..good },
    ] {
        assert!(smoother.detect(1, &bad).is_err(), "{bad:?}");
        assert!(!smoother.contains(1));
    }
    assert!(smoother.advance(Pose2::new(f64::NAN, 0.0, 0.0), &noise(), None).is_err());
    assert!(smoother.advance(Pose2::identity(), &(noise() * f64::NAN), None).is_err());
    assert_eq!(smoother.newest(), 1);
    smoother.detect(1, &good).unwrap();
    smoother.step(0.0).unwrap();
    assert_eq!(smoother.finish().unwrap().len(), 2);
}
