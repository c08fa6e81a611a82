//! A robot with a camera ahead and a darker one behind: each has its own light, and either keeps the place while the other is silent.

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_color_model::{
    ColorLocalizer, ColorModelError, GlobalSearchParams, LocalizationStatus, LocalizerParams, OdometryStep,
    StartPosePrior, YuvImage,
};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2, Pose3};
use wayfix_gaussian_core::Gaussian;

use crate::support::painted::{Scene, bank, camera_pose, mount};

/// The second camera is this much darker, of 255.
const DARKER: u8 = 25;
/// Y of green in the first.
const GREEN: f64 = 70.0;
/// Frames of both cameras; after them the first one is silent for 6 s.
const N_BOTH: usize = 16;
const N_SECOND: usize = 60;

/// What the cameras show at a time, each with its mount, and where the robot is.
struct Moment {
    first: (YuvImage, Pose3<f64>),
    second: (YuvImage, Pose3<f64>),
    body: Pose2<f64>,
}

/// The robot moves 2 cm and turns by 1° in a tenth of a second.
fn moments(scene: &mut Scene, mut body: Pose2<f64>, seed: u64) -> Vec<Moment> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut moment = |k: usize| {
        body = body.compose(&Pose2::new(0.02, 0.0, 0.0175));
        let pan = 0.9 * (0.3 * k as f64).sin();
        let [ahead, behind] = [pan, pan + std::f64::consts::PI].map(mount);
        let first = (scene.paint(&camera_pose(&body, &ahead), &mut rng), ahead);
        let seen = scene.paint(&camera_pose(&body, &behind), &mut rng);
        let darker = |[y, u, v]: &[u8; 3]| [y.saturating_sub(DARKER), *u, *v];
        let dark = scene.image(seen.pixels().iter().map(darker).collect());
        Moment { first, second: (dark, behind), body }
    };
    (0..N_BOTH + N_SECOND).map(&mut moment).collect()
}

/// Odometry that misses a fifth of the turning.
const MOVED: (f64, f64) = (0.02, 0.014);

fn localizer(scene: &Scene, start: Pose2<f64>, rng: &mut ChaCha8Rng) -> ColorLocalizer {
    let search = GlobalSearchParams {
        n_buffered_frames: 4,
        samples_per_place: 0.15,
        n_refined_trajectories: 40,
        ..GlobalSearchParams::default()
    };
    let params = LocalizerParams { max_particles: 300, search, ..LocalizerParams::default() };
    let start = Gaussian::from_sigmas(start, &Vector3::repeat(0.1)).expect("positive");
    let start = StartPosePrior::Near(start);
    ColorLocalizer::new(scene.map.clone(), scene.camera, bank(), &start, params, rng)
        .expect("sound parameters")
}

/// The end of a drive.
#[derive(Debug)]
struct End {
    /// Of the position, m.
    error: f64,
    /// Frames that say `tracking` although no search was possible for 3 s.
    n_unconfirmed: usize,
    /// Y of green in the light of the first camera.
    green: f64,
}

/// The same drive with the second camera, and without it.
fn ends(seed: u64) -> [End; 2] {
    let mut scene = Scene::new();
    let start = Pose2::new(-0.5, 0.2, 0.4);
    let moments = moments(&mut scene, start, seed);
    [true, false].map(|has_second| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut localizer = localizer(&scene, start, &mut rng);
        let second = localizer.add_camera(scene.camera);
        let moved = Pose2::new(MOVED.0, 0.0, MOVED.1);
        let (mut at, mut truth, mut n_unconfirmed) = (start, start, 0);
        for (number, Moment { first, second: other, body }) in moments.iter().enumerate() {
            let step = OdometryStep { increment: Some(moved), seconds: 0.1 };
            localizer.predict(&step, &mut rng).expect("a sound step");
            (at, truth) = (at.compose(&moved), *body);
            if number < N_BOTH {
                let outcome = localizer.update(&first.0, &first.1, &mut rng).expect("a sound frame");
                at = *outcome.estimate.pose.mean();
            }
            if has_second {
                let outcome =
                    localizer.update_from(second, &other.0, &other.1, &mut rng).expect("a sound frame");
                at = *outcome.estimate.pose.mean();
                let is_tracking = outcome.status == LocalizationStatus::Tracking;
                n_unconfirmed += usize::from(number > N_BOTH + 30 && is_tracking);
            }
        }
        let error = truth.local(&at).xy().norm();
        End { error, n_unconfirmed, green: localizer.light().member(0).mean()[0] }
    })
}

#[test]
fn second_camera_keeps_the_place_while_the_first_is_silent() {
    let all = [1, 2, 3].map(ends);
    let [with, without] = [0, 1].map(|at| all.iter().map(|ends| ends[at].error / 3.0).sum::<f64>());
    // What the system promises of the mean error.
    assert!(with < 0.1 && with < without, "{all:?}");
    for end in all.iter().flatten() {
        assert_eq!(end.n_unconfirmed, 0, "only a search of the first camera confirms a place");
        assert!((end.green - GREEN).abs() < f64::from(DARKER) / 2.0, "the light of the second: {end:?}");
    }
}

/// Something stands before it: it gives no evidence.
#[test]
fn covered_second_camera_does_not_make_the_robot_lost() {
    let mut scene = Scene::new();
    let start = Pose2::new(-0.5, 0.2, 0.4);
    let moments = moments(&mut scene, start, 4);
    let wall = scene.wall(&mut ChaCha8Rng::seed_from_u64(4));
    let [with, without] = [true, false].map(|has_second| {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut localizer = localizer(&scene, start, &mut rng);
        let second = localizer.add_camera(scene.camera);
        let step = OdometryStep { increment: Some(Pose2::new(0.02, 0.0, 0.0175)), seconds: 0.1 };
        let is_lost = |Moment { first, second: (_, behind), .. }: &Moment| {
            localizer.predict(&step, &mut rng).expect("a sound step");
            let outcome = localizer.update(&first.0, &first.1, &mut rng).expect("a sound frame");
            if has_second {
                localizer.update_from(second, &wall, behind, &mut rng).expect("a sound frame");
            }
            outcome.status == LocalizationStatus::Lost
        };
        moments.iter().map(is_lost).collect::<Vec<_>>()
    });
    let n_more = with.iter().zip(&without).filter(|(with, without)| **with && !**without).count();
    assert_eq!(n_more, 0, "lost frames with and without it: {with:?} {without:?}");
}

#[test]
fn frame_of_a_camera_that_was_not_added_is_refused() {
    let mut scene = Scene::new();
    let start = Pose2::new(-0.5, 0.2, 0.4);
    let Moment { first: (image, mount), .. } = moments(&mut scene, start, 1).remove(0);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut localizer = localizer(&scene, start, &mut rng);
    let refused = localizer.update_from(1, &image, &mount, &mut rng);
    assert!(matches!(refused, Err(ColorModelError::OutOfRange { what: "number of a camera", .. })));
    assert!(localizer.update_from(0, &image, &mount, &mut rng).is_ok());
}
