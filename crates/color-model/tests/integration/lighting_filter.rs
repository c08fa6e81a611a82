//! The lighting filter beside the general Kalman filter, and what it does about colours that nobody sees.

use crate::support;

use crate::support::{BRIGHT, common_gain, filter, means, noisy, random_prior};
use nalgebra::{DMatrix, DVector, Vector3};
use rand::{RngExt, SeedableRng, distr::Distribution};
use rand_chacha::ChaCha8Rng;
use wayfix_color_map::ColorId;
use wayfix_color_model::{LightingDrift, LightingFilter, LightingFilterParams, UnseenColorRule};
use wayfix_kalman::{KalmanFilter, LinearMotion, LinearSensor};

const WALK: LightingDrift = LightingDrift::RandomWalk(Vector3::new(4.0, 1.0, 1.0));

/// The rows that an image shows, as a sensor of the general filter.
fn sensor(n_colors: usize, hidden: u32, noise: &Vector3<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let rows: Vec<usize> = (0..3 * n_colors).filter(|row| hidden & (1 << (row / 3)) == 0).collect();
    let matrix =
        DMatrix::from_fn(rows.len(), 3 * n_colors, |row, column| f64::from(u8::from(rows[row] == column)));
    let noise = DVector::from_iterator(rows.len(), rows.iter().map(|row| noise[row % 3]));
    (matrix, DMatrix::from_diagonal(&noise))
}

#[test]
fn scalar_updates_are_the_joint_update_of_the_general_filter() {
    let mut rng = ChaCha8Rng::seed_from_u64(401);
    for n_colors in [1, 2, 5, 9] {
        let prior = random_prior(n_colors, &mut rng);
        let params = LightingFilterParams { lighting_drift: WALK, ..LightingFilterParams::default() };
        let mut ours = filter(prior.clone(), params);
        let seconds = 0.04;
        let walk = DVector::from_fn(3 * n_colors, |i, _| [4.0, 1.0, 1.0][i % 3] * seconds);
        let motion = LinearMotion::stationary(DMatrix::from_diagonal(&walk)).expect("valid by construction");
        let mut general = KalmanFilter::new(motion, prior.clone()).expect("valid by construction");
        for _ in 0..60 {
            let hidden = rng.random_range(0..(1 << n_colors) - 1);
            let truth = noisy(prior.mean(), &params.mean_color_variance, &mut rng);
            let (matrix, noise) = sensor(n_colors, hidden, &params.mean_color_variance);
            let z = &matrix * &truth;
            ours.predict(seconds).expect("valid by construction");
            general.predict(None).expect("valid by construction");
            let evidence = ours.update(&means(&truth, hidden)).expect("valid by construction");
            let sensor = LinearSensor::new(matrix, noise).expect("valid by construction");
            let innovation = general.update(&sensor, &z).expect("valid by construction");
            let expected = innovation.log_likelihood();
            // Both are exact but for rounding: condition about 1e3, 15 to 27 numbers, 60 steps.
            assert!((evidence - expected).abs() < 1e-10 * expected.abs().max(1.0), "{evidence} {expected}");
            let belief = general.estimate();
            assert!((ours.mean() - belief.mean()).amax() < 1e-10 * belief.mean().amax());
            assert!((ours.covariance() - belief.covariance()).amax() < 1e-10 * prior.covariance().amax());
        }
        assert_eq!(ours.covariance(), &ours.covariance().transpose(), "symmetric to the bit");
    }
}

#[test]
fn colour_densities_are_covariance_blocks_plus_pixel_noise() {
    let prior = random_prior(5, &mut ChaCha8Rng::seed_from_u64(402));
    let light = filter(prior.clone(), LightingFilterParams::default());
    for (color, density) in light.colors().enumerate() {
        let block = prior.covariance().fixed_view::<3, 3>(3 * color, 3 * color);
        assert_eq!((density.covariance - block)[(1, 0)], 0.0);
        assert_eq!(density.covariance[(1, 1)], block[(1, 1)] + light.params().pixel_color_variance.y);
        assert_eq!(density.mean, prior.mean().fixed_rows::<3>(3 * color).into_owned());
    }
}

/// Determinant of a colour's own belief, without the noise of its pixels.
fn volume(light: &LightingFilter, color: usize) -> f64 {
    light.covariance().fixed_view::<3, 3>(3 * color, 3 * color).into_owned().determinant()
}

#[test]
fn only_regression_shrinks_unseen_colours() {
    // Pink is independent of everything: no other colour says anything about it.
    let mut covariance = common_gain(&BRIGHT, 0.3).covariance().clone();
    for i in 0..12 {
        for j in 12..15 {
            (covariance[(i, j)], covariance[(j, i)]) = (0.0, 0.0);
        }
    }
    let prior = wayfix_gaussian_core::Gaussian::new(support::stacked(&BRIGHT), covariance)
        .expect("valid by construction");
    let still = LightingFilterParams {
        lighting_drift: LightingDrift::RandomWalk(Vector3::zeros()),
        ..LightingFilterParams::default()
    };
    let mut exact = filter(prior.clone(), still);
    let mut regressing =
        filter(prior.clone(), LightingFilterParams { unseen_colors: UnseenColorRule::Regress, ..still });
    let before = volume(&exact, 4);
    let n_images = 50;
    for _ in 0..n_images {
        for light in [&mut exact, &mut regressing] {
            light.update(&means(prior.mean(), 0b10000)).expect("valid by construction");
        }
    }
    assert_eq!(volume(&exact, 4), before, "nothing was said about pink");
    // As if pink had been seen 50 times: along each axis λ becomes at most ν / 50.
    assert!(volume(&regressing, 4) <= still.mean_color_variance.product() / f64::from(n_images).powi(3));
    assert_eq!(exact.color(ColorId(4)).mean, regressing.color(ColorId(4)).mean);
}

#[test]
fn an_unseen_colour_keeps_what_its_correlations_leave_open() {
    let prior = common_gain(&BRIGHT, 0.3);
    let still = LightingFilterParams {
        lighting_drift: LightingDrift::RandomWalk(Vector3::zeros()),
        ..LightingFilterParams::default()
    };
    let (mut exact, mut regressing) = (
        filter(prior.clone(), still),
        filter(prior.clone(), LightingFilterParams { unseen_colors: UnseenColorRule::Regress, ..still }),
    );
    // As many looks at the other four as make them certain.
    for _ in 0..10_000 {
        for light in [&mut exact, &mut regressing] {
            light.update(&means(prior.mean(), 0b10000)).expect("valid by construction");
        }
    }
    let others: Vec<usize> = (0..12).collect();
    let known = prior.mean().rows(0, 12).into_owned();
    let left = prior.conditional(&others, &known).expect("valid by construction");
    // 10 000 looks leave a hundredth of a percent of the noise: 64e-4 against variances of 25 and more.
    let block = exact.covariance().fixed_view::<3, 3>(12, 12);
    let off = (block - left.covariance()).amax();
    assert!(off < 0.05, "{off}");
    assert!(block.determinant() < 0.5 * volume(&filter(prior, still), 4), "correlation says something");
    assert!(volume(&regressing, 4) < 1e-6 * block.determinant(), "certain of what nobody saw");
}

#[test]
fn printed_and_exact_filter_agree_when_all_colours_are_seen() {
    let mut rng = ChaCha8Rng::seed_from_u64(403);
    let prior = random_prior(5, &mut rng);
    let mut exact = filter(prior.clone(), LightingFilterParams::default());
    let regress =
        LightingFilterParams { unseen_colors: UnseenColorRule::Regress, ..LightingFilterParams::default() };
    let mut regressing = filter(prior.clone(), regress);
    for light in [&mut exact, &mut regressing] {
        light.predict(0.1).expect("valid by construction");
        light.update(&means(prior.mean(), 0)).expect("valid by construction");
    }
    assert_eq!(exact.covariance(), regressing.covariance());
}

#[test]
fn the_estimate_moves_to_the_truth_and_knows_how_far_it_is_off() {
    let mut rng = ChaCha8Rng::seed_from_u64(404);
    let still = LightingFilterParams {
        lighting_drift: LightingDrift::RandomWalk(Vector3::zeros()),
        ..LightingFilterParams::default()
    };
    let (n_venues, n_images) = (400, 20);
    let mut nees = 0.0;
    for _ in 0..n_venues {
        let prior = common_gain(&BRIGHT, 0.3);
        let truth = prior.sampler().sample(&mut rng);
        let mut light = filter(prior, still);
        for _ in 0..n_images {
            let seen = noisy(&truth, &still.mean_color_variance, &mut rng);
            light.update(&means(&seen, rng.random_range(0..32))).expect("valid by construction");
        }
        let error = light.mean() - &truth;
        let belief = wayfix_gaussian_core::Gaussian::new(light.mean().clone(), light.covariance().clone());
        nees +=
            belief.expect("valid by construction").mahalanobis_squared(&truth).unwrap() / f64::from(n_venues);
        assert!(error.amax() < 12.0, "{error}"); // five standard deviations of what ten looks leave
    }
    // Mean of 400 chi-squared variables with 15 degrees: standard deviation (30/400)^½ = 0.27, four of them.
    assert!((nees - 15.0).abs() < 1.1, "{nees}");
}

#[test]
fn five_hundred_frames_without_a_colour_never_make_it_surer() {
    let prior = common_gain(&BRIGHT, 0.3);
    for drift in [WALK, LightingDrift::TowardsPrior(5.0)] {
        let mut light = filter(
            prior.clone(),
            LightingFilterParams { lighting_drift: drift, ..LightingFilterParams::default() },
        );
        light.update(&means(&(prior.mean() * 0.8), 0)).expect("valid by construction");
        let nothing = means(prior.mean(), 0b11111);
        for _ in 0..500 {
            let before: Vec<f64> = light.colors().map(|color| color.covariance.determinant()).collect();
            light.predict(0.04).expect("valid by construction");
            assert_eq!(light.update(&nothing).expect("valid by construction"), 0.0);
            let wider =
                |(now, then): (wayfix_color_model::ColorDensity, &f64)| now.covariance.determinant() > *then;
            assert!(light.colors().zip(&before).all(wider));
        }
        let prior = filter(prior.clone(), LightingFilterParams::default());
        for (now, prior) in light.colors().zip(prior.colors()) {
            let ratio = now.covariance.determinant() / prior.covariance.determinant();
            match drift {
                // 20 s are four time constants: e⁻⁸ of the difference is left, and never is it wider.
                LightingDrift::TowardsPrior(_) => assert!((0.99..=1.0 + 1e-12).contains(&ratio), "{ratio}"),
                LightingDrift::RandomWalk(_) => {}
            }
        }
    }
}

#[test]
fn drift_depends_on_the_time_and_not_on_the_number_of_steps() {
    let prior = common_gain(&BRIGHT, 0.3);
    for drift in [WALK, LightingDrift::TowardsPrior(3.0)] {
        let params = LightingFilterParams { lighting_drift: drift, ..LightingFilterParams::default() };
        let mut once = filter(prior.clone(), params);
        once.update(&means(&(prior.mean() * 0.9), 0b01100)).expect("valid by construction");
        let mut often = once.clone();
        once.predict(2.0).expect("valid by construction");
        for _ in 0..50 {
            often.predict(0.04).expect("valid by construction");
        }
        // Fifty roundings.
        assert!((once.mean() - often.mean()).amax() < 1e-11);
        assert!((once.covariance() - often.covariance()).amax() < 1e-10);
    }
}
