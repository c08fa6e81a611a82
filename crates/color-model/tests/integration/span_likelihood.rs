//! The span form against the pixel product that it stands for.

use std::f64::consts::PI;
use std::sync::Arc;

use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_color_map::{ColorId, ColorMap, ColoredShape, MapRenderer, PinholeCamera, PostBand};
use wayfix_color_model::{
    CameraPoseLikelihood, ColorDensity, ColorModelError, PixelLikelihood, PixelLikelihoodParams,
    PixelSpanLikelihood, PrefixSumImage, YuvImage,
};
use wayfix_estimation_traits::Pose3;

const COLUMNS: u32 = 52;
const ROWS: u32 = 40;

/// Carpet, two goals and three beacons: every kind of shape, surfaces that hide each other.
fn field() -> Arc<ColorMap> {
    let colors = ["green", "white", "yellow", "cyan", "pink"].map(str::to_owned).to_vec();
    let board = |color, corners: [[f64; 3]; 4]| ColoredShape::Polygon {
        color: ColorId(color),
        vertices: corners.map(Vector3::from).to_vec(),
    };
    let goal = |color, x: f64| board(color, [[x, -0.3, 0.0], [x, 0.3, 0.0], [x, 0.3, 0.3], [x, -0.3, 0.3]]);
    let beacon = |x, y, top| ColoredShape::Post {
        x,
        y,
        radius: 0.05,
        bands: vec![
            PostBand { color: ColorId(1), from: 0.0, to: 0.2 },
            PostBand { color: ColorId(4), from: 0.2, to: 0.3 },
            PostBand { color: ColorId(top), from: 0.3, to: 0.4 },
        ],
    };
    let shapes = vec![
        board(0, [[-2.0, -1.3, 0.0], [2.0, -1.3, 0.0], [2.0, 1.3, 0.0], [-2.0, 1.3, 0.0]]),
        board(1, [[-0.02, -1.3, 0.0], [0.02, -1.3, 0.0], [0.02, 1.3, 0.0], [-0.02, 1.3, 0.0]]),
        goal(2, -2.1),
        goal(3, 2.1),
        beacon(0.0, 1.5, 0),
        beacon(2.0, -1.5, 3),
        beacon(-2.0, 1.5, 2),
    ];
    Arc::new(ColorMap::new(colors, shapes).expect("valid by construction"))
}

fn camera() -> PinholeCamera {
    PinholeCamera::from_field_of_view(COLUMNS, ROWS, 1.0, 0.8).expect("valid by construction")
}

/// Smooth and noisy at once, so that regions have means as well as scatter.
fn image(rng: &mut ChaCha8Rng) -> YuvImage {
    let pixel = |at: u32| {
        let (column, row) = (at % COLUMNS, at / COLUMNS);
        [3 * row, 2 * column, row + column].map(|value| (value + rng.random_range(0..90_u32)).min(255) as u8)
    };
    YuvImage::new(COLUMNS, ROWS, (0..COLUMNS * ROWS).map(pixel).collect()).expect("valid by construction")
}

fn pose(rng: &mut ChaCha8Rng) -> Pose3<f64> {
    let mut between = |low: f64, high: f64| low + (high - low) * rng.random::<f64>();
    Pose3 {
        translation: Vector3::new(between(-2.0, 2.0), between(-1.3, 1.3), between(0.1, 0.3)),
        rotation: UnitQuaternion::from_euler_angles(between(-0.2, 0.2), between(-0.3, 0.6), between(-PI, PI)),
    }
}

fn light(rng: &mut ChaCha8Rng) -> Vec<ColorDensity> {
    let density = |_| {
        let root = Matrix3::from_fn(|_, _| rng.random_range(-4.0..4.0));
        let mean = Vector3::from_fn(|_, _| rng.random_range(30.0..220.0));
        ColorDensity { mean, covariance: root * root.transpose() + Matrix3::identity() * 30.0 }
    };
    (0..5).map(density).collect()
}

/// Most colours have a background, one in seven is an outlier.
fn nats([y, u, v]: [u8; 3]) -> Option<f64> {
    let mixed = u32::from(y) + 3 * u32::from(u) + 5 * u32::from(v);
    (!mixed.is_multiple_of(7)).then(|| 8.0 + f64::from(mixed % 97) / 13.0)
}

/// The largest difference, relative to the larger of the value and of one nat a labelled image.
fn largest_difference(params: PixelLikelihoodParams, n_poses: usize) -> f64 {
    let mut rng = ChaCha8Rng::seed_from_u64(20_261_121);
    let image = image(&mut rng);
    let frame = PrefixSumImage::with_background(&image, nats).expect("valid by construction");
    let renderer = || MapRenderer::new(field(), camera());
    let mut plain = PixelLikelihood::new(&image, nats, renderer(), params).expect("valid by construction");
    let mut spans = PixelSpanLikelihood::new(&frame, renderer(), params).expect("valid by construction");
    let (mut largest, mut n_seen) = (0.0_f64, 0);
    for _ in 0..n_poses {
        let (pose, light) = (pose(&mut rng), light(&mut rng));
        let (a, b) = (plain.log_likelihood(&pose, &light), spans.log_likelihood(&pose, &light));
        n_seen += usize::from(a != 0.0);
        largest = largest.max((a - b).abs() / a.abs().max(1.0));
    }
    assert!(n_seen > n_poses / 2, "most poses see the map: {n_seen}");
    largest
}

/// The plain product of Eq. 16; the image has outliers, whose cost must not hide the rest.
fn product() -> PixelLikelihoodParams {
    PixelLikelihoodParams { outlier_share: 1e-9, ..PixelLikelihoodParams::as_published() }
}

// Sums are exact integers, so what is left is rounding in one quadratic form a colour: 255² against variances of 30 and more cancel three
// of sixteen digits, and the sum over pixels of the plain form loses as many. The bound is the one the likelihood promises.
#[test]
fn spans_are_pixels_to_nine_digits() {
    assert!(largest_difference(product(), 10_000) < 1e-9);
}

#[test]
fn so_they_are_with_floor_and_margin() {
    let floored = PixelLikelihoodParams { outlier_share: 0.05, ..product() };
    assert!(largest_difference(floored, 1000) < 1e-9);
    let inner = PixelLikelihoodParams { edge_margin_pixels: 2, ..product() };
    assert!(largest_difference(inner, 300) < 1e-9);
}

#[test]
fn frames_of_another_size_are_refused() {
    let small = YuvImage::new(8, 8, vec![[0; 3]; 64]).expect("valid by construction");
    let frame = PrefixSumImage::new(&small).expect("valid by construction");
    let renderer = || MapRenderer::new(field(), camera());
    let expected = ColorModelError::FrameSize { expected: (52, 40), got: (8, 8) };
    assert_eq!(PixelSpanLikelihood::new(&frame, renderer(), product()).err(), Some(expected.clone()));
    assert_eq!(PixelLikelihood::new(&small, nats, renderer(), product()).err(), Some(expected));
}
