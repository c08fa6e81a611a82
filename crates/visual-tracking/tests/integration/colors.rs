//! Bins of pictures: segmentation and histograms against counting one pixel at a time.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use approx::assert_abs_diff_eq;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_visual_tracking::{
    ColorBinImage, ColorBinSet, ColorHistogram, ColorQuantizer, ColorSpace, PixelMask, PixelRect, RgbImage,
    RowSpans, SlidingHistogram, TrackingError,
};

fn noise(width: usize, height: usize, rng: &mut ChaCha8Rng) -> RgbImage {
    RgbImage::from_raw(width as u32, height as u32, (0..3 * width * height).map(|_| rng.random()).collect())
        .expect("3 bytes a pixel")
}

fn quantizer() -> ColorQuantizer {
    ColorQuantizer::new(ColorSpace::Opponent, [4, 3, 5]).expect("few bins")
}

fn shape() -> impl Strategy<Value = RowSpans> {
    prop_oneof![
        (0.1..30.0_f64, 0.1..30.0_f64).prop_map(|(a, b)| RowSpans::ellipse([a, b]).expect("positive")),
        (1_usize..40, 1_usize..40).prop_map(|(w, h)| RowSpans::rectangle(w, h).expect("positive")),
    ]
}

/// One pixel at a time.
fn counted(image: &ColorBinImage, shape: &RowSpans, [u, v]: [i64; 2]) -> Vec<f64> {
    let mut counts = vec![0.0; image.n_bins()];
    for (y, row) in image.rows().enumerate() {
        for (x, &bin) in row.iter().enumerate() {
            if shape.columns(y as i64 - v).is_some_and(|columns| columns.contains(&(x as i64 - u))) {
                counts[usize::from(bin)] += 1.0;
            }
        }
    }
    counts
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn segmentation_equals_the_pixelwise_one(
        width in prop_oneof![Just(1), Just(63), Just(64), Just(65), 1_usize..150],
        height in 1_usize..20, seed in any::<u64>(),
    ) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let (quantizer, picture) = (quantizer(), noise(width, height, &mut rng));
        let image = ColorBinImage::new(&quantizer, &picture).unwrap();
        let share = rng.random::<f64>();
        let set = ColorBinSet::from_fn(&quantizer, |_| rng.random::<f64>() < share);
        let plain = PixelMask::from_fn(width, height, |u, v| {
            set.contains(quantizer.bin_of_pixel(picture.get_pixel(u as u32, v as u32).0))
        });
        prop_assert_eq!(image.segment(&set).unwrap(), plain.unwrap());
    }

    /// Steps of a pixel, jumps, changes of shape; inside, across the edges and beyond them.
    #[test]
    fn a_histogram_that_slides_is_the_one_counted_anew(
        width in 1_usize..70, height in 1_usize..50, first in shape(), seed in any::<u64>(),
        steps in prop::collection::vec((any::<bool>(), -90_i64..90, -60_i64..60, prop::option::weighted(0.2, shape())), 1..25),
    ) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let image = ColorBinImage::new(&quantizer(), &noise(width, height, &mut rng)).unwrap();
        let mut sliding = SlidingHistogram::new(&image, first, [width as i64 / 2, height as i64 / 2]);
        for (jump, u, v, shape) in steps {
            let [x, y] = sliding.center();
            sliding.move_to(if jump { [u, v] } else { [x + u.signum(), y + v.signum()] });
            if let Some(shape) = shape {
                sliding.reshape(shape);
            }
            let expected = counted(&image, sliding.spans(), sliding.center());
            prop_assert_eq!(sliding.histogram().counts(), &expected[..]);
        }
    }

    #[test]
    fn a_histogram_of_a_mask_counts_its_pixels(width in 1_usize..140, height in 1_usize..20, seed in any::<u64>()) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let image = ColorBinImage::new(&quantizer(), &noise(width, height, &mut rng)).unwrap();
        let mask = PixelMask::from_fn(width, height, |_, _| rng.random()).unwrap();
        let histogram = ColorHistogram::of_mask(&image, &mask).unwrap();
        for (bin, &count) in histogram.counts().iter().enumerate() {
            let here = |&i: &usize| usize::from(image.bins()[i]) == bin && mask.get(i % width, i / width);
            prop_assert_eq!(count, (0..width * height).filter(here).count() as f64);
        }
        let rest = ColorHistogram::of_mask(&image, &mask.not()).unwrap();
        prop_assert_eq!(histogram.total() + rest.total(), (width * height) as f64);
    }
}

#[test]
fn intersection_is_the_sum_of_the_smaller_counts() {
    let quantizer = ColorQuantizer::new(ColorSpace::Rgb, [3, 1, 7]).unwrap();
    let of = |counts: [f64; 21]| ColorHistogram::from_counts(&quantizer, counts.to_vec()).unwrap();
    let (rising, falling) = (std::array::from_fn(|i| i as f64), std::array::from_fn(|i| 20.0 - i as f64));
    // 2 (0 + 1 + … + 9) + 10 of 210.
    assert_eq!(of(rising).intersection(&of(falling)), Ok(100.0 / 210.0));
    assert_eq!(of(rising).intersection(&of(rising)), Ok(1.0));
    let nothing = ColorHistogram::empty(&quantizer);
    assert_eq!(nothing.intersection(&of(rising)), Ok(0.0));
    assert_eq!(nothing.scaled_to(7.0), Ok(nothing.clone()));
    assert_abs_diff_eq!(of(rising).scaled_to(1.0).unwrap().total(), 1.0, epsilon = 1e-12);
}

#[test]
fn what_does_not_fit_is_refused_and_changes_nothing() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let (picture, few, more) =
        (noise(9, 8, &mut rng), quantizer(), ColorQuantizer::new(ColorSpace::Rgb, [4; 3]));
    let more = more.unwrap();
    let image = ColorBinImage::new(&few, &picture).unwrap();
    assert!(matches!(image.segment(&ColorBinSet::empty(&more)), Err(TrackingError::Dimension { .. })));
    assert!(ColorHistogram::of_mask(&image, &PixelMask::full(8, 9).unwrap()).is_err());
    for (left, top, width, height) in [(5, 5, 5, 2), (0, 7, 2, 2), (usize::MAX, 0, 2, 2), (0, 0, 0, 2)] {
        let beyond = PixelRect { left, top, width, height };
        assert!(ColorBinImage::within(&few, &picture, &beyond).is_err(), "{beyond:?}");
    }

    let mut model = ColorHistogram::of_image(&image);
    let before = model.clone();
    assert!(model.intersection(&ColorHistogram::empty(&more)).is_err());
    assert!(model.blend(&ColorHistogram::empty(&more), 0.1).is_err());
    for rate in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(model.blend(&before, rate), Err(TrackingError::Parameter { .. })));
    }
    assert_eq!(model, before);
    for total in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(model.scaled_to(total).is_err());
    }
    for count in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(ColorHistogram::from_counts(&few, vec![count; 60]).is_err());
    }
    assert!(ColorHistogram::from_counts(&few, vec![0.0; 59]).is_err());

    for semi_axes in [[0.0, 5.0], [5.0, -1.0], [f64::NAN, 1.0], [1e300, 1.0], [f64::INFINITY, 1.0]] {
        assert!(matches!(RowSpans::ellipse(semi_axes), Err(TrackingError::Parameter { .. })));
    }
    assert!(RowSpans::rectangle(0, 3).is_err() && RowSpans::rectangle(3, usize::MAX).is_err());
    let mut sliding = SlidingHistogram::new(&image, RowSpans::rectangle(3, 3).unwrap(), [i64::MIN, i64::MAX]);
    assert_eq!(sliding.histogram().total(), 0.0);
    sliding.move_to([i64::MAX, i64::MIN]);
    sliding.move_to([4, 4]);
    assert_eq!(sliding.histogram().total(), 9.0);
}
