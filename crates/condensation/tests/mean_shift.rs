//! Mean shift on discs that move, change their size, leave and come back.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use wayfix_condensation::{
    BoundingBox, CondensationError, MeanShift, MeanShiftParams, Picture, Target, TrackStatus, Tracker,
};

const SIZE: (usize, usize) = (160, 120);

struct Disc {
    center: [f64; 2],
    radius: f64,
}

impl Disc {
    fn bounding_box(&self) -> BoundingBox {
        BoundingBox::from_center(self.center, 2.0 * self.radius, 2.0 * self.radius).expect("a radius")
    }

    /// Orange before green, both with the noise of a camera.
    fn picture(&self, rng: &mut ChaCha8Rng) -> Picture {
        let pixel = |i: usize| {
            let middle = [(i % SIZE.0) as f64 + 0.5, (i / SIZE.0) as f64 + 0.5];
            let apart = (middle[0] - self.center[0]).hypot(middle[1] - self.center[1]);
            let color = if apart < self.radius { [220, 110, 40] } else { [70, 120, 60] };
            color.map(|value: i16| (value + rng.random_range(-12..=12)) as u8)
        };
        Picture::from_rgb(SIZE.0, SIZE.1, (0..SIZE.0 * SIZE.1).flat_map(pixel).collect()).expect("pixels")
    }
}

fn follow(tracker: &mut MeanShift, disc: &Disc, rng: &mut ChaCha8Rng) -> Target {
    let picture = disc.picture(rng);
    tracker.track(&picture, rng).unwrap()
}

/// Pixels of the rim are in or out as a whole, and the window is fitted by moments: 0.8 leaves a tenth to each side.
#[test]
fn a_disc_is_followed_while_it_moves_and_grows() {
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let mut disc = Disc { center: [40.0, 40.0], radius: 10.0 };
    let start = disc.picture(&mut rng);
    let mut tracker = MeanShift::start(&start, &disc.bounding_box(), MeanShiftParams::default()).unwrap();
    for step in 0..60 {
        let angle = 0.1 * f64::from(step);
        disc = Disc {
            center: [70.0 - 30.0 * angle.cos(), 55.0 - 20.0 * (2.0 * angle).sin()],
            radius: 10.0 + 0.2 * f64::from(step),
        };
        let target = follow(&mut tracker, &disc, &mut rng);
        let iou = target.bounding_box.iou(&disc.bounding_box());
        assert!(target.status == TrackStatus::Tracked && iou > 0.8, "step {step}: {iou} {target:?}");
    }
}

#[test]
fn a_window_of_fixed_size_keeps_it() {
    let mut rng = ChaCha8Rng::seed_from_u64(12);
    let disc = Disc { center: [80.0, 60.0], radius: 12.0 };
    let params = MeanShiftParams { growth: 1.0, ..MeanShiftParams::default() };
    let mut tracker = MeanShift::start(&disc.picture(&mut rng), &disc.bounding_box(), params).unwrap();
    let larger = Disc { center: [84.0, 60.0], radius: 30.0 };
    assert!((follow(&mut tracker, &larger, &mut rng).bounding_box.width() - 24.0).abs() < 1e-9);
}

#[test]
fn a_disc_that_leaves_is_lost_and_found_where_it_comes_back() {
    let mut rng = ChaCha8Rng::seed_from_u64(13);
    let disc = Disc { center: [40.0, 40.0], radius: 12.0 };
    let mut tracker =
        MeanShift::start(&disc.picture(&mut rng), &disc.bounding_box(), MeanShiftParams::default()).unwrap();
    assert_eq!(follow(&mut tracker, &disc, &mut rng).status, TrackStatus::Tracked);
    for _ in 0..5 {
        let target = follow(&mut tracker, &Disc { center: [-99.0, -99.0], radius: 12.0 }, &mut rng);
        assert_eq!(target.status, TrackStatus::Lost);
        assert!(target.bounding_box.iou(&disc.bounding_box()) > 0.8, "where it was seen last");
        assert!(target.quality < 0.3);
    }
    let back = Disc { center: [121.0, 83.0], radius: 12.0 };
    let target = follow(&mut tracker, &back, &mut rng);
    assert_eq!(target.status, TrackStatus::Tracked);
    assert!(target.bounding_box.iou(&back.bounding_box()) > 0.8);
}

#[test]
fn in_a_picture_of_one_colour_nothing_is_followed() {
    let grey = Picture::from_rgb(SIZE.0, SIZE.1, vec![128; 3 * SIZE.0 * SIZE.1]).unwrap();
    let start = BoundingBox::from_corner(20.0, 20.0, 30.0, 30.0).unwrap();
    let mut tracker = MeanShift::start(&grey, &start, MeanShiftParams::default()).unwrap();
    let target = tracker.track(&grey, &mut ChaCha8Rng::seed_from_u64(14)).unwrap();
    assert_eq!((target.status, target.quality), (TrackStatus::Lost, 0.0));
}

#[test]
fn what_cannot_be_followed_is_refused_and_changes_nothing() {
    let mut rng = ChaCha8Rng::seed_from_u64(15);
    let disc = Disc { center: [80.0, 60.0], radius: 12.0 };
    let (picture, defaults) = (disc.picture(&mut rng), MeanShiftParams::default());
    let boxes =
        [[-50.0, 0.0, 40.0, 40.0], [160.0, 0.0, 9.0, 9.0], [0.0, 1e12, 5.0, 5.0], [0.0, 0.0, 1e300, 5.0]];
    for [x, y, width, height] in boxes {
        let outside = BoundingBox::from_corner(x, y, width, height).unwrap();
        assert!(MeanShift::start(&picture, &outside, defaults).is_err(), "{outside:?}");
    }
    let wrong = [
        MeanShiftParams { bins: [0, 1, 1], ..defaults },
        MeanShiftParams { max_iterations: 0, ..defaults },
        MeanShiftParams { tolerance: f64::NAN, ..defaults },
        MeanShiftParams { margin: -0.1, ..defaults },
        MeanShiftParams { growth: 0.9, ..defaults },
        MeanShiftParams { lost_below: f64::NAN, ..defaults },
        MeanShiftParams { found_above: 0.1, ..defaults },
    ];
    for params in wrong {
        let refused = MeanShift::start(&picture, &disc.bounding_box(), params);
        assert!(matches!(refused, Err(CondensationError::Parameter { .. })), "{params:?}");
    }
    let mut tracker = MeanShift::start(&picture, &disc.bounding_box(), defaults).unwrap();
    let before = format!("{tracker:?}");
    let other = Picture::from_rgb(120, 160, vec![0; 3 * 120 * 160]).unwrap();
    assert!(matches!(tracker.track(&other, &mut rng), Err(CondensationError::Dimension { .. })));
    assert_eq!(format!("{tracker:?}"), before);
    let narrow = Picture::from_rgb(1, 9, (0..27).map(|i| if i < 9 { 200 } else { i }).collect()).unwrap();
    let top = BoundingBox::from_corner(0.0, 0.0, 1.0, 3.0).unwrap();
    let mut tracker = MeanShift::start(&narrow, &top, defaults).unwrap();
    assert!(tracker.track(&narrow, &mut rng).is_ok());
    // A box of one pixel, and one larger than the picture, are odd but no errors.
    for (center, side) in [([80.0, 60.0], 1.0), ([80.0, 60.0], 300.0)] {
        let odd = BoundingBox::from_center(center, side, side).unwrap();
        let mut tracker = MeanShift::start(&picture, &odd, defaults).unwrap();
        assert!((0.0..=1.0).contains(&tracker.track(&picture, &mut rng).unwrap().quality));
    }
}
