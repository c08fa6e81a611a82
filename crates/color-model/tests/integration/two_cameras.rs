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
fn odometry() -> OdometryStep {
    OdometryStep { increment: Some(Pose2::new(0.02, 0.0, 0.014)), seconds: 0.1 }
}

fn localizer(scene: &Scene, start: Pose2<f64>, rng: &mut ChaCha8Rng) -> ColorLocalizer {
    let search = GlobalSearchParams {
        n_buffered_frames: 4,
        samples_per_place: 0.15,
        n_refined_trajectories: 40,
        ..GlobalSearchParams::default()
    };
    let params = LocalizerParams { max_particles: 300, search, ..LocalizerParams::default() };
    let start = StartPosePrior::Near(Gaussian::from_sigmas(start, &Vector3::repeat(0.1)).unwrap());
    ColorLocalizer::new(scene.map.clone(), scene.camera, bank(), &start, params, rng).unwrap()
}

/// The errors in m at the end, with the second camera and without it, and how often a frame of the second one alone says `tracking` after a search was due.
fn errors(seed: u64) -> ([f64; 2], usize) {
    let mut scene = Scene::new();
    let start = Pose2::new(-0.5, 0.2, 0.4);
    let moments = moments(&mut scene, start, seed);
    let mut n_unconfirmed = 0;
    let errors = [true, false].map(|has_second| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut localizer = localizer(&scene, start, &mut rng);
        let second = localizer.add_camera(scene.camera);
        let mut at = start;
        for (number, Moment { first, second: other, body }) in moments.iter().enumerate() {
            localizer.predict(&odometry(), &mut rng).unwrap();
            at = at.compose(&odometry().increment.unwrap());
            if number < N_BOTH {
                let outcome = localizer.update(&first.0, &first.1, &mut rng).unwrap();
                at = *outcome.estimate.pose.mean();
            }
            if has_second {
                let outcome = localizer.update_from(second, &other.0, &other.1, &mut rng).unwrap();
                at = *outcome.estimate.pose.mean();
                let is_late = number > N_BOTH + 30;
                n_unconfirmed += usize::from(is_late && outcome.status == LocalizationStatus::Tracking);
            }
            if number + 1 == moments.len() {
                let first_light = localizer.light().member(0).mean()[0];
                assert!(
                    (first_light - 70.0).abs() < f64::from(DARKER) / 2.0,
                    "green of the first: {first_light}"
                );
                return body.local(&at).xy().norm();
            }
        }
        f64::NAN
    });
    (errors, n_unconfirmed)
}

#[test]
fn second_camera_keeps_the_place_while_the_first_is_silent() {
    let all = [1, 2, 3].map(errors);
    let mean = |at: usize| all.iter().map(|(errors, _)| errors[at] / 3.0).sum::<f64>();
    let [with, without] = [0, 1].map(mean);
    // What the system promises of the mean error.
    assert!(with < 0.1 && with < without, "{all:?}");
    // Only a search of the first camera confirms a place.
    assert!(all.iter().all(|(_, n_unconfirmed)| *n_unconfirmed == 0), "{all:?}");
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
