//! One frame of the colour localizer, and its parts, in nanoseconds: `cargo bench -p wayfix-color-model --bench localizer --features parallel`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`. The goal for the whole frame is 33 ms wall on two cores: 1000 particles, 208 × 160 pixels,
//! a bank of two.

use std::hint::black_box;
use std::sync::Arc;

use nalgebra::{DMatrix, DVector, UnitQuaternion, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_color_map::{ColorMap, MapRenderer, PinholeCamera};
use wayfix_color_model::{
    ColorLocalizer, ColorLookUpTable, ColorMeans, LightingFilter, LightingFilterBank, LightingFilterParams,
    LocalizerParams, PixelClassifier, PixelLikelihoodParams, PixelSums, PrefixSumImage, StartPosePrior,
    YuvImage, gather,
};
use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::MarkovChain;
use wayfix_scene_sim::league::field_map;

/// Y, U, V of green, white, yellow, cyan, pink.
const LIGHT: [[f64; 3]; 5] =
    [[70., 123., 113.], [130., 124., 120.], [116., 88., 140.], [90., 146., 104.], [103., 130., 162.]];

fn main() {
    let map = Arc::new(field_map().expect("a constant map"));
    let camera = PinholeCamera::from_field_of_view(208, 160, 0.993, 0.789).expect("an ERS-7");
    let body = Pose2::new(0.5, 0.2, 0.4);
    let mount = Pose3 {
        translation: Vector3::new(0.08, 0.0, 0.19),
        rotation: UnitQuaternion::from_euler_angles(0.0, 0.15, 0.0),
    };
    let camera_pose = Pose3 {
        translation: Vector3::new(body.x(), body.y(), 0.0),
        rotation: UnitQuaternion::from_euler_angles(0.0, 0.0, body.heading()),
    }
    .compose(&mount);
    let image = picture(&map, camera, &camera_pose);
    let frame = PrefixSumImage::new(&image).expect("not too wide");

    report("frame sums 208x160", 50, || PrefixSumImage::new(&image).map(|frame| frame.n_pixels()));
    let mut renderer = MapRenderer::new(Arc::clone(&map), camera);
    report("spans of a view", 2000, || {
        let mut n = 0;
        renderer.spans(&camera_pose, &mut |span| n += usize::from(span.end - span.start)).map(|()| n)
    });
    let mut sums = [PixelSums::default(); 5];
    report("spans and their sums", 2000, || {
        gather(&mut renderer, |_| Some(&frame), &camera_pose, 0, &mut sums)
    });
    report("inner spans and their sums", 2000, || {
        gather(&mut renderer, |_| Some(&frame), &camera_pose, 1, &mut sums)
    });
    let means = ColorMeans::new(sums.iter().map(|sums| (sums.mean(), sums.count())));
    let lit = bank();
    report("lighting update", 2000, || lit.clone().update_member(1, &means));

    let light = PixelLikelihoodParams::default().shaded(lit.member(1).colors());
    report("classify 208x160, exact", 20, || {
        PixelClassifier::new(light.iter().copied()).map(|exact| exact.classify_image(&image))
    });
    let table = ColorLookUpTable::new(light.clone(), None).expect("a proper light");
    report("classify 208x160, table", 50, || table.classify_image(&image));
    report("compile the table", 3, || ColorLookUpTable::new(light.clone(), None));

    let params = LocalizerParams::default();
    let start =
        StartPosePrior::Near(Gaussian::from_sigmas(body, &Vector3::new(0.05, 0.05, 0.05)).expect("sigmas"));
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut localizer =
        ColorLocalizer::new(Arc::clone(&map), camera, bank(), &start, params, &mut rng).expect("valid");
    report("frame, 1000 particles, bank of 2", 5, || {
        localizer.update(&image, &mount, &mut rng).map(|outcome| outcome.n_particles)
    });
}

/// The map in its light, with some noise, in front of grey.
fn picture(map: &Arc<ColorMap>, camera: PinholeCamera, pose: &Pose3<f64>) -> YuvImage {
    let labels = MapRenderer::new(Arc::clone(map), camera).labels(pose).expect("a finite pose");
    let paint = |(at, label): (usize, &Option<wayfix_color_map::ColorId>)| {
        let noise = (at * 7919 % 13) as f64 - 6.0;
        label.map_or([110.0, 128.0, 128.0], |color| LIGHT[color.index()]).map(|value| (value + noise) as u8)
    };
    let pixels = labels.pixels().iter().enumerate().map(paint).collect();
    YuvImage::new(labels.width(), labels.height(), pixels).expect("as many pixels as labels")
}

fn bank() -> LightingFilterBank {
    let filter = |share: f64| {
        let mean = DVector::from_iterator(15, LIGHT.into_iter().flatten().map(|v| share * v));
        let covariance = DMatrix::from_fn(15, 15, |i, j| if i == j { 150.0 } else { 80.0 });
        let prior = Gaussian::new(mean, covariance).expect("positive definite");
        LightingFilter::new(prior, LightingFilterParams::default()).expect("valid")
    };
    let chain = MarkovChain::sticky(2, 0.98).expect("a probability");
    LightingFilterBank::new(vec![filter(0.5), filter(1.0)], chain).expect("two of each")
}

/// Prints the best time of fifteen batches of `calls`.
fn report<O>(job: &str, calls: usize, mut run: impl FnMut() -> O) {
    let mut best = f64::INFINITY;
    for _ in 0..15 {
        #[allow(clippy::disallowed_methods, reason = "a benchmark measures time")]
        let start = std::time::Instant::now();
        for _ in 0..calls {
            black_box(run());
        }
        best = best.min(start.elapsed().as_secs_f64() / calls as f64);
    }
    println!("bench\t{job}\twayfix\t{:.0}", best * 1e9);
}
