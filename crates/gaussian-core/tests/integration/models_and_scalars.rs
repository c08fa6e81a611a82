//! The adapters against the law suites, and the other scalar.

#![allow(clippy::unwrap_used, reason = "helpers of tests fail like tests")]

use approx::assert_abs_diff_eq;
use nalgebra::{Matrix1, Matrix3, RowVector3, Vector3};
use rand::{SeedableRng, distr::Distribution};
use rand_chacha::ChaCha8Rng;
use wayfix_estimation_traits::{Angle, Manifold, MotionModel, Pose2, SensorModel, laws};
use wayfix_gaussian_core::{
    Gaussian, GaussianLikelihood, GaussianMotionSampler, IntersectionCriterion, UnscentedParams,
    UnscentedTransform, covariance_intersection, moment_matched,
};

const SEED: u64 = 20_261_121;

struct Drive;

impl MotionModel for Drive {
    type State = Pose2<f64>;
    type Control = f64;
    fn propagate(&self, state: &Pose2<f64>, control: &f64) -> Pose2<f64> {
        state.retract(&Vector3::new(*control, 0.0, 0.2))
    }
    fn noise(&self, _: &Pose2<f64>, _: &f64) -> Matrix3<f64> {
        // Forward and heading noise go together and nothing slips sideways: singular.
        Matrix3::new(1e-2, 0.0, 5e-3, 0.0, 0.0, 0.0, 5e-3, 0.0, 1e-2)
    }
}

struct Bearing;

impl SensorModel for Bearing {
    type State = Pose2<f64>;
    type Measurement = Angle<f64>;
    fn expected(&self, state: &Pose2<f64>) -> Angle<f64> {
        let seen = state.inverse_transform(&nalgebra::Vector2::new(5.0, 0.0));
        Angle::new(seen.y.atan2(seen.x))
    }
    fn noise(&self, _: &Pose2<f64>) -> Matrix1<f64> {
        Matrix1::new(0.01)
    }
}

#[test]
fn samples_of_a_singular_motion_have_its_moments() {
    let starts = [(Pose2::new(0.0, 0.0, 0.0), &1.0), (Pose2::new(3.0, 1.0, 3.1), &-0.5)];
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    laws::motion(&Drive, &starts).unwrap();
    laws::sample_motion(&GaussianMotionSampler(Drive), &Drive, &starts, 10_000, &mut rng).unwrap();
}

#[test]
fn the_likelihood_of_a_bearing_peaks_across_the_wrap() {
    let facing_away = Pose2::new(0.0, 0.0, std::f64::consts::PI);
    laws::sensor(&Bearing, &[facing_away, Pose2::new(0.0, 0.0, 0.0)]).unwrap();
    let others = [-3.0, 3.0, 0.0].map(|heading| Pose2::new(0.0, 0.0, heading));
    laws::likelihood(&GaussianLikelihood(Bearing), &Angle::new(-std::f64::consts::PI), &facing_away, &others)
        .unwrap();
}

#[test]
fn merging_poses_gives_the_moments_of_their_samples() {
    let pose = |x, heading| {
        Gaussian::from_sigmas(Pose2::new(x, 0.0, heading), &Vector3::new(0.05, 0.1, 0.05)).unwrap()
    };
    let components = [pose(0.0, 3.05), pose(0.3, -3.1)];
    let merged = moment_matched(&[0.4, 0.6], &components).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(SEED);
    let samples = |of: usize, n: usize, rng: &mut ChaCha8Rng| -> Vec<Vector3<f64>> {
        let sampler = components[of].sampler();
        (0..n).map(|_| merged.mean().local(&sampler.sample(rng))).collect()
    };
    let all = [samples(0, 8000, &mut rng), samples(1, 12_000, &mut rng)].concat();
    let n = all.len() as f64;
    let scatter = all.iter().map(|d| d * d.transpose()).sum::<Matrix3<f64>>() / n;
    for i in 0..3 {
        let variance = merged.covariance()[(i, i)];
        let mean = all.iter().map(|d| d[i]).sum::<f64>() / n;
        // Five standard errors; planar poses add no bend, since their translation is linear in the chart.
        assert!(mean.abs() < 5.0 * (variance / n).sqrt());
        assert_abs_diff_eq!(scatter[(i, i)], variance, epsilon = 5.0 * variance * (2.0 / n).sqrt());
    }
}

#[test]
fn single_precision_follows_double() {
    let doubles = [
        (Vector3::new(1.0, 2.0, 3.1), Vector3::new(0.1, 0.2, 0.05)),
        (Vector3::new(1.1, 1.9, -3.1), Vector3::new(0.2, 0.1, 0.05)),
    ];
    let wide = doubles.map(|(m, s)| Gaussian::from_sigmas(Pose2::new(m.x, m.y, m.z), &s).unwrap());
    let narrow = doubles.map(|(m, s)| {
        let (m, s) = (m.cast::<f32>(), s.cast::<f32>());
        Gaussian::from_sigmas(Pose2::new(m.x, m.y, m.z), &s).unwrap()
    });
    let close = |a: f64, b: f64| (a - b).abs() < 1e-4 * b.abs().max(1.0); // a thousand roundings of f32
    assert!(close(narrow[0].kl_divergence(&narrow[1]).unwrap(), wide[0].kl_divergence(&wide[1]).unwrap()));
    let (p32, p64) = (narrow[0].product(&narrow[1]).unwrap(), wide[0].product(&wide[1]).unwrap());
    assert!((p32.covariance().cast::<f64>() - p64.covariance()).norm() < 1e-3 * p64.covariance().norm());
    let c32 = covariance_intersection(&narrow, IntersectionCriterion::Trace).unwrap();
    let c64 = covariance_intersection(&wide, IntersectionCriterion::Trace).unwrap();
    assert!(close(f64::from(c32.gaussian.covariance().trace()), c64.gaussian.covariance().trace()));
    let bearing = |pose: &Pose2<f32>| Angle::new(pose.heading());
    let transformed = UnscentedTransform::new(&narrow[0], bearing, &UnscentedParams::default()).unwrap();
    assert!(close(f64::from(transformed.covariance()[(0, 0)]), 0.0025));
    let by_jacobian = narrow[0].linearized(bearing, &RowVector3::new(0.0, 0.0, 1.0)).unwrap();
    assert!(close(f64::from(by_jacobian.covariance()[(0, 0)]), 0.0025));
}
