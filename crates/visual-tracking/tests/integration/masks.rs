//! Words of 64 pixels against one pixel at a time, on masks of all densities whose widths are next to whole words.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common::plain_mask::Plain;
use approx::assert_abs_diff_eq;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_visual_tracking::{PixelConnectivity, PixelMask, StructuringElement, TrackingError};

const BOTH: [PixelConnectivity; 2] = [PixelConnectivity::Four, PixelConnectivity::Eight];

/// Noise of a density between nothing and everything, both included; as it is, or closed to blobs with holes.
fn mask() -> impl Strategy<Value = PixelMask> {
    let width = prop_oneof![Just(1), Just(63), Just(64), Just(65), Just(127), Just(128), 1_usize..140];
    (width, 1_usize..40, 0..=8_u32, any::<u64>(), any::<bool>()).prop_map(
        |(width, height, eighths, seed, closed)| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let noise = |_, _| rng.random_range(0..8) < eighths;
            let noise = PixelMask::from_fn(width, height, noise).expect("a valid size");
            if closed { noise.closed(StructuringElement::Cross { radius: 1 }) } else { noise }
        },
    )
}

/// Squares are rows spread, then columns; far reach is tested with crosses, where a pixel has few others to look at.
fn element() -> impl Strategy<Value = StructuringElement> {
    let cross = prop_oneof![0_usize..6, Just(40), Just(70), Just(200)];
    prop_oneof![
        (0_usize..6).prop_map(|radius| StructuringElement::Square { radius }),
        cross.prop_map(|radius| StructuringElement::Cross { radius }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn morphology(mask in mask(), element in element()) {
        let plain = Plain::of(&mask);
        prop_assert_eq!(Plain::of(&mask.dilated(element)), plain.dilated(element));
        prop_assert_eq!(Plain::of(&mask.eroded(element)), plain.eroded(element));
        prop_assert_eq!(Plain::of(&mask.opened(element)), plain.eroded(element).dilated(element));
        prop_assert_eq!(Plain::of(&mask.closed(element)), plain.dilated(element).eroded(element));
        prop_assert_eq!(Plain::of(&mask.boundary()), plain.boundary());
        // Opening takes some away, closing adds some, and neither does more a second time.
        let (opened, closed) = (mask.opened(element), mask.closed(element));
        prop_assert!(opened.and_not(&mask).unwrap().is_empty() && mask.and_not(&closed).unwrap().is_empty());
        prop_assert_eq!(&opened.opened(element), &opened);
        prop_assert_eq!(&closed.closed(element), &closed);
    }

    #[test]
    fn topology(mask in mask()) {
        let plain = Plain::of(&mask);
        for connectivity in BOTH {
            let parts = plain.parts(connectivity);
            let blobs = mask.blobs(connectivity);
            prop_assert_eq!(blobs.len(), parts.len());
            for (i, (blob, part)) in blobs.iter().zip(&parts).enumerate() {
                let of_blob = blobs.mask(i).unwrap();
                prop_assert_eq!(&Plain::of(&of_blob), part);
                prop_assert_eq!((blob.area, Some(blob.rect)), (of_blob.area(), of_blob.bounding_rect()));
            }
            prop_assert_eq!(mask.n_holes(connectivity), plain.holes(connectivity).len());
            let filled = plain.holes(connectivity).iter().fold(plain.clone(), |all, hole| all.or(hole));
            prop_assert_eq!(Plain::of(&mask.without_holes(connectivity)), filled);
            let euler = parts.len() as i64 - plain.holes(connectivity).len() as i64;
            prop_assert_eq!(mask.euler_number(connectivity), euler);
            prop_assert_eq!(plain.euler_number(connectivity), euler);
        }
    }

    #[test]
    fn sets_and_measures(a in mask(), seed in any::<u64>()) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let b = PixelMask::from_fn(a.width(), a.height(), |_, _| rng.random()).unwrap();
        let (plain_a, plain_b) = (Plain::of(&a), Plain::of(&b));
        let each = |op: fn(bool, bool) -> bool| plain_a.zip(&plain_b, op);
        prop_assert_eq!(Plain::of(&a.and(&b).unwrap()), each(|a, b| a && b));
        prop_assert_eq!(Plain::of(&a.or(&b).unwrap()), each(|a, b| a || b));
        prop_assert_eq!(Plain::of(&a.and_not(&b).unwrap()), each(|a, b| a && !b));
        prop_assert_eq!(Plain::of(&a.not()), each(|a, _| !a));
        prop_assert_eq!(a.area(), plain_a.pixels().len());
        prop_assert_eq!(a.overlap(&b).unwrap(), each(|a, b| a && b).pixels().len());
        prop_assert_eq!(a.is_empty(), plain_a.pixels().is_empty());
        prop_assert_eq!(a.centroid().is_none(), a.is_empty());
        if let (Some([u, v]), Some(rect)) = (a.centroid(), a.bounding_rect()) {
            let n = plain_a.pixels().len() as f64;
            let mean = |axis: usize| plain_a.pixels().iter().map(|p| p[axis] as f64 + 0.5).sum::<f64>() / n;
            assert_abs_diff_eq!(u, mean(0), epsilon = 1e-9);
            assert_abs_diff_eq!(v, mean(1), epsilon = 1e-9);
            let ends = |axis: usize| {
                let values = || plain_a.pixels().into_iter().map(move |p| p[axis]);
                (values().min().unwrap(), values().max().unwrap() + 1)
            };
            prop_assert_eq!((rect.left, rect.left + rect.width), ends(0));
            prop_assert_eq!((rect.top, rect.top + rect.height), ends(1));
        }
        let listed: Vec<_> = a.runs().flat_map(|(v, run)| run.map(move |u| [u, v])).collect();
        prop_assert_eq!(listed, plain_a.pixels());
    }

    /// The contour is what Suzuki & Abe call an outer border: the pixels of the blob that share a side with what surrounds it.
    #[test]
    fn contours(mask in mask()) {
        let blobs = mask.blobs(PixelConnectivity::Eight);
        for i in 0..blobs.len() {
            let blob = blobs.mask(i).unwrap();
            let contour = blob.outer_contour();
            for (k, pixel) in contour.iter().enumerate() {
                let next = contour[(k + 1) % contour.len()];
                let apart = pixel[0].abs_diff(next[0]).max(pixel[1].abs_diff(next[1]));
                prop_assert_eq!(apart, usize::from(contour.len() > 1));
            }
            let mut visited = PixelMask::empty(mask.width(), mask.height()).unwrap();
            contour.iter().for_each(|&[u, v]| visited.set(u, v, true).unwrap());
            prop_assert_eq!(visited, blob.without_holes(PixelConnectivity::Eight).boundary());
        }
        prop_assert_eq!(mask.outer_contour(), blobs.mask(0).map_or(Vec::new(), |blob| blob.outer_contour()));
    }

    #[test]
    fn polygons(corners in prop::collection::vec((-20.0..160.0_f64, -10.0..60.0_f64), 0..9), size in (1_usize..150, 1_usize..50)) {
        let corners: Vec<[f64; 2]> = corners.into_iter().map(Into::into).collect();
        let mask = PixelMask::from_polygon(size.0, size.1, &corners).unwrap();
        prop_assert_eq!(Plain::of(&mask), Plain::of_polygon(size, &corners));
    }
}

#[test]
fn blobs_are_chosen_by_size_distance_and_overlap() {
    let mask = PixelMask::from_fn(100, 50, |u, v| {
        (u < 3 && v < 3) || ((50..60).contains(&u) && (20..30).contains(&v)) || (u == 99 && v > 40)
    })
    .unwrap();
    let blobs = mask.blobs(PixelConnectivity::Four);
    assert_eq!(blobs.largest(), Some(1));
    for (point, nearest) in [([1.0, 1.0], 0), ([80.0, 49.0], 2), ([-500.0, 400.0], 0), ([55.0, 19.0], 1)] {
        assert_eq!(blobs.nearest(point), Some(nearest), "{point:?}");
    }
    assert_eq!(blobs.nearest([f64::NAN, 0.0]), None);
    let near_the_edge = PixelMask::from_fn(100, 50, |u, v| u > 57 && v > 28).unwrap();
    assert_eq!(blobs.most_overlapping(&near_the_edge), Ok(Some(2)));
    assert_eq!(blobs.most_overlapping(&mask.not()), Ok(None));
    assert_eq!(blobs.mask(3), None);
    let none = PixelMask::empty(9, 9).unwrap().blobs(PixelConnectivity::Four);
    assert!(none.is_empty() && none.largest().is_none() && none.nearest([0.0; 2]).is_none());
}

#[test]
fn an_element_larger_than_the_mask_fills_or_clears_it() {
    for (width, height) in [(1, 1), (1, 200), (200, 1), (129, 70)] {
        for radius in [200, usize::MAX] {
            let square = StructuringElement::Square { radius };
            let one = PixelMask::from_fn(width, height, |u, v| u == width - 1 && v == height - 1).unwrap();
            assert_eq!(one.dilated(square), PixelMask::full(width, height).unwrap());
            assert_eq!(one.not().eroded(square), PixelMask::empty(width, height).unwrap());
        }
    }
}

#[test]
fn sizes_that_do_not_fit_are_refused() {
    for (width, height) in [(0, 5), (5, 0), (usize::MAX, 2), (usize::MAX, usize::MAX), (1, 1 << 40)] {
        assert!(matches!(PixelMask::empty(width, height), Err(TrackingError::Extent { .. })));
    }
    let (mut a, b) = (PixelMask::full(64, 3).unwrap(), PixelMask::full(65, 3).unwrap());
    assert!(matches!(a.and(&b), Err(TrackingError::Dimension { .. })));
    assert!(a.or(&b).is_err() && a.and_not(&b).is_err() && a.iou(&b).is_err() && a.overlap(&b).is_err());
    assert!(a.blobs(PixelConnectivity::Four).most_overlapping(&b).is_err());
    assert!(matches!(a.set(64, 0, false), Err(TrackingError::Outside { .. })));
    assert!(a.set(63, 2, false).is_ok() && !a.get(63, 2) && a.area() == 64 * 3 - 1);
    assert_eq!(PixelMask::empty(7, 7).unwrap().iou(&PixelMask::empty(7, 7).unwrap()), Ok(0.0));
}
