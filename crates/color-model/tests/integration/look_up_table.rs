//! The table beside the classifier that it was compiled from.

use crate::support;

use crate::support::{BRIGHT, common_gain, filter, means, normal};
use nalgebra::{Matrix3, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_color_model::{
    BackgroundColorModel, ColorDensity, ColorLookUpTable, LightingFilter, LightingFilterParams,
    PixelClassifier, PixelLikelihoodParams, YuvImage, find_blobs,
};

/// A view of the field as a cheap camera has it: patches of the five colours and of clutter, shaded, vignetted, blurred at edges, with noise.
fn frame(light: &LightingFilter, rng: &mut ChaCha8Rng) -> YuvImage {
    let (width, height) = (208, 160);
    let sites: Vec<(f64, f64, Vector3<f64>)> = (0..25)
        .map(|at| {
            let clutter = Vector3::from_fn(|i, _| 128.0 + [45.0, 20.0, 20.0][i] * normal(rng));
            let color = light.colors().nth(at % 8).map_or(clutter, |color| color.mean);
            (rng.random_range(0.0..208.0), rng.random_range(0.0..160.0), color)
        })
        .collect();
    let noise = light.params().pixel_color_variance.map(f64::sqrt);
    let pixels = (0..width * height).map(|at| {
        let (u, v) = (f64::from(at % width), f64::from(at / width));
        let mut by_distance: Vec<(f64, &Vector3<f64>)> =
            sites.iter().map(|(x, y, color)| ((u - x).hypot(v - y), color)).collect();
        by_distance.sort_by(|a, b| a.0.total_cmp(&b.0));
        let [(near, color), (far, other), ..] = by_distance[..] else { unreachable!() };
        // Across an edge three pixels wide two colours mix.
        let share = (0.5 - 0.25 * (far - near)).max(0.0);
        let shade = 1.0 - 0.2 * ((u - 104.0).hypot(v - 80.0) / 131.0).powi(2);
        let mixed = color * (1.0 - share) + *other * share;
        // Half of the scatter is shade that changes slowly, half is the sensor's.
        let mut noisy = |i: usize, value: f64| value + 0.7 * noise[i] * normal(rng);
        let [y, u, v] = [mixed.x * shade, mixed.y, mixed.z];
        [noisy(0, y), noisy(1, u), noisy(2, v)].map(|value| value.round().clamp(0.0, 255.0) as u8)
    });
    YuvImage::new(width, height, pixels.collect()).expect("valid by construction")
}

fn light(gain: f64) -> LightingFilter {
    let mut light = filter(common_gain(&BRIGHT, 0.3), LightingFilterParams::default());
    light.update(&means(&(support::stacked(&BRIGHT) * gain), 0)).expect("valid by construction");
    light
}

/// What the localizer classifies by.
fn densities(light: &LightingFilter) -> Vec<ColorDensity> {
    PixelLikelihoodParams::default().shaded(light.colors())
}

#[test]
fn the_table_agrees_with_the_classifier_on_natural_frames() {
    let mut rng = ChaCha8Rng::seed_from_u64(441);
    for gain in [0.7, 1.0] {
        let light = light(gain);
        for background in [None, Some(BackgroundColorModel::Uniform)] {
            let mut classifier = PixelClassifier::new(densities(&light)).unwrap();
            if let Some(background) = &background {
                classifier = classifier.with_background(background.clone());
            }
            let table = ColorLookUpTable::new(densities(&light), background.clone()).unwrap();
            let (mut equal, mut total) = (0, 0);
            for _ in 0..6 {
                let frame = frame(&light, &mut rng);
                let labels = table.classify_image(&frame);
                let exact = classifier.classify_image(&frame);
                equal += labels.iter().zip(&exact).filter(|(a, b)| a == b).count();
                total += labels.len();
                assert!(!find_blobs(&labels, 208).unwrap().is_empty());
            }
            let share = f64::from(equal as u32) / f64::from(total as u32);
            println!("gain {gain}, background {}: {share:.5}", background.is_some());
            assert!(share >= 0.995, "{share}");
        }
    }
}

#[test]
fn cells_hold_what_is_most_probable_at_their_centres() {
    let light = light(0.9);
    let table = ColorLookUpTable::new(densities(&light), None).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(442);
    let log = |density: &ColorDensity, at: Vector3<f64>| {
        let factor = density.covariance.cholesky().unwrap();
        let from_mean = at - density.mean;
        -0.5 * (factor.determinant().ln() + from_mean.dot(&factor.solve(&from_mean)))
    };
    let colors = densities(&light);
    for _ in 0..20_000 {
        let pixel: [u8; 3] = rng.random();
        let [y, u, v] = pixel;
        let centre = Vector3::new(f64::from(y & !3) + 1.5, f64::from(u), f64::from(v));
        let label = table.classify(pixel).expect("no background");
        let of_label = log(&colors[label.index()], centre);
        // Rounding of numbers up to some thousands.
        assert!(colors.iter().all(|color| log(color, centre) <= of_label + 1e-8), "{pixel:?}");
    }
}

#[test]
fn the_table_follows_the_light_and_only_then() {
    let mut light = light(1.0);
    let mut table = ColorLookUpTable::new(densities(&light), None).unwrap();
    assert!(!table.rebuild_if_changed(densities(&light)).unwrap());
    // A change far below a quarter of a standard deviation.
    light.update(&means(light.mean(), 0)).unwrap();
    assert!(!table.rebuild_if_changed(densities(&light)).unwrap());
    let darker = support::stacked(&BRIGHT) * 0.5;
    let mut n_rebuilt = 0;
    for _ in 0..40 {
        light.predict(1.0).unwrap();
        light.update(&means(&darker, 0)).unwrap();
        n_rebuilt += usize::from(table.rebuild_if_changed(densities(&light)).unwrap());
        assert!(
            !table.rebuild_if_changed(densities(&light)).unwrap(),
            "it is as the light is, or near enough"
        );
    }
    assert!((2..20).contains(&n_rebuilt), "{n_rebuilt}"); // it moves fast at first, then settles
    // Compiled anew when it settled: the same table as a fresh one where the light is as it was compiled for.
    table.rebuild_above = 0.0;
    table.rebuild_if_changed(densities(&light)).unwrap();
    let fresh = ColorLookUpTable::new(densities(&light), None).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(443);
    assert!((0..10_000).all(|_| {
        let pixel = rng.random();
        table.classify(pixel) == fresh.classify(pixel)
    }));
    table.rebuild_above = f64::NAN;
    assert!(
        table.rebuild_if_changed(densities(&light)).unwrap(),
        "what cannot be compared is no reason to trust the table"
    );
}

#[test]
fn a_more_frequent_background_takes_more() {
    let density =
        ColorDensity { mean: Vector3::new(100.0, 128.0, 128.0), covariance: Matrix3::identity() * 50.0 };
    let labels = |share| {
        let classifier = PixelClassifier::new([density])
            .unwrap()
            .with_background_share(BackgroundColorModel::Uniform, share)
            .unwrap();
        (0..=255).filter(|y| classifier.classify([*y, 128, 128]).is_some()).count()
    };
    // |y - 100| < (2 · 50 · (ln 2²⁴ - 1.5 ln 2π·50 - ln odds))^½, both sides and the middle.
    let radius = |odds: f64| {
        (100.0 * (2.0_f64.powi(24).ln() - 1.5 * (std::f64::consts::TAU * 50.0).ln() - odds.ln())).sqrt()
    };
    for share in [0.01, 0.5, 0.99_f64] {
        assert_eq!(labels(share), 2 * radius(share / (1.0 - share)).floor() as usize + 1);
    }
    for bad in [0.0, 1.0, -0.5, f64::NAN] {
        let classifier = PixelClassifier::new([density]).unwrap();
        assert!(classifier.with_background_share(BackgroundColorModel::Uniform, bad).is_err());
    }
}
