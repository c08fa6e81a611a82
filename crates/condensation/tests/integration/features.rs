//! Features of all views at once against one view at a time, and both against their definitions.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use approx::{abs_diff_eq, assert_abs_diff_eq};
use proptest::prelude::*;
use wayfix_condensation::{
    ColorMeanStdDescriptor, ConcatenatedDescriptor, CondensationError, DiscreteStateSpace,
    DominantGrayCriterion, DominantGraysDescriptor, Fft6Descriptor, GlobalDescriptor, RgbImage,
    StateDescriptorTable, View, ViewGrid, grey, mapped, shifted,
};

/// A feature without what it knows of neighbouring views.
struct Plain<'a>(&'a dyn GlobalDescriptor);

impl GlobalDescriptor for Plain<'_> {
    fn n_components(&self) -> usize {
        self.0.n_components()
    }

    fn extract(&self, view: &View<'_>, features: &mut [f64]) {
        self.0.extract(view, features);
    }
}

fn all_features() -> Vec<Box<dyn GlobalDescriptor + Send>> {
    vec![
        Box::new(ColorMeanStdDescriptor),
        Box::new(Fft6Descriptor),
        Box::new(DominantGraysDescriptor { dominance: DominantGrayCriterion::Counts }),
        Box::new(DominantGraysDescriptor { dominance: DominantGrayCriterion::Peaks { sigma: 4.0 } }),
        Box::new(DominantGraysDescriptor { dominance: DominantGrayCriterion::Classes }),
        Box::new(DominantGraysDescriptor::default()),
    ]
}

fn assert_equal(got: &StateDescriptorTable, expected: &StateDescriptorTable) {
    assert_eq!(got.n_states(), expected.n_states());
    for (state, (a, b)) in got.rows().zip(expected.rows()).enumerate() {
        for (x, y) in a.iter().zip(b) {
            assert!(abs_diff_eq!(x, y, epsilon = 1e-9), "state {state}: {a:?} and {b:?}");
        }
    }
}

fn picture() -> impl Strategy<Value = RgbImage> {
    (6_u32..30, 6_u32..30).prop_flat_map(|(width, height)| {
        prop::collection::vec(any::<u8>(), 3 * (width * height) as usize)
            .prop_map(move |bytes| RgbImage::from_raw(width, height, bytes).expect("3 bytes a pixel"))
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn all_views_are_the_single_views(
        scene in picture(), view in (1_usize..7, 1_usize..7), step in 1_usize..9, shift in (-5..5, -5..5),
    ) {
        let size = (scene.width() as usize, scene.height() as usize);
        let views = ViewGrid::new(size, view, step).unwrap().moved(shift.0, shift.1);
        for feature in all_features() {
            let plain = Plain(feature.as_ref()).extract_all(&scene, &views).unwrap();
            assert_equal(&feature.extract_all(&scene, &views).unwrap(), &plain);
        }
        let joined = ConcatenatedDescriptor::new(all_features());
        assert_equal(&joined.extract_all(&scene, &views).unwrap(), &Plain(&joined).extract_all(&scene, &views).unwrap());
    }

    #[test]
    fn features_are_what_they_are_defined_to_be(scene in picture()) {
        let (whole, width) = (View::whole(&scene).unwrap(), scene.width() as usize);
        let n = whole.n_pixels() as f64;
        let mut mean_var = [0.0; 6];
        ColorMeanStdDescriptor.extract(&whole, &mut mean_var);
        for c in 0..3 {
            let values = || scene.pixels().map(|pixel| f64::from(pixel[c]));
            let mean = values().sum::<f64>() / n;
            let sigma = (values().map(|value| (value - mean).powi(2)).sum::<f64>() / n).sqrt();
            assert_abs_diff_eq!(mean_var[c], mean, epsilon = 1e-9);
            assert_abs_diff_eq!(mean_var[c + 3], sigma, epsilon = 1e-9);
        }
        let mut moduli = [0.0; 6];
        Fft6Descriptor.extract(&whole, &mut moduli);
        for (l, modulus) in moduli.iter().enumerate() {
            let (mut real, mut imaginary) = (0.0, 0.0); // Eq. 7, pixel by pixel
            for (i, &grey) in grey(&scene).as_raw().iter().enumerate() {
                let angle = std::f64::consts::TAU * (l * (i % width)) as f64 / width as f64;
                real += f64::from(grey) * angle.cos() / n;
                imaginary -= f64::from(grey) * angle.sin() / n;
            }
            assert_abs_diff_eq!(*modulus, real.hypot(imaginary), epsilon = 1e-9);
        }
    }
}

#[test]
fn classes_follow_gain_and_offset() {
    let row = |values: &[u8]| RgbImage::from_fn(8, 1, |x, _| [values[x as usize]; 3].into());
    let extract = |values: &[u8], features: &mut [f64]| {
        DominantGraysDescriptor { dominance: DominantGrayCriterion::Classes }
            .extract(&View::whole(&row(values)).unwrap(), features);
    };
    let values = [10, 14, 20, 70, 72, 90, 140, 150];
    let brighter: Vec<u8> = values.iter().map(|v| v / 2 + 60).collect();
    let (mut before, mut after) = ([0.0; 6], [0.0; 6]);
    extract(&values, &mut before);
    extract(&brighter, &mut after);
    for k in 0..3 {
        assert_abs_diff_eq!(after[k], 0.5 * before[k] + 60.0, epsilon = 1e-9);
        assert!(after[k + 3] == before[k + 3]);
    }
}

#[test]
fn a_constant_picture_has_finite_features() {
    let scene = RgbImage::from_pixel(9, 8, [77; 3].into());
    let views = ViewGrid::new((9, 8), (4, 4), 2).unwrap();
    for feature in all_features() {
        let table = feature.extract_all(&scene, &views).unwrap();
        assert!(table.rows().flatten().all(|value| value.is_finite()));
        assert!(table.rows().all(|row| row == table.get(0).unwrap()));
    }
}

#[test]
fn sizes_that_do_not_fit_are_refused() {
    let refused = ViewGrid::new((100, 80), (128, 64), 8);
    assert_eq!(refused, Err(CondensationError::SceneSmallerThanView { scene: (100, 80), view: (128, 64) }));
    assert!(matches!(ViewGrid::new((100, 80), (10, 10), 0), Err(CondensationError::Extent { .. })));
    assert!(matches!(View::whole(&RgbImage::new(0, 5)), Err(CondensationError::Extent { .. })));
    let views = ViewGrid::new((10, 8), (4, 4), 2).unwrap();
    let other = RgbImage::new(9, 8);
    assert!(matches!(
        ColorMeanStdDescriptor.extract_all(&other, &views),
        Err(CondensationError::Dimension { .. })
    ));
    assert!(View::new(&other, (6, 0), (4, 4)).is_err() && views.corner(views.grid().n_states()).is_err());
}

#[test]
fn a_longer_buffer_and_no_pixels_are_valid_images() {
    let [short, long] = [12, 15].map(|n_bytes| RgbImage::from_raw(2, 2, (0..n_bytes).collect()).unwrap());
    assert_eq!(grey(&short).as_raw(), grey(&long).as_raw());
    let empty = RgbImage::new(3, 0);
    assert_eq!(shifted(&empty, 1, 1).dimensions(), mapped(&empty, &[[0; 256]; 3]).dimensions());
    assert!(grey(&empty).is_empty());
}

#[test]
fn a_shifted_picture_repeats_its_last_pixel() {
    let picture = RgbImage::from_fn(3, 2, |x, y| [(10 * y + x) as u8; 3].into());
    let red = |picture: &RgbImage| picture.pixels().map(|pixel| pixel[0]).collect::<Vec<_>>();
    assert_eq!(red(&shifted(&picture, 1, 0)), [1, 2, 2, 11, 12, 12]);
    assert_eq!(red(&shifted(&picture, -1, 1)), [10, 10, 11, 10, 10, 11]);
    assert_eq!(red(&shifted(&picture, i32::MIN, i32::MAX)), [10; 6]);
}
