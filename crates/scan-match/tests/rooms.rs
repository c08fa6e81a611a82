//! Scans of simulated rooms, laid on one another.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use nalgebra::{Matrix3, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, Normal};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_scan_match::{
    InitialGuess, ScanAlignment, ScanMatchError, ScanMatchParams, ScanMatcher, ScanPointCloud,
};

const N_BEAMS: usize = 360;
const INCREMENT: f64 = 0.0174;
const RANGE_SIGMA: f64 = 0.01;

/// Walls, each from a point to another.
type Walls = Vec<([f64; 2], [f64; 2])>;

/// A room of 8 m by 6 m with a cupboard.
fn room() -> Walls {
    let corners =
        [[-4.0, -3.0], [4.0, -3.0], [4.0, 3.0], [2.0, 3.0], [2.0, 2.2], [1.0, 2.2], [1.0, 3.0], [-4.0, 3.0]];
    (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()])).collect()
}

/// Two long walls and nothing else.
fn corridor() -> Walls {
    vec![([-100.0, -1.0], [100.0, -1.0]), ([-100.0, 1.0], [100.0, 1.0])]
}

fn scan(walls: &Walls, pose: &Pose2<f64>, rng: &mut ChaCha8Rng) -> ScanPointCloud {
    let noise = Normal::new(0.0, RANGE_SIGMA).expect("a positive deviation");
    let ranges: Vec<f64> = (0..N_BEAMS)
        .map(|beam| {
            let (sin, cos) = (pose.heading() - 3.13 + beam as f64 * INCREMENT).sin_cos();
            let range =
                walls.iter().filter_map(|wall| hit(pose, [cos, sin], wall)).fold(f64::INFINITY, f64::min);
            range + noise.sample(rng)
        })
        .collect();
    ScanPointCloud::from_ranges(-3.13, INCREMENT, &ranges, 30.0).expect("a sound scan")
}

/// How far along the ray the wall is.
fn hit(pose: &Pose2<f64>, ray: [f64; 2], (from, to): &([f64; 2], [f64; 2])) -> Option<f64> {
    let (along, start) = ([to[0] - from[0], to[1] - from[1]], [from[0] - pose.x(), from[1] - pose.y()]);
    let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
    let (range, share) = (cross(start, along) / cross(ray, along), cross(start, ray) / cross(ray, along));
    (range > 0.0 && (0.0..=1.0).contains(&share)).then_some(range)
}

fn sigmas(translation: f64, heading: f64) -> Matrix3<f64> {
    Matrix3::from_diagonal(&Vector3::new(translation, translation, heading).map(|sigma| sigma * sigma))
}

/// The scan from `truth` laid on the one from the origin.
fn align(
    walls: &Walls,
    truth: &Pose2<f64>,
    guess: &Pose2<f64>,
    covariance: &Matrix3<f64>,
    seed: u64,
) -> ScanAlignment {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let clouds = [Pose2::new(0.0, 0.0, 0.0), *truth].map(|pose| scan(walls, &pose, &mut rng));
    let matcher = ScanMatcher::new(ScanMatchParams::default()).expect("the defaults are sound");
    matcher
        .align(
            &clouds[0],
            &clouds[1],
            &InitialGuess { pose: *guess, covariance: *covariance, alternative_poses: &[] },
        )
        .expect("enough points")
}

/// Guesses are drawn from the covariance that the matcher is told; the posterior covariance counts points within 0.4 rad as one, so it is wider than
/// the independent errors of these scans make it, and the mean of 100 squared distances must be below that of chi-squared with three
/// degrees of freedom, 3, by more than chance alone.
#[test]
fn the_posterior_is_nearer_than_its_covariance_says() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let standard = Normal::new(0.0, 1.0).expect("a positive deviation");
    let covariance = sigmas(0.1, 0.1);
    let mut sum = 0.0;
    for seed in 0..100 {
        let mut draw = |sigma: f64| sigma * standard.sample(&mut rng);
        let truth = Pose2::new(draw(0.3), draw(0.3), draw(0.3));
        let guess = truth.retract(&Vector3::new(draw(0.1), draw(0.1), draw(0.1)));
        let found = align(&room(), &truth, &guess, &covariance, seed);
        let error = found.pose.local(&truth);
        assert!(error.xy().norm() < 0.03 && error.z.abs() < 0.01, "{seed}: {error}"); // three deviations of one beam
        let information = found.information + covariance.try_inverse().expect("a covariance");
        sum += error.dot(&(information * error));
        assert!(found.overlap > 0.8, "{}", found.overlap);
    }
    assert!(sum / 100.0 < 3.0, "{}", sum / 100.0);
}

/// With a heading that is in doubt by 0.4 rad, some guesses are off by more than one search can mend: the rooms' walls are 1.57 rad apart.
#[test]
fn a_heading_in_doubt_is_searched_for() {
    let truth = Pose2::new(0.3, -0.2, 0.1);
    for (seed, off) in [0.5, 0.7, -0.5, -0.7].into_iter().enumerate() {
        let guess = Pose2::new(0.25, -0.25, 0.1 + off);
        let found = align(&room(), &truth, &guess, &sigmas(0.1, 0.4), seed as u64);
        let error = found.pose.local(&truth);
        assert!(error.xy().norm() < 0.03 && error.z.abs() < 0.01, "{off}: {error}");
    }
}

/// Odometry that counts backwards as forwards is off by twice the way, 1.6 m and 16 deviations. From there the walls of a pillared hall lead astray; from
/// where the robot would be had it gone on as before they do not.
#[test]
fn constant_motion_is_matched_despite_wrong_odometry() {
    let mut hall = room();
    for x in [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0] {
        hall.extend([([x, 1.0], [x + 0.4, 1.0]), ([x, 1.0], [x, 1.4]), ([x + 0.4, 1.0], [x + 0.4, 1.4])]);
    }
    let (truth, guess) = (Pose2::new(-0.8, 0.0, 0.0), Pose2::new(0.8, 0.0, 0.0));
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let clouds = [Pose2::new(0.0, 0.0, 0.0), truth].map(|pose| scan(&hall, &pose, &mut rng));
    let matcher = ScanMatcher::new(ScanMatchParams::default()).expect("the defaults are sound");
    let error = |others: &[Pose2<f64>]| {
        let guess = InitialGuess { pose: guess, covariance: sigmas(0.1, 0.02), alternative_poses: others };
        matcher.align(&clouds[0], &clouds[1], &guess).expect("enough points").pose.local(&truth).norm()
    };
    assert!(error(&[]) > 0.5, "{}", error(&[]));
    assert!(error(&[Pose2::new(-0.75, 0.0, 0.0)]) < 0.03, "{}", error(&[Pose2::new(-0.75, 0.0, 0.0)]));
}

#[test]
fn a_corridor_says_nothing_of_the_way_along_it() {
    let (truth, guess) = (Pose2::new(0.5, 0.1, 0.05), Pose2::new(0.7, 0.0, 0.0));
    let found = align(&corridor(), &truth, &guess, &sigmas(0.2, 0.1), 3);
    let error = found.pose.local(&truth);
    assert!(error.y.abs() < 0.03 && error.z.abs() < 0.01, "{error}");
    // Normals err by the noise over the span of their seven points, a few hundredths: along is known a thousandth as well as across, in information.
    assert!(found.information.m11 < 0.01 * found.information.m22, "{}", found.information);
    assert!(
        abs_diff_eq!(found.pose.x(), guess.x(), epsilon = 0.2),
        "within a deviation of the guess: {}",
        found.pose.x()
    );
}

/// Points on a circle around (1, 0), seen from the origin: nothing tells a turn about the centre. Of the information that noisy normals pretend, what is
/// left over is the chance of 180 points of which seven neighbours share their noise: a share of $`\sqrt{2 · 7 / 180}`$, 0.28, in one deviation.
#[test]
fn round_room_tells_no_turn_about_its_centre() {
    let corner = |i: usize| {
        let (sin, cos) = (i as f64 * std::f64::consts::TAU / 720.0).sin_cos();
        [1.0 + 3.0 * cos, 3.0 * sin]
    };
    let round: Walls = (0..720).map(|i| (corner(i), corner(i + 1))).collect();
    let about_the_centre = Vector3::new(0.0, -1.0, 1.0); // turning by one radian moves the robot by one metre
    let told = |seed: u64| {
        let start = Pose2::new(0.0, 0.0, 0.0);
        let information = align(&round, &start, &start, &sigmas(0.1, 0.1), seed).information;
        about_the_centre.dot(&(information * about_the_centre))
    };
    let mean = (0..50).map(told).sum::<f64>() / 50.0;
    // Normals over seven points, 0.05 m apart, of a laser of σ 0.01 m err by 0.01 / (0.05 √28) = 0.038 rad; 3 m of arm, σ 0.03 m, 0.4 rad as one error.
    let pretended = (3.0 * 0.038_f64).powi(2) / 0.03_f64.powi(2) * std::f64::consts::TAU / 0.4;
    assert!(mean < 0.28 * pretended, "{mean} of {pretended}");
}

/// A laser at the side of a robot that turns moves although the robot stays.
#[test]
fn a_laser_may_sit_anywhere_on_the_robot() {
    let mount = Pose2::new(0.4, -0.3, 0.7);
    let (start, end) = (Pose2::new(0.0, 0.0, 0.0), Pose2::new(0.1, 0.0, 0.4));
    let mut rng = ChaCha8Rng::seed_from_u64(21);
    let mut cloud = |pose: &Pose2<f64>| scan(&room(), &pose.compose(&mount), &mut rng).transformed(&mount);
    let (first, second) = (cloud(&start), cloud(&end));
    let guess = InitialGuess {
        pose: Pose2::new(0.05, 0.05, 0.3),
        covariance: sigmas(0.1, 0.1),
        alternative_poses: &[],
    };
    let matcher = ScanMatcher::new(ScanMatchParams::default()).expect("the defaults are sound");
    let error = matcher.align(&first, &second, &guess).expect("enough points").pose.local(&end);
    assert!(error.xy().norm() < 0.03 && error.z.abs() < 0.01, "{error}");
}

/// What the points say and what the guess says, weighed with their information, make the posterior.
#[test]
fn points_and_guess_add_up() {
    let covariance = sigmas(0.05, 0.05);
    let (truth, guess) = (Pose2::new(0.2, 0.1, 0.1), Pose2::new(0.25, 0.05, 0.05));
    let found = align(&room(), &truth, &guess, &covariance, 5);
    let prior = covariance.try_inverse().expect("a covariance") / found.guess_scale;
    let posterior = (found.information + prior).try_inverse().expect("definite") * found.information_vector;
    assert_abs_diff_eq!(posterior, found.correction, epsilon = 1e-9);
    assert!((guess.retract(&posterior).local(&found.pose)).norm() < 1e-9);
    let nis = found.correction.dot(&(prior * found.correction)) * found.guess_scale;
    assert_abs_diff_eq!(found.guess_scale, (4.0 + nis) / 7.0, epsilon = 1e-9);
}

#[test]
fn what_is_no_scan_is_refused() {
    let cloud =
        |min, increment, ranges: &[f64], max| ScanPointCloud::from_ranges(min, increment, ranges, max);
    let is_refused = |result: Result<ScanPointCloud, _>| matches!(result, Err(ScanMatchError::Value { .. }));
    let some = [1.0; 5];
    assert!(is_refused(cloud(f64::NAN, 0.01, &some, 10.0)));
    for increment in [f64::NAN, 0.0, f64::INFINITY, 10.0] {
        assert!(is_refused(cloud(0.0, increment, &some, 10.0)), "{increment}");
    }
    for max_range in [f64::NAN, 0.0, -1.0, f64::INFINITY] {
        assert!(is_refused(cloud(0.0, 0.01, &some, max_range)), "{max_range}");
    }
    let matcher = ScanMatcher::new(ScanMatchParams::default()).expect("the defaults are sound");
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let sound = scan(&room(), &Pose2::new(0.0, 0.0, 0.0), &mut rng);
    let guess = Pose2::new(0.0, 0.0, 0.0);
    for ranges in [vec![], vec![f64::NAN; 360], vec![f64::INFINITY; 360], vec![-1.0; 360], vec![1.0; 3]] {
        let empty = cloud(0.0, 0.0174, &ranges, 10.0).expect("sound geometry");
        for pair in [(&sound, &empty), (&empty, &sound)] {
            let error = matcher
                .align(
                    pair.0,
                    pair.1,
                    &InitialGuess { pose: guess, covariance: sigmas(0.1, 0.1), alternative_poses: &[] },
                )
                .expect_err("nothing to match");
            assert!(matches!(error, ScanMatchError::TooFewPoints { needed: 10, .. }), "{error}");
        }
    }
    for (guess, covariance) in [
        (Pose2::new(f64::NAN, 0.0, 0.0), sigmas(0.1, 0.1)),
        (guess, Matrix3::zeros()),
        (guess, Matrix3::from_element(f64::NAN)),
        (guess, -Matrix3::identity()),
    ] {
        let guess = InitialGuess { pose: guess, covariance, alternative_poses: &[guess] };
        assert_eq!(matcher.align(&sound, &sound, &guess), Err(ScanMatchError::Guess));
    }
}
