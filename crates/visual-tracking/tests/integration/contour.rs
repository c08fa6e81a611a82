//! The contour tracker: that it follows what the simulator draws, says so when it does not, and takes any input.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common::films::{contour_mask, follow};
use approx::{abs_diff_eq, assert_abs_diff_eq};
use rand::SeedableRng as _;
use rand_chacha::ChaCha8Rng;
use wayfix_scene_sim::film::{OcclusionEvent, SyntheticFilm};
use wayfix_visual_tracking::{
    BoundingBox, ColorContourTracker, ColorContourTrackerParams, ColorDynamics, ColorStateVector, Outline,
    PixelMask, RgbImage, TrackStatus, Tracker as _, TrackingCues, TrackingError,
};

const SIZE: (usize, usize) = (120, 90);

/// A disk of radius 14 before a plain wall.
fn disk(center: [f64; 2], color: [u8; 3]) -> RgbImage {
    let inside = |i: usize| {
        let (u, v) = ((i % SIZE.0) as f64 + 0.5, (i / SIZE.0) as f64 + 0.5);
        (u - center[0]).hypot(v - center[1]) < 14.0
    };
    let bytes = (0..SIZE.0 * SIZE.1).flat_map(|i| if inside(i) { color } else { [110, 115, 120] }).collect();
    RgbImage::from_raw(SIZE.0 as u32, SIZE.1 as u32, bytes).expect("3 bytes a pixel")
}

fn disk_box(center: [f64; 2]) -> BoundingBox {
    BoundingBox::from_center(center, 28.0, 28.0).unwrap()
}

fn on_disk(params: ColorContourTrackerParams) -> ColorContourTracker {
    ColorContourTracker::from_box(&disk([40.0, 45.0], [200, 60, 60]), &disk_box([40.0, 45.0]), params)
        .unwrap()
}

/// From red to blue in 70 pictures: 2 grey values a picture, 28 bins of 5 values in all.
fn turning_blue(step: usize) -> RgbImage {
    let change = 2 * step as u8;
    disk([40.0 + 0.5 * step as f64, 45.0], [200 - change, 60, 60 + change])
}

#[test]
fn colours_are_followed_and_without_adaptation_they_are_not() {
    let params = ColorContourTrackerParams { n_samples: 40, ..ColorContourTrackerParams::default() };
    let mut adaptive = on_disk(params);
    let mut fixed = on_disk(ColorContourTrackerParams { adapts_colors: false, ..params });
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    for step in 1..70 {
        let picture = turning_blue(step);
        let target = adaptive.track(&picture, &mut rng).unwrap();
        assert_eq!(target.status, TrackStatus::Tracked, "step {step}");
        let overlap = target.bounding_box.iou(&disk_box([40.0 + 0.5 * step as f64, 45.0]));
        // A pixel on every side of a box of 28 pixels is 0.86.
        assert!(overlap > 0.86, "step {step}: {overlap}");
        if fixed.track(&picture, &mut rng).unwrap().status == TrackStatus::Tracked {
            assert!(step < 35, "the fixed colours are 14 bins behind");
        }
    }
    let opponent = adaptive.colors().mean;
    // (B - G + 255) / 510 of [62, 60, 198].
    assert!(abs_diff_eq!(opponent.x, 393.0 / 510.0, epsilon = 0.02), "{opponent}");
}

#[test]
fn the_published_form_follows_what_changes_slowly() {
    let mut tracker = on_disk(ColorContourTrackerParams::as_published());
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    for step in 1..15 {
        let target = tracker.track(&turning_blue(step), &mut rng).unwrap();
        assert_eq!(target.status, TrackStatus::Tracked, "step {step}");
        let overlap = target.bounding_box.iou(&disk_box([40.0 + 0.5 * step as f64, 45.0]));
        assert!(overlap > 0.86, "step {step}: {overlap}");
    }
}

/// The bounds are those of the issue for the mean over all seeds, here for a part of one film each; a person gives the first contour.
#[test]
fn simulated_targets_are_followed() {
    for (name, least) in [("circles", 0.8), ("rectangle", 0.8), ("beetle", 0.8), ("snail", 0.75)] {
        let film = SyntheticFilm { seed: 3, n_frames: 50, ..SyntheticFilm::named(name).unwrap() };
        let record = follow(&film, ColorContourTrackerParams::default());
        assert_eq!(record.n_lost(), 0, "{name}");
        assert!(record.mean_overlap() >= least, "{name}: {}", record.mean_overlap());
    }
}

#[test]
fn snail_neck_is_outside_the_contour_and_inside_the_blob() {
    let film = SyntheticFilm { seed: 3, n_frames: 60, ..SyntheticFilm::named("snail").unwrap() };
    let with_shape = follow(&film, ColorContourTrackerParams::default()).decoy_inside();
    let color =
        ColorContourTrackerParams { cues: TrackingCues::Color, ..ColorContourTrackerParams::default() };
    let color_only = follow(&film, color).decoy_inside();
    assert!(with_shape < 0.3 && with_shape < 0.5 * color_only, "{with_shape} against {color_only}");
}

#[test]
fn a_target_that_leaves_is_lost_and_found_again() {
    for (name, comes_back_alike) in [("snail", true), ("circles", false)] {
        let film =
            SyntheticFilm { seed: 2, occlusion: OcclusionEvent::Away, ..SyntheticFilm::named(name).unwrap() };
        let record = follow(&film, ColorContourTrackerParams::default());
        assert!(record.n_gone() >= 13, "the film is about a target that leaves");
        assert_eq!(record.n_confident_while_gone(), 0, "{name}");
        // A circle comes back in another colour among others of its shape: nothing tells which it is.
        if comes_back_alike {
            assert!(record.overlaps_at_the_end() > 0.75, "{}", record.overlaps_at_the_end());
        }
    }
}

#[test]
fn a_picture_of_one_colour_has_no_target() {
    let mut tracker = on_disk(ColorContourTrackerParams::default());
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for cues in [TrackingCues::ColorAndShape, TrackingCues::Color, TrackingCues::Shape] {
        for color in [[0; 3], [255; 3], [200, 60, 60]] {
            let blank = RgbImage::from_raw(SIZE.0 as u32, SIZE.1 as u32, color.repeat(SIZE.0 * SIZE.1))
                .expect("3 bytes a pixel");
            let mut blind =
                on_disk(ColorContourTrackerParams { cues, ..ColorContourTrackerParams::default() });
            assert_eq!(
                blind.track(&blank, &mut rng).unwrap().status,
                TrackStatus::Lost,
                "{cues:?} {color:?}"
            );
            tracker.track(&blank, &mut rng).unwrap();
            let started = ColorContourTracker::from_box(
                &blank,
                &disk_box([40.0, 45.0]),
                ColorContourTrackerParams::default(),
            );
            assert_eq!(started.unwrap().track(&blank, &mut rng).unwrap().status, TrackStatus::Lost);
        }
    }
    let target = tracker.track(&disk([70.0, 30.0], [200, 60, 60]), &mut rng).unwrap();
    assert_eq!(target.status, TrackStatus::Tracked, "found elsewhere after nine blank pictures");
    assert!(target.bounding_box.iou(&disk_box([70.0, 30.0])) > 0.8);
}

#[test]
fn what_cannot_be_used_is_refused_and_changes_nothing() {
    let (picture, params) = (disk([40.0, 45.0], [200, 60, 60]), ColorContourTrackerParams::default());
    let outside = BoundingBox::from_corner(500.0, 500.0, 20.0, 20.0).unwrap();
    assert!(matches!(
        ColorContourTracker::from_box(&picture, &outside, params),
        Err(TrackingError::Empty { .. })
    ));
    let huge = BoundingBox::from_corner(-1e300, 0.0, 2e300, 1e300).unwrap();
    assert!(ColorContourTracker::from_box(&picture, &huge, params).is_err());
    let speck = BoundingBox::from_corner(3.2, 3.2, 0.1, 0.1).unwrap();
    assert!(ColorContourTracker::from_box(&picture, &speck, params).is_err());
    let other = PixelMask::full(SIZE.0 + 1, SIZE.1).unwrap();
    assert!(ColorContourTracker::from_mask(&picture, &other, params).is_err());
    assert!(
        ColorContourTracker::from_mask(&picture, &PixelMask::empty(SIZE.0, SIZE.1).unwrap(), params).is_err()
    );
    for params in [
        ColorContourTrackerParams { n_samples: 0, ..params },
        ColorContourTrackerParams { agreement_sigma: f64::NAN, ..params },
        ColorContourTrackerParams { agreement_weights: [0.0; 3], ..params },
        ColorContourTrackerParams { color_bins: [0; 3], ..params },
        ColorContourTrackerParams { color_state_noise: [f64::INFINITY; 8], ..params },
        ColorContourTrackerParams { lost_below_quality: 1.5, ..params },
    ] {
        assert!(ColorContourTracker::from_box(&picture, &disk_box([40.0, 45.0]), params).is_err());
    }

    let (mut tracker, mut undisturbed) = (on_disk(params), on_disk(params));
    let small = RgbImage::from_raw(1, 1, vec![0; 3]).expect("3 bytes a pixel");
    let refused = tracker.track(&small, &mut ChaCha8Rng::seed_from_u64(3));
    assert!(matches!(refused, Err(TrackingError::Dimension { .. })));
    for step in 1..5 {
        let [a, b] = [&mut tracker, &mut undisturbed].map(|tracker| {
            tracker.track(&turning_blue(step), &mut ChaCha8Rng::seed_from_u64(step as u64)).unwrap()
        });
        assert_eq!(a, b);
    }
}

#[test]
fn every_start_and_every_size_can_be_tracked_without_a_panic() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for (width, height) in [(1_usize, 1_usize), (2, 3), (63, 5), (5, 64), (65, 65)] {
        let bytes = (0..3 * width * height).map(|i| ((i * 2_654_435_761) >> 7) as u8).collect();
        let picture = RgbImage::from_raw(width as u32, height as u32, bytes).expect("3 bytes a pixel");
        for (x, y, w, h) in
            [(0.0, 0.0, 4.0, 4.0), (-2.0, -3.0, 10.0, 10.0), (0.5, 0.5, 1e4, 1e4), (1.0, 1.0, 60.0, 3.0)]
        {
            let bounds = BoundingBox::from_corner(x, y, w, h).unwrap();
            for cues in [TrackingCues::ColorAndShape, TrackingCues::Color, TrackingCues::Shape] {
                let params =
                    ColorContourTrackerParams { cues, n_samples: 10, ..ColorContourTrackerParams::default() };
                let Ok(mut tracker) = ColorContourTracker::from_box(&picture, &bounds, params) else {
                    continue;
                };
                for _ in 0..4 {
                    let target = tracker.track(&picture, &mut rng).unwrap();
                    assert!((0.0..=1.0).contains(&target.quality));
                }
            }
        }
    }
}

#[test]
fn memory_does_not_grow_with_the_film() {
    let mut tracker =
        on_disk(ColorContourTrackerParams { n_samples: 4, ..ColorContourTrackerParams::default() });
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut size_after = |n: usize| {
        for step in 0..n {
            let phase = step as f64 * 0.05;
            let color =
                [150.0 + 60.0 * phase.sin(), 80.0, 150.0 + 60.0 * (1.7 * phase).cos()].map(|x| x as u8);
            tracker.track(&disk([60.0 + 30.0 * phase.sin(), 45.0], color), &mut rng).unwrap();
        }
        format!("{tracker:?}").len()
    };
    let (early, late) = (size_after(50), size_after(2000));
    // All that a tracker holds is in what it prints; digits come and go.
    assert!(late < 2 * early, "{early} then {late}");
}

#[test]
fn dynamics_of_ones_own_are_used() {
    let still = ColorDynamics::constant_velocity(0.0, &ColorStateVector::zeros()).unwrap();
    let params = ColorContourTrackerParams {
        min_target_to_background_ratio: 0.0,
        previous_colors_weight: 0.0,
        share_from_last_measurement: 0.0,
        ..ColorContourTrackerParams::default()
    };
    let mut tracker = on_disk(params).with_dynamics(still);
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    // Without noise no sample ever leaves red, so a jump of five bins cannot be followed.
    let target = tracker.track(&disk([41.0, 45.0], [150, 60, 110]), &mut rng).unwrap();
    assert_eq!(target.status, TrackStatus::Lost);
    assert_eq!(
        tracker.track(&disk([41.0, 45.0], [200, 60, 60]), &mut rng).unwrap().status,
        TrackStatus::Tracked
    );
}

#[test]
fn an_outline_of_the_users_is_the_contour() {
    let picture = disk([40.0, 45.0], [200, 60, 60]);
    let outline = Outline::ellipse(&disk_box([40.0, 45.0]), 64).unwrap();
    let tracker =
        ColorContourTracker::from_outline(&picture, &outline, ColorContourTrackerParams::default()).unwrap();
    assert_abs_diff_eq!(tracker.snake().outline().area(), outline.area(), epsilon = 0.02 * outline.area());
}

#[cfg(feature = "parallel")]
#[test]
fn any_number_of_threads_gives_the_same_bits() {
    use crate::common::films::{mask_of, picture_of};
    let film = SyntheticFilm { seed: 4, n_frames: 12, ..SyntheticFilm::named("snail").unwrap() };
    let run = |n_threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(n_threads).build().unwrap();
        pool.install(|| {
            let mut frames = film.frames().unwrap();
            let first = frames.next().unwrap();
            let params = ColorContourTrackerParams::default();
            let mut tracker =
                ColorContourTracker::from_mask(&picture_of(&first), &mask_of(&first.target), params).unwrap();
            let mut rng = ChaCha8Rng::seed_from_u64(4);
            frames.map(|frame| tracker.track(&picture_of(&frame), &mut rng).unwrap()).collect::<Vec<_>>()
        })
    };
    assert_eq!(run(1), run(3));
}

#[test]
fn the_contour_is_the_mask_that_is_measured() {
    let picture = disk([40.0, 45.0], [200, 60, 60]);
    let mut tracker = on_disk(ColorContourTrackerParams::default());
    let target = tracker.track(&picture, &mut ChaCha8Rng::seed_from_u64(7)).unwrap();
    let truth = std::f64::consts::PI * 14.0 * 14.0;
    let area = contour_mask(&target, SIZE).area() as f64;
    // Half a pixel all round is 7 %.
    assert!(abs_diff_eq!(area / truth, 1.0, epsilon = 0.07), "{area} of {truth}");
}
