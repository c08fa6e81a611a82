//! The whole localizer in a random field.

mod common;

use common::{Field, drifting, lap};
use nalgebra::Vector3;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_appearance_cml::{AppearanceLocalizer, LocalizerParams, Start};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_gaussian_core::Gaussian;

fn exactly_at(pose: Pose2<f64>) -> Gaussian<Pose2<f64>> {
    Gaussian::from_sigmas(pose, &Vector3::new(0.02, 0.02, 0.02)).expect("sigmas are positive")
}

fn run(params: LocalizerParams, laps: usize, seed: u64) -> (Vec<f64>, usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let field = Field::new(1.0, 20.0, &mut rng);
    let way = lap(14.0, 8.0, 160);
    let mut localizer: AppearanceLocalizer<common::FieldView> =
        AppearanceLocalizer::new(params, Start::Known(exactly_at(way[0]))).expect("defaults are valid");
    let mut means = Vec::new();
    let mut dead = way[0];
    let mut dead_mean = 0.0;
    for k in 0..laps * way.len() {
        let (pose, next) = (way[k % way.len()], way[(k + 1) % way.len()]);
        localizer.update(field.view(&pose, 0.1, &mut rng)).expect("a good view");
        let error = (localizer.estimate().expect("known").mean().translation - pose.translation).norm();
        if k % way.len() == 0 {
            means.push(0.0);
        }
        *means.last_mut().expect("a lap has begun") += error / way.len() as f64;
        let step = pose.inverse().compose(&next);
        let odometry = drifting(&step, &mut rng);
        if k < way.len() {
            dead_mean += (dead.translation - pose.translation).norm() / way.len() as f64;
        }
        dead = dead.compose(&odometry);
        localizer.predict(&odometry).expect("finite odometry");
    }
    eprintln!("dead reckoning first lap {dead_mean}");
    let s = localizer.map().scale();
    eprintln!(
        "step {} E {} limit {} metres {} sigmas {:?}",
        s.step(),
        s.step_distance(),
        s.match_limit(0.8),
        s.metres(s.match_limit(0.8)),
        localizer.estimate().unwrap().sigmas()
    );
    (means, localizer.map().len())
}

#[test]
fn laps() {
    for seed in 0..4 {
        eprintln!("improved {:?}", run(LocalizerParams::default(), 5, seed));
        eprintln!("printed {:?}", run(LocalizerParams::printed(), 5, seed));
    }
}
