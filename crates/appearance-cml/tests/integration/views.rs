//! The laws of descriptors on pictures, and what is refused.
#![expect(clippy::unwrap_used, reason = "a panic is the verdict of a test, in its helpers too")]

use approx::abs_diff_eq;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_appearance_cml::{
    AppearanceMapError, AzimuthDirection, Panorama, PanoramaDescriptor, PanoramaDescriptorExtractor,
    PanoramaDescriptorParams, ViewDescriptor,
};

const COLUMNS: usize = 120;
const ROWS: usize = 12;
const PICTURE_SEED: u64 = 4;

/// Blocks of random greys, 8 columns wide: a scene with detail at every scale that the harmonics see.
fn scene(rng: &mut ChaCha8Rng) -> Panorama {
    let blocks: Vec<u8> = (0..COLUMNS / 8 * ROWS).map(|_| rng.random_range(20..230)).collect();
    let grey = |index: usize| blocks[index / COLUMNS * (COLUMNS / 8) + index % COLUMNS / 8];
    let bytes = (0..COLUMNS * ROWS).flat_map(|index| [grey(index); 3]).collect();
    Panorama::from_rgb(COLUMNS, ROWS, bytes).unwrap()
}

fn features(params: PanoramaDescriptorParams) -> PanoramaDescriptorExtractor {
    PanoramaDescriptorExtractor::new(params, COLUMNS, ROWS).unwrap()
}

fn scenes(n: usize) -> Vec<Panorama> {
    let mut rng = ChaCha8Rng::seed_from_u64(PICTURE_SEED);
    (0..n).map(|_| scene(&mut rng)).collect()
}

#[test]
fn view_distance_is_zero_to_itself_and_symmetric() {
    let features = features(PanoramaDescriptorParams::default());
    let views: Vec<PanoramaDescriptor> =
        scenes(30).iter().map(|scene| features.describe(scene).unwrap()).collect();
    for (index, a) in views.iter().enumerate() {
        assert_eq!((a.compare(a).distance, a.compare(a).rotation), (0.0, 0.0));
        for b in &views[..index] {
            let (there, back) = (a.compare(b), b.compare(a));
            assert!(there.distance > 0.5, "unrelated scenes: {}", there.distance);
            assert_eq!((there.distance, there.rotation), (back.distance, -back.rotation));
        }
    }
}

#[test]
fn smoothing_brings_views_nearer_and_nothing_further() {
    let distances = |smoothing| {
        let features = features(PanoramaDescriptorParams {
            smoothing_sigma: smoothing,
            ..PanoramaDescriptorParams::default()
        });
        let views: Vec<PanoramaDescriptor> =
            scenes(8).iter().map(|scene| features.describe(scene).unwrap()).collect();
        views[1..].iter().map(|view| views[0].compare(view).distance).collect::<Vec<f64>>()
    };
    let by_strength = [0.0, 1.0, 2.0].map(distances);
    for ((sharp, smooth), smoother) in by_strength[0].iter().zip(&by_strength[1]).zip(&by_strength[2]) {
        assert!(sharp > smooth && smooth > smoother, "{sharp} {smooth} {smoother}");
    }
}

#[test]
fn the_triangle_inequality_holds() {
    let features = features(PanoramaDescriptorParams::default());
    let views: Vec<PanoramaDescriptor> =
        scenes(12).iter().map(|scene| features.describe(scene).unwrap()).collect();
    let distance = |a: usize, b: usize| views[a].compare(&views[b]).distance;
    for (a, b, c) in (0..12 * 12 * 12).map(|i| (i % 12, i / 12 % 12, i / 144)) {
        assert!(distance(a, b) <= distance(a, c) + distance(c, b) + 1e-12, "{a} {b} {c}");
    }
}

#[test]
fn rotated_view_gives_the_turn_and_the_same_distance() {
    for (sense, sign) in [(AzimuthDirection::Clockwise, -1.0), (AzimuthDirection::Counterclockwise, 1.0)] {
        let features = features(PanoramaDescriptorParams {
            azimuth_direction: sense,
            ..PanoramaDescriptorParams::default()
        });
        let views = scenes(2);
        let [here, there] = [0, 1].map(|index: usize| features.describe(&views[index]).unwrap());
        for n in 0..COLUMNS {
            let turned = features.describe(&views[0].turned(n)).unwrap();
            let comparison = turned.compare(&here);
            let expected = sign * 3.0 * n as f64;
            let error = (comparison.rotation.to_degrees() - expected + 180.0).rem_euclid(360.0) - 180.0;
            // Rounding to 127 steps: 0.02 of distance, and as much over the slope of views that differ by 1 at 12°.
            assert!(comparison.distance < 0.02 && error.abs() < 0.25, "{n}: {comparison:?} {error}");
            let change = turned.compare(&there).distance - here.compare(&there).distance;
            assert!(change.abs() < 0.02, "{n}: {change}");
        }
    }
}

#[test]
fn a_turn_by_less_than_a_column_is_measured() {
    // Four times as many columns: the features see sectors of 3°, the camera turns by 0.75°.
    let fine = |shift: usize| {
        let grey = |i: usize| {
            let (row, x) = (i / 480, (i % 480 + shift) % 480);
            (128.0
                + 60.0 * (x as f64 * (row + 1) as f64 * 0.026).sin()
                + 40.0 * (x as f64 * 0.0654 * 3.0).cos()) as u8
        };
        Panorama::from_rgb(480, 8, (0..480 * 8).flat_map(|i| [grey(i); 3]).collect()).unwrap()
    };
    let features = PanoramaDescriptorExtractor::new(PanoramaDescriptorParams::default(), 480, 8).unwrap();
    let reference = features.describe(&fine(0)).unwrap();
    for shift in 1..8 {
        let seen = features.describe(&fine(shift)).unwrap().compare(&reference).rotation.to_degrees();
        assert!(abs_diff_eq!(seen, -0.75 * shift as f64, epsilon = 0.1), "{shift}: {seen}");
    }
}

#[test]
fn brighter_light_changes_little() {
    let features = features(PanoramaDescriptorParams::default());
    let scene = scenes(2);
    let lit = |gain: f64| {
        let bytes = scene[0].pixels().iter().flatten().map(|&value| (f64::from(value) * gain).round() as u8);
        Panorama::from_rgb(COLUMNS, ROWS, bytes.collect()).unwrap()
    };
    let [dim, full, other] =
        [&lit(0.5), &scene[0], &scene[1]].map(|panorama| features.describe(panorama).unwrap());
    // ln(8 + g) differs from ln g by up to 0.34 at the darkest, 20 · 0.5, of a range of 2.4.
    let ratio = dim.compare(&full).distance / other.compare(&full).distance;
    assert!(ratio < 0.15, "half the light is {ratio} of another scene");
}

#[test]
fn what_shows_nothing_is_refused() {
    let features = features(PanoramaDescriptorParams::default());
    let of = |bytes: Vec<u8>| features.describe(&Panorama::from_rgb(COLUMNS, ROWS, bytes).unwrap());
    for grey in [3, 77, 240] {
        let blank = of(vec![grey; COLUMNS * ROWS * 3]);
        assert!(matches!(blank, Err(AppearanceMapError::BlankView { .. })), "{grey}: {blank:?}");
    }
    for grey in [0, 255] {
        let saturated = of(vec![grey; COLUMNS * ROWS * 3]);
        assert!(
            matches!(saturated, Err(AppearanceMapError::SaturatedView { share: 1.0, .. })),
            "{saturated:?}"
        );
    }
    let smaller = Panorama::from_rgb(COLUMNS, ROWS - 1, vec![7; COLUMNS * (ROWS - 1) * 3]).unwrap();
    let expected = AppearanceMapError::ViewSize { expected: (COLUMNS, ROWS), got: (COLUMNS, ROWS - 1) };
    assert_eq!(features.describe(&smaller), Err(expected));
}

#[test]
fn parameters_outside_their_range_are_named() {
    let good = PanoramaDescriptorParams::default();
    for (params, named) in [
        (PanoramaDescriptorParams { n_rings: 0, ..good }, "n_rings"),
        (PanoramaDescriptorParams { n_rings: 65, ..good }, "n_rings"),
        (PanoramaDescriptorParams { n_sectors: 2, ..good }, "n_sectors"),
        (PanoramaDescriptorParams { n_harmonics: 1, ..good }, "n_harmonics"),
        (PanoramaDescriptorParams { n_harmonics: 61, ..good }, "n_harmonics"),
        (PanoramaDescriptorParams { smoothing_sigma: f64::NAN, ..good }, "smoothing_sigma"),
        (PanoramaDescriptorParams { smoothing_sigma: -1.0, ..good }, "smoothing_sigma"),
        (PanoramaDescriptorParams { min_contrast: f64::NAN, ..good }, "min_contrast"),
        (PanoramaDescriptorParams { max_saturated_share: -0.1, ..good }, "max_saturated_share"),
    ] {
        let refused = PanoramaDescriptorExtractor::new(params, COLUMNS, ROWS).unwrap_err();
        assert!(matches!(refused, AppearanceMapError::Parameter { what, .. } if what == named), "{refused}");
    }
    for (columns, rows) in [(0, 0), (COLUMNS, 0), (0, ROWS), (30, ROWS)] {
        assert!(PanoramaDescriptorExtractor::new(good, columns, rows).is_err(), "{columns} × {rows}");
    }
}

#[test]
fn invalid_spectrum_is_refused_and_other_shape_is_far() {
    let good = PanoramaDescriptor::from_parts(0.01, 2, vec![1; 6]).unwrap();
    let parts = (good.scale(), good.n_rings(), good.coefficients());
    assert_eq!(PanoramaDescriptor::from_parts(parts.0, parts.1, parts.2).unwrap(), good);
    for (scale, n_rings, coefficients) in [
        (f32::NAN, 2, vec![1; 6]),
        (0.0, 2, vec![1; 6]),
        (0.01, 0, vec![]),
        (0.01, 0, vec![1; 6]),
        (0.01, 2, vec![1; 8]),
        (0.01, 2, vec![1; 7]),
        (0.01, 1, vec![1; 129]),
        (0.01, 2, vec![-128; 6]),
    ] {
        assert!(PanoramaDescriptor::from_parts(scale, n_rings, coefficients).is_err());
    }
    let other = PanoramaDescriptor::from_parts(0.01, 1, vec![1; 3]).unwrap();
    assert_eq!(good.compare(&other).distance, f64::INFINITY);
}
