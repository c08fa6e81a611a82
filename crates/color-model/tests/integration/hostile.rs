//! Whatever comes in, the light stays a light: an error leaves it as it was, and nothing makes it surer than it may be.

use crate::support;

use crate::support::{BRIGHT, common_gain, filter, means, random_prior};
use nalgebra::{DMatrix, DVector, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_color_model::{
    ColorMeans, ColorModelError, LightingDrift, LightingFilter, LightingFilterBank, LightingFilterParams,
    PixelClassifier, YuvImage, YuvStandard,
};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::MarkovChain;

fn refused(prior: Gaussian<DVector<f64>>, params: LightingFilterParams) -> ColorModelError {
    LightingFilter::new(prior, params).expect_err("not a light")
}

#[test]
fn priors_that_are_none_are_refused() {
    let unchecked = |n: usize, covariance| Gaussian::from_parts_unchecked(DVector::zeros(n), covariance);
    let params = LightingFilterParams::default();
    for n in [0, 1, 4, 3 * 257] {
        let error = refused(unchecked(n, DMatrix::identity(n, n)), params);
        assert!(matches!(error, ColorModelError::Dimension { got, .. } if got == n), "{n}: {error}");
    }
    assert!(matches!(
        refused(unchecked(6, DMatrix::identity(3, 3)), params),
        ColorModelError::Dimension { expected: 6, got: 3, .. }
    ));
    let mut indefinite = DMatrix::identity(3, 3);
    (indefinite[(0, 1)], indefinite[(1, 0)]) = (2.0, 2.0);
    let mut lopsided = DMatrix::identity(3, 3);
    lopsided[(0, 1)] = 0.5;
    for bad in [indefinite, lopsided, DMatrix::from_element(3, 3, f64::NAN), DMatrix::zeros(3, 3)] {
        assert!(matches!(refused(unchecked(3, bad), params), ColorModelError::Gaussian(_)));
    }
    // Next to a variance this large an image's mean would be without noise.
    let error = refused(unchecked(3, DMatrix::identity(3, 3) * 1e12), params);
    assert!(matches!(error, ColorModelError::OutOfRange { value: 1e12, .. }));
    let far = Gaussian::new(DVector::from_element(3, 1e200), DMatrix::identity(3, 3)).unwrap();
    assert!(matches!(refused(far, params), ColorModelError::OutOfRange { value: 1e200, .. }));
}

#[test]
fn invalid_parameters_are_refused() {
    let prior = common_gain(&BRIGHT, 0.3);
    let good = LightingFilterParams::default();
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e300, 1e-300] {
        let noise = Vector3::new(1.0, bad, 1.0);
        refused(prior.clone(), LightingFilterParams { pixel_color_variance: noise, ..good });
        refused(prior.clone(), LightingFilterParams { mean_color_variance: noise, ..good });
        refused(
            prior.clone(),
            LightingFilterParams { lighting_drift: LightingDrift::TowardsPrior(bad), ..good },
        );
        if !(0.0..1e12).contains(&bad) {
            refused(
                prior.clone(),
                LightingFilterParams { lighting_drift: LightingDrift::RandomWalk(noise), ..good },
            );
        }
    }
}

#[test]
fn what_is_refused_leaves_the_light_as_it_was() {
    let prior = common_gain(&BRIGHT, 0.3);
    let mut light = filter(prior.clone(), LightingFilterParams::default());
    light.update(&means(prior.mean(), 0b00110)).unwrap();
    let before = (light.mean().clone(), light.covariance().clone());
    for seconds in [-0.04, f64::NAN, f64::INFINITY] {
        assert!(light.predict(seconds).is_err());
    }
    for value in [f64::NAN, f64::INFINITY, 1e300] {
        let last = Some(Vector3::new(1.0, 1.0, value));
        let good = Some(Vector3::repeat(100.0));
        // The bad colour comes last: those before it must not have been used.
        assert!(
            light.update(&ColorMeans::new([good, good, None, None, last].map(|mean| (mean, 9)))).is_err()
        );
    }
    assert!(light.update(&ColorMeans::new([(None, 0)])).is_err());
    assert!(light.update(&ColorMeans::default()).is_err());
    assert_eq!(before, (light.mean().clone(), light.covariance().clone()));
    assert!(
        PixelClassifier::new([light.color(wayfix_color_map::ColorId(200))]).is_err(),
        "a colour that is not there"
    );
}

#[test]
fn hostile_steps_leave_every_colour_a_finite_density() {
    let mut rng = ChaCha8Rng::seed_from_u64(411);
    for run in 0..100 {
        let mut prior = random_prior(5, &mut rng);
        if run % 2 == 0 {
            // All colours nearly the same: condition 1e14.
            let all = DMatrix::from_element(15, 15, 900.0) + DMatrix::identity(15, 15) * 1e-9;
            prior = Gaussian::new(prior.mean().clone(), all).unwrap();
        }
        let drift = if run % 3 == 0 {
            LightingDrift::TowardsPrior(10.0_f64.powi(rng.random_range(-6..6)))
        } else {
            LightingDrift::RandomWalk(Vector3::repeat(10.0_f64.powi(rng.random_range(-12..12))))
        };
        let noise = Vector3::from_fn(|_, _| 10.0_f64.powi(rng.random_range(-4..8)));
        let params = LightingFilterParams {
            pixel_color_variance: noise,
            mean_color_variance: noise,
            lighting_drift: drift,
            ..LightingFilterParams::default()
        };
        let mut light = filter(prior, params);
        for _ in 0..1000 {
            light.predict(10.0_f64.powi(rng.random_range(-9..9))).unwrap();
            let state = DVector::from_fn(15, |_, _| 10.0_f64.powi(rng.random_range(-3..6)));
            let evidence = light.update(&means(&state, rng.random_range(0..32))).unwrap();
            assert!(evidence.is_finite());
        }
        assert_eq!(light.covariance(), &light.covariance().transpose());
        for color in light.colors() {
            let own = color.covariance - nalgebra::Matrix3::from_diagonal(&noise);
            assert!(color.covariance.cholesky().is_some() && color.mean.iter().all(|v| v.is_finite()));
            // Rounding takes no more than a part in 1e7 of the noise below zero.
            assert!(own.diagonal().iter().zip(noise.iter()).all(|(v, noise)| *v > -1e-7 * noise), "{own}");
        }
    }
}

#[test]
fn banks_that_do_not_fit_are_refused() {
    let chain = |n| MarkovChain::sticky(n, 0.9).unwrap();
    let light = |n| filter(common_gain(&BRIGHT[..n], 0.3), LightingFilterParams::default());
    assert!(LightingFilterBank::new(vec![], chain(1)).is_err());
    assert!(LightingFilterBank::new(vec![light(5)], chain(2)).is_err());
    assert!(LightingFilterBank::new(vec![light(5), light(4)], chain(2)).is_err());
    let mut bank = LightingFilterBank::new(vec![light(5), light(5)], chain(2)).unwrap();
    let good = means(&support::stacked(&BRIGHT), 0);
    assert_eq!(bank.update_member(2, &good), Err(ColorModelError::NoSuchMember { member: 2, n_members: 2 }));
    assert!(bank.update_member(0, &ColorMeans::default()).is_err() && bank.predict(f64::NAN).is_err());
    let mut rng = ChaCha8Rng::seed_from_u64(412);
    for bad in [vec![0.0], vec![f64::NAN, 0.0], vec![0.0, f64::INFINITY]] {
        assert!(bank.choose(&bad, &mut rng).is_err());
    }
}

#[test]
fn images_that_are_none_are_refused_and_plain_ones_are_images() {
    for (width, height, n_bytes) in [(0, 0, 0), (2, 2, 11), (2, 2, 13), (0, 5, 0), (u32::MAX, u32::MAX, 3)] {
        let bytes = vec![0; n_bytes];
        let error = YuvImage::from_rgb(width, height, &bytes, YuvStandard::Bt601Full).expect_err("no image");
        assert!(matches!(error, ColorModelError::ImageSize { got, .. } if got == n_bytes));
    }
    assert!(YuvImage::new(2, 1, vec![[0; 3]]).is_err());
    for value in [0, 255] {
        let flat = YuvImage::from_rgb(8, 8, &[value; 192], YuvStandard::Bt601Full).unwrap();
        assert!(flat.pixels().iter().all(|pixel| *pixel == [value, 128, 128]));
    }
}
