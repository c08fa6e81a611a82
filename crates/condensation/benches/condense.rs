//! Updates of a large belief, and learning: `cargo bench -p wayfix-condensation [--features parallel]`.
//!
//! Prints `bench<TAB>job<TAB>program<TAB>nanoseconds`. What is to be reached: an update of 1e6 states in 5e7 on two cores, 600 views of 256 × 256
//! learned in 2e8.

#[path = "support/harness.rs"]
mod harness;

use harness::measure;
use wayfix_condensation::{
    ColorMeanStdDescriptor, DiffusionKernel, DiscreteFilter, DominantGraysDescriptor, Fft6Descriptor,
    GlobalDescriptor, GridMove, PositionGrid, RgbImage, SlipProbabilities, ViewGrid,
};

fn main() {
    let grid = PositionGrid::new(1000, 1000).expect("a valid size");
    let move_on = SlipProbabilities { stay_probability: 0.1, other_action_probability: 0.0 }
        .transition(&grid, GridMove { dx: 1, dy: 1 })
        .expect("probabilities");
    let kernel = DiffusionKernel::gaussian(&grid, &[1.0, 1.0]).expect("one sigma an axis");
    let log_likelihoods: Vec<f64> =
        (0..1_000_000).map(|i| -0.5 * ((i % 1009) as f64 / 100.0).powi(2)).collect();
    let mut filter = DiscreteFilter::uniform(1_000_000).expect("states");
    measure("update of 1e6 states", 10, || {
        filter.predict(&move_on).expect("the same space");
        filter.predict(&kernel).expect("the same space");
        let outcome = filter.update(&log_likelihoods).expect("finite likelihoods");
        (outcome.evidence(), filter.best())
    });

    // 30 × 20 views in steps of 16 pixels.
    let (width, height) = (256 + 29 * 16, 256 + 19 * 16);
    let pixel = |i: usize| ((i * 2_654_435_761) >> 8) as u8 / 4 + ((i % width) / 6) as u8;
    let bytes = (0..3 * width * height).map(pixel).collect();
    let scene = RgbImage::from_raw(width as u32, height as u32, bytes).expect("3 bytes a pixel");
    let views = ViewGrid::new((width, height), (256, 256), 16).expect("views that fit");
    let features: [(&str, &dyn GlobalDescriptor); 3] = [
        ("MeanVar", &ColorMeanStdDescriptor),
        ("FFT6", &Fft6Descriptor),
        ("Hist6", &DominantGraysDescriptor::default()),
    ];
    for (name, feature) in features {
        measure(&format!("600 views learned {name}"), 10, || {
            feature.extract_all(&scene, &views).expect("the scene of the views")
        });
    }
}
