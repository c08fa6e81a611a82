//! Each sin of the range-bearing sensor, measured against what was asked for: within four standard errors of the statistic.

use approx::{abs_diff_eq, assert_abs_diff_eq};
use std::f64::consts::{FRAC_PI_2, PI};
use wayfix_scene_sim::random::NoiseShape;
use wayfix_scene_sim::sensor::RangeBearingParams;
use wayfix_scene_sim::sensor::range_bearing::{
    Clutter, ClutterIdentity, CorrelatedErrorParams, RangeDependentSigma,
};
use wayfix_scene_sim::world::{PlanarWorld, Wall};
use wayfix_sensor_log::{Detection, DetectionTarget};

use crate::support::{assert_near, assert_share, detections, deviation, looks, mean, streams, world};

const N: u64 = 40_000;
const SEED: u64 = 20_05;

fn honest() -> RangeBearingParams {
    RangeBearingParams::default()
}

fn silent() -> RangeBearingParams {
    RangeBearingParams { range_noise: RangeDependentSigma::default(), bearing_sigma_rad: 0.0, ..honest() }
}

fn ahead() -> PlanarWorld {
    world(&[(5.0, 0.0)])
}

fn ranges(seen: &[Detection]) -> Vec<f64> {
    seen.iter().map(|s| s.range).collect()
}

fn bearings(seen: &[Detection]) -> Vec<f64> {
    seen.iter().map(|s| s.bearing).collect()
}

#[test]
fn the_default_noise_is_that_of_the_shared_logs() {
    let seen = detections(honest(), &ahead(), N, SEED);
    let n = (N as f64).sqrt();
    assert_near("mean range", mean(&ranges(&seen)), 5.0, 0.05 / n);
    assert_near("σ of range", deviation(&ranges(&seen)), 0.05, 0.05 / (2.0_f64.sqrt() * n));
    assert_near("mean bearing", mean(&bearings(&seen)), 0.0, 0.01 / n);
    assert_near("σ of bearing", deviation(&bearings(&seen)), 0.01, 0.01 / (2.0_f64.sqrt() * n));
}

#[test]
fn heavy_tails_keep_sigma_and_have_the_stated_kurtosis() {
    // Standard error of σ is σ √((κ − 1) / 4n); κ is 6 for Laplace and 3 + 6/(ν − 4) for Student's t.
    for (tail, kurtosis) in [
        (NoiseShape::Laplace, 6.0),
        (NoiseShape::StudentT { degrees_of_freedom: 10.0 }, 4.0),
        (NoiseShape::Gaussian, 3.0),
    ] {
        let seen =
            ranges(&detections(RangeBearingParams { noise_shape: tail, ..honest() }, &ahead(), N, SEED));
        let standard_error = 0.05 * ((kurtosis - 1.0) / (4.0 * N as f64)).sqrt();
        assert_near("σ", deviation(&seen), 0.05, standard_error);
        let fourth = mean(&seen.iter().map(|r| ((r - 5.0) / 0.05).powi(4)).collect::<Vec<_>>());
        // The eighth moment, at most 2520 (Laplace), bounds the standard error of the fourth by √(2520/n) = 0.25.
        assert_near("kurtosis", fourth, kurtosis, 0.25);
    }
}

#[test]
fn noise_grows_with_range() {
    let growing = RangeDependentSigma { constant_m: 0.01, per_meter: 0.02 };
    let params = RangeBearingParams { range_noise: growing, ..honest() };
    for range in [1.0, 7.0] {
        let seen = ranges(&detections(params, &world(&[(range, 0.0)]), N, SEED));
        let sigma = 0.01 + 0.02 * range;
        assert_near("σ", deviation(&seen), sigma, sigma / (2.0 * N as f64).sqrt());
    }
}

#[test]
fn scale_and_bias_shift_every_reading() {
    let params =
        RangeBearingParams { range_bias_m: 0.2, range_scale: 1.1, bearing_bias_rad: -0.3, ..silent() };
    let seen = detections(params, &ahead(), 1, SEED);
    assert_abs_diff_eq!(seen[0].range, 5.7, epsilon = 1e-12);
    assert_abs_diff_eq!(seen[0].bearing, -0.3, epsilon = 1e-12);
}

#[test]
fn bearings_stay_wrapped() {
    let params = RangeBearingParams { bearing_bias_rad: 0.1, ..silent() };
    let seen = detections(params, &world(&[(-5.0, 0.1)]), 1, SEED);
    assert!(
        abs_diff_eq!(seen[0].bearing, 0.1 - 0.02 - PI, epsilon = 1e-5),
        "beyond π comes out near −π: {seen:?}"
    );
}

#[test]
fn drift_has_stated_size_and_correlation_time_per_target() {
    let drift = CorrelatedErrorParams {
        range_sigma: RangeDependentSigma { constant_m: 0.1, per_meter: 0.0 },
        bearing_sigma_rad: 0.02,
        correlation_time_s: 2.0,
    };
    let params = RangeBearingParams { drift, ..silent() };
    let two = world(&[(5.0, -1.0), (5.0, 1.0)]);
    let looks: Vec<Vec<Detection>> =
        looks(params, &two, N, &mut streams(SEED)).into_iter().flatten().collect();
    let errors = |id: u32| -> Vec<f64> {
        let range = 26.0_f64.sqrt();
        let of_id =
            |look: &Vec<Detection>| look.iter().find(|s| s.target == DetectionTarget::Landmark(id)).copied();
        looks.iter().filter_map(of_id).map(|s| s.range - range).collect()
    };
    let (first, second) = (errors(0), errors(1));
    // One look every 0.5 s: φ = e^(−1/4). Correlated samples are worth n (1 − φ²)/(1 + φ²) for a variance,
    // n (1 − φ)/(1 + φ) for a mean.
    let phi = (-0.25_f64).exp();
    let worth = N as f64 * (1.0 - phi * phi) / (1.0 + phi * phi);
    assert_near("mean of the drift", mean(&first), 0.0, 0.1 / (N as f64 * (1.0 - phi) / (1.0 + phi)).sqrt());
    assert_near("σ of the drift", deviation(&first), 0.1, 0.1 / (2.0 * worth).sqrt());
    let correlation = |a: &[f64], b: &[f64]| {
        mean(&a.iter().zip(b).map(|(a, b)| a * b).collect::<Vec<_>>()) / (deviation(a) * deviation(b))
    };
    let lag_one = correlation(&first[..first.len() - 1], &first[1..]);
    assert_near("correlation after one look", lag_one, phi, ((1.0 - phi * phi) / N as f64).sqrt());
    let lag_four = correlation(&first[..first.len() - 4], &first[4..]);
    assert_near("correlation after τ", lag_four, (-1.0_f64).exp(), 1.0 / worth.sqrt());
    assert_near("correlation between targets", correlation(&first, &second), 0.0, 1.0 / worth.sqrt());
}

#[test]
fn outliers_drop_outs_and_misses_come_in_the_shares_asked_for() {
    let n = N as usize;
    let outliers = detections(RangeBearingParams { outlier_share: 0.05, ..silent() }, &ahead(), N, SEED);
    assert_share("outliers", outliers.iter().filter(|s| (s.range - 5.0).abs() > 1e-9).count(), n, 0.05);

    let params = RangeBearingParams { scan_dropout_share: 0.1, ..silent() };
    let lost = looks(params, &ahead(), N, &mut streams(SEED)).iter().filter(|look| look.is_none()).count();
    assert_share("lost looks", lost, n, 0.1);

    let seen = detections(RangeBearingParams { missed_target_share: 0.2, ..silent() }, &ahead(), N, SEED);
    assert_share("missed", n - seen.len(), n, 0.2);
}

#[test]
fn outliers_are_anywhere_in_view() {
    let params = RangeBearingParams { outlier_share: 1.0, field_of_view_rad: FRAC_PI_2, ..silent() };
    let seen = detections(params, &ahead(), N, SEED);
    let (low, high) = (params.min_range_m, params.max_range_m);
    let of_uniform = |width: f64| width / 12.0_f64.sqrt() / (N as f64).sqrt();
    assert_near("mean range", mean(&ranges(&seen)), 0.5 * (low + high), of_uniform(high - low));
    assert_near("mean bearing", mean(&bearings(&seen)), 0.0, of_uniform(FRAC_PI_2));
    assert!(seen.iter().all(|s| s.bearing.abs() <= 0.5 * FRAC_PI_2 && s.range <= high));
}

#[test]
fn clutter_is_poisson_and_passes_for_what_was_asked() {
    for (label, passes) in [
        (ClutterIdentity::Unlabelled, (|t| t == DetectionTarget::Unlabelled) as fn(DetectionTarget) -> bool),
        (ClutterIdentity::AnyLandmark, |t| matches!(t, DetectionTarget::Landmark(0 | 1))),
        (ClutterIdentity::UnknownCode(77), |t| t == DetectionTarget::UnknownCode(77)),
    ] {
        let clutter = Clutter { mean: 0.7, label };
        // Landmarks out of reach: whatever is reported is clutter.
        let far = world(&[(500.0, 0.0), (600.0, 0.0)]);
        let looks = looks(RangeBearingParams { clutter, ..silent() }, &far, N, &mut streams(SEED));
        let counts: Vec<f64> = looks.iter().flatten().map(|look| look.len() as f64).collect();
        assert_near("mean count", mean(&counts), 0.7, (0.7 / N as f64).sqrt());
        // Var of the sample variance of a Poisson: (λ + 2λ²)/n.
        let variance = deviation(&counts).powi(2);
        assert_near("variance of the count", variance, 0.7, ((0.7 + 2.0 * 0.49) / N as f64).sqrt());
        assert!(looks.iter().flatten().flatten().all(|s| passes(s.target)));
    }
}

#[test]
fn mislabelled_sightings_bear_another_landmarks_identity() {
    let three = world(&[(5.0, 0.0), (0.0, 5.0), (0.0, -5.0)]);
    let params = RangeBearingParams { mislabelled_share: 0.1, ..silent() };
    let seen = detections(params, &three, N, SEED);
    let first: Vec<DetectionTarget> =
        seen.iter().filter(|s| s.bearing.abs() < 0.1).map(|s| s.target).collect();
    let count = |id| first.iter().filter(|t| **t == DetectionTarget::Landmark(id)).count();
    assert_share("right", count(0), first.len(), 0.9);
    assert_share("as the second", count(1), first.len(), 0.05);
    assert_share("as the third", count(2), first.len(), 0.05);
    let alone = RangeBearingParams { mislabelled_share: 1.0, ..silent() };
    assert_eq!(
        detections(alone, &ahead(), 1, SEED)[0].target,
        DetectionTarget::Landmark(0),
        "nobody else to be"
    );
}

#[test]
fn an_unlabelled_sensor_tells_nothing_apart() {
    let params = RangeBearingParams { labelled: false, mislabelled_share: 0.5, ..honest() };
    let seen = detections(params, &world(&[(5.0, 0.0), (0.0, 5.0)]), 100, SEED);
    assert_eq!(seen.len(), 200);
    assert!(seen.iter().all(|s| s.target == DetectionTarget::Unlabelled));
}

#[test]
fn range_view_and_walls_limit_what_is_seen() {
    let params =
        RangeBearingParams { min_range_m: 1.0, max_range_m: 6.0, field_of_view_rad: FRAC_PI_2, ..silent() };
    let mut scene = world(&[(0.9, 0.0), (5.9, 0.0), (6.1, 0.0), (3.0, 2.9), (3.0, 3.1), (3.0, -1.0)]);
    let ids = |scene: &PlanarWorld| -> Vec<DetectionTarget> {
        detections(params, scene, 1, SEED).iter().map(|s| s.target).collect()
    };
    assert_eq!(
        ids(&scene),
        [DetectionTarget::Landmark(5), DetectionTarget::Landmark(1), DetectionTarget::Landmark(3)]
    );
    let point = wayfix_estimation_traits::nalgebra::Vector2::new;
    scene.plan.walls.push(Wall { from: point(4.0, -1.0), to: point(4.0, 1.0) });
    assert_eq!(ids(&scene), [DetectionTarget::Landmark(5), DetectionTarget::Landmark(3)]);
}

#[test]
fn a_look_that_sees_nothing_is_logged_empty() {
    assert_eq!(looks(honest(), &world(&[]), 1, &mut streams(SEED)), [Some(vec![])]);
}
