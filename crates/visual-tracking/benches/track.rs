//! What a tracker does with a frame of 320 × 240: `cargo bench -p wayfix-visual-tracking --bench track`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`. `peers/opencv_tracking.py` makes the same frame and does the same jobs.

#[path = "../../condensation/benches/support/harness.rs"]
mod harness;

use std::hint::black_box;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_visual_tracking::{
    ColorBinImage, ColorBinSet, ColorHistogram, ColorQuantizer, ColorSpace, CorrelationTracker,
    CorrelationTrackerParams, HeadTracker, HeadTrackerParams, PixelConnectivity, PixelRect, RgbImage,
    RowSpans, SlidingHistogram, StructuringElement, Tracker,
};

use harness::measure;

const SIZE: (usize, usize) = (320, 240);
const TARGET: PixelRect = PixelRect { left: 130, top: 90, width: 60, height: 60 };
const N_HYPOTHESES: usize = 300;

fn main() {
    let picture = frame();
    let quantizer = ColorQuantizer::new(ColorSpace::Opponent, [32, 32, 8]).expect("few bins");
    for space in ColorSpace::ALL {
        let quantizer = ColorQuantizer::new(space, [32, 32, 8]).expect("few bins");
        measure(&format!("track bins {space:?}"), 100, || ColorBinImage::new(&quantizer, &picture));
    }
    let image = ColorBinImage::new(&quantizer, &picture).expect("a small picture");
    let target = ColorBinImage::within(&quantizer, &picture, &TARGET).expect("inside");
    let set = ColorBinSet::of_image(&target);
    measure("track segment, one set", 200, || image.segment(&set));
    let mask = image.segment(&set).expect("the same bins");
    measure("track erode 3x3", 1000, || mask.eroded(StructuringElement::Square { radius: 1 }));
    measure("track Euler number", 1000, || black_box(&mask).euler_number(PixelConnectivity::Eight));
    let blob = mask.opened(StructuringElement::Square { radius: 1 });
    measure("track blobs", 500, || blob.blobs(PixelConnectivity::Eight));
    measure("track contour", 500, || blob.outer_contour());

    let hue_saturation = ColorQuantizer::new(ColorSpace::Hsi, [8, 8, 1]).expect("few bins");
    measure("track 300 colour hypotheses", 30, || hypotheses(&picture, &hue_saturation));
    let start = TARGET.to_box().expect("it has an extent");
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let mut tracker = CorrelationTracker::new(&picture, start, CorrelationTrackerParams::default())
        .expect("a disc that stands out");
    measure("track correlation", 50, || tracker.track(&picture, &mut rng));
    let mut tracker =
        HeadTracker::new(&picture, start, HeadTrackerParams::default()).expect("a box in the picture");
    measure("track head", 50, || tracker.track(&picture, &mut rng));
}

/// Intersections of the histograms of windows of 60 × 60 with that of the target, 8 × 8 bins of hue and saturation; from the pixels on.
fn hypotheses(picture: &RgbImage, quantizer: &ColorQuantizer) -> f64 {
    let image = ColorBinImage::new(quantizer, picture).expect("a small picture");
    let window = RowSpans::rectangle(TARGET.width, TARGET.height).expect("it has an extent");
    let histogram = |u, v| SlidingHistogram::new(&image, window.clone(), [u, v]).into_histogram();
    let model: ColorHistogram = histogram(160, 120);
    let mut uniform = xorshift();
    let mut next = |n: f64| 30 + (uniform.next().expect("endless") * n) as i64;
    let score = |_| histogram(next(260.0), next(180.0)).intersection(&model).expect("the same bins");
    (0..N_HYPOTHESES).map(score).sum()
}

/// Noise, and an orange disc in the middle.
fn frame() -> RgbImage {
    let mut uniform = xorshift();
    let pixel = |i: usize| {
        let noise = [0; 3].map(|_| (256.0 * uniform.next().expect("endless")) as u8);
        let apart = ((i % SIZE.0) as f64 - 160.0).hypot((i / SIZE.0) as f64 - 120.0);
        if apart < 30.0 { [240, 90 + noise[1] / 16, 30] } else { noise }
    };
    RgbImage::from_raw(SIZE.0 as u32, SIZE.1 as u32, (0..SIZE.0 * SIZE.1).flat_map(pixel).collect())
        .expect("3 bytes a pixel")
}

/// Uniform numbers in [0, 1), those of `crates/line-extract/benches/chains.rs`.
fn xorshift() -> impl Iterator<Item = f64> {
    let mut state = 88_172_645_463_325_252_u64;
    std::iter::repeat_with(move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 11) as f64 / (1_u64 << 53) as f64
    })
}
