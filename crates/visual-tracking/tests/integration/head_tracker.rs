//! The head tracker on painted heads: turning, light, occlusion, size from outside, and what is refused.

use crate::common::scene;
use approx::{abs_diff_eq, assert_abs_diff_eq};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_visual_tracking::{
    BoundingBox, HeadDetector, HeadTracker, HeadTrackerParams, RelativeHeadSizeSource, RgbImage, TrackStatus,
    Tracker, TrackingError,
};

const WIDTH: usize = 160;
const HEIGHT: usize = 120;
const SEMI_AXES: [f64; 2] = [15.0, 19.0];

/// A head around `center`, the upper share `hair` of it hair, `scale` times as large as the first, on a painted ground in `light`.
fn picture(center: [f64; 2], hair: f64, scale: f64, light: f64) -> RgbImage {
    let ground = scene(WIDTH, HEIGHT, 3);
    let pixel = |i: usize| {
        let off = |at: usize, axis: usize| (at as f64 + 0.5 - center[axis]) / (SEMI_AXES[axis] * scale);
        let (x, y) = (off(i % WIDTH, 0), off(i / WIDTH, 1));
        // lit from the right, as colours of a head are never one
        let (color, shade) = match x.hypot(y) {
            r if r > 1.0 => (ground.get_pixel((i % WIDTH) as u32, (i / WIDTH) as u32).0, 1.0),
            _ if y < 2.0 * hair - 1.0 => ([50, 35, 28], 1.0 + 0.25 * x),
            _ => ([200, 150, 125], 1.0 + 0.25 * x),
        };
        color.map(|value| (f64::from(value) * shade * light).min(255.0) as u8)
    };
    RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, (0..WIDTH * HEIGHT).flat_map(pixel).collect())
        .expect("3 bytes a pixel")
}

fn head(center: [f64; 2], scale: f64) -> BoundingBox {
    let [a, b] = SEMI_AXES.map(|axis| 2.0 * axis * scale);
    BoundingBox::from_center(center, a, b).expect("a box")
}

fn started() -> HeadTracker {
    let (picture, head) = (picture([50.0, 60.0], 0.35, 1.0, 1.0), head([50.0, 60.0], 1.0));
    HeadTracker::new(&picture, head, HeadTrackerParams::default()).expect("a head")
}

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(0)
}

#[test]
fn follows_a_head_that_turns_away() {
    let mut tracker = started();
    for t in 0..30 {
        // from the face to the back of the head, where all is hair
        let (center, hair) = ([50.0 + 2.0 * f64::from(t), 60.0], 0.35 + 0.65 * f64::from(t) / 29.0);
        let target = tracker.track(&picture(center, hair, 1.0, 1.0), &mut rng()).unwrap();
        assert_eq!(target.status, TrackStatus::Tracked);
        // less than three pixels and a twelfth of the size off, which the search's pixels and scales allow
        assert!(target.bounding_box.iou(&head(center, 1.0)) > 0.7, "{t}: {:?}", target.bounding_box);
    }
}

#[test]
fn colours_that_adapt_follow_the_light() {
    let run = |adaptation: f64| {
        let params = HeadTrackerParams {
            color_adaptation_rate: adaptation,
            gradient_weight: Some(0.0),
            ..Default::default()
        };
        let mut tracker =
            HeadTracker::new(&picture([50.0, 60.0], 0.35, 1.0, 1.0), head([50.0, 60.0], 1.0), params)
                .unwrap();
        let quality = |t: i32| {
            let light = 1.0 - 0.6 * f64::from(t) / 60.0;
            tracker.track(&picture([50.0, 60.0], 0.35, 1.0, light), &mut rng()).unwrap().quality
        };
        (0..60).map(quality).last().unwrap()
    };
    assert!(run(0.3) > run(0.0), "adapting must help when all light goes down to two fifths");
}

#[test]
fn the_scale_is_searched_or_comes_from_outside() {
    struct Stereo;
    impl RelativeHeadSizeSource for Stereo {
        fn scale(&mut self, _picture: &RgbImage, _center: [f64; 2]) -> Option<f64> {
            Some(1.5)
        }
    }
    let larger = picture([50.0, 60.0], 0.35, 1.5, 1.0);
    let told = started().with_scale_source(Stereo).track(&larger, &mut rng()).unwrap();
    assert_abs_diff_eq!(told.bounding_box.width(), 45.0, epsilon = 1e-9);

    let mut searching = started();
    for t in 1..=20 {
        searching.track(&picture([50.0, 60.0], 0.35, 1.0 + 0.025 * f64::from(t), 1.0), &mut rng()).unwrap();
    }
    let width = searching.track(&larger, &mut rng()).unwrap().bounding_box.width();
    assert!(abs_diff_eq!(width / 45.0, 1.0, epsilon = 0.1), "{width}");
}

#[test]
fn a_scale_that_is_no_number_is_refused_and_changes_nothing() {
    struct Broken;
    impl RelativeHeadSizeSource for Broken {
        fn scale(&mut self, _picture: &RgbImage, _center: [f64; 2]) -> Option<f64> {
            Some(f64::NAN)
        }
    }
    let shown = picture([53.0, 60.0], 0.35, 1.0, 1.0);
    let mut broken = started().with_scale_source(Broken);
    assert!(matches!(broken.track(&shown, &mut rng()), Err(TrackingError::Parameter { .. })));
    let mut repaired = broken.with_scale_source(wayfix_visual_tracking::HeadSizeFromSearch);
    assert_eq!(repaired.track(&shown, &mut rng()), started().track(&shown, &mut rng()));
}

#[test]
fn a_head_that_leaves_is_lost_and_found_again() {
    let mut tracker = started();
    let blue = RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, [40, 90, 200].repeat(WIDTH * HEIGHT))
        .expect("3 bytes a pixel");
    let statuses: Vec<_> = (0..12).map(|_| tracker.track(&blue, &mut rng()).unwrap().status).collect();
    assert_eq!(statuses[11], TrackStatus::Lost);
    let back = [120.0, 40.0];
    let found = tracker.track(&picture(back, 0.35, 1.0, 1.0), &mut rng()).unwrap();
    assert_eq!(found.status, TrackStatus::Tracked);
    assert!(found.bounding_box.iou(&head(back, 1.0)) > 0.5, "{:?}", found.bounding_box);
}

#[test]
fn refuses_what_cannot_be_a_head() {
    let shown = picture([50.0, 60.0], 0.35, 1.0, 1.0);
    let start = |head: BoundingBox| HeadTracker::new(&shown, head, HeadTrackerParams::default());
    let outside = BoundingBox::from_corner(500.0, 0.0, 30.0, 30.0).unwrap();
    assert!(matches!(start(outside), Err(TrackingError::OutsidePicture { .. })));
    let dot = BoundingBox::from_corner(50.0, 60.0, 1.0, 1.0).unwrap();
    assert!(matches!(start(dot), Err(TrackingError::Parameter { .. })));
    let params = HeadTrackerParams { search_radius: f64::NAN, ..Default::default() };
    let refused = HeadTracker::new(&shown, head([50.0, 60.0], 1.0), params);
    assert!(matches!(refused, Err(TrackingError::Parameter { .. })));

    let mut tracker = started();
    let refused = tracker.track(&scene(WIDTH, HEIGHT + 1, 1), &mut rng());
    assert!(matches!(refused, Err(TrackingError::Dimension { .. })));
}

/// A head of `colors` (upper third and rest) before a plain wall, with a camera's noise; nobody is there without colours.
fn before_a_wall(colors: Option<[[u8; 3]; 2]>, frame: u64) -> RgbImage {
    let noise = |i: u64| ((i + 31_337 * frame).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) % 13;
    let mut bytes = Vec::new();
    for i in 0..WIDTH * HEIGHT {
        let (x, y) = (((i % WIDTH) as f64 + 0.5 - 72.0) / 12.0, ((i / WIDTH) as f64 + 0.5 - 55.0) / 15.0);
        let color = match colors {
            Some([upper, _]) if x.hypot(y) < 1.0 && y < -0.4 => upper,
            Some([_, lower]) if x.hypot(y) < 1.0 => lower,
            _ => [70, 100, 140],
        };
        bytes.extend(color.map(|value| value + noise(i as u64) as u8 - 6));
    }
    RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, bytes).expect("3 bytes a pixel")
}

#[test]
fn head_that_leaves_is_lost_after_a_first_box_too_large() {
    let (skin, hair) = ([200, 130, 100], [60, 45, 40]);
    for colors in [[skin, skin], [hair, skin]] {
        for margin in [0.0, 1.0, 2.0, 3.0] {
            let first =
                BoundingBox::from_center([72.0, 55.0], 24.0 + 2.0 * margin, 30.0 + 2.0 * margin).unwrap();
            let there = |frame| before_a_wall(Some(colors), frame);
            let mut tracker = HeadTracker::new(&there(0), first, HeadTrackerParams::default()).unwrap();
            let mut last = |from: u64, to: u64, is_there: bool| {
                let picture = |frame| if is_there { there(frame) } else { before_a_wall(None, frame) };
                (from..to).map(|frame| tracker.track(&picture(frame), &mut rng()).unwrap()).last().unwrap()
            };
            assert_eq!(last(1, 20, true).status, TrackStatus::Tracked, "{colors:?} {margin}");
            // eight pictures of patience
            assert_eq!(last(20, 30, false).status, TrackStatus::Lost, "{colors:?} {margin}");
            assert_eq!(last(30, 60, false).status, TrackStatus::Lost, "{colors:?} {margin}");
            let back = last(60, 75, true);
            assert_eq!(back.status, TrackStatus::Tracked, "{colors:?} {margin}");
            assert!(back.bounding_box.iou(&first) > 0.5, "{colors:?} {margin}: {:?}", back.bounding_box);
        }
    }
}

#[test]
fn a_detector_starts_the_tracker_without_a_box() {
    let examples: Vec<_> = [([50.0, 60.0], 0.35), ([100.0, 50.0], 0.9)]
        .map(|(center, hair)| (picture(center, hair, 1.0, 1.0), head(center, 1.0)))
        .into();
    let pairs = examples.iter().map(|(picture, head)| (picture, *head));
    let detector = HeadDetector::learn(pairs, &HeadTrackerParams::default()).unwrap();
    for (center, hair, scale) in
        [([110.0, 70.0], 0.35, 1.0), ([70.0, 60.0], 0.6, 1.4), ([40.0, 45.0], 0.2, 0.7)]
    {
        let shown = picture(center, hair, scale, 1.0);
        let found = detector.detect(&shown, 12.0..=80.0).unwrap().expect("a head");
        // "on its target" [Everingham et al. 2010]
        assert!(found.iou(&head(center, scale)) >= 0.5, "{center:?} {found:?}");
        HeadTracker::new(&shown, found, HeadTrackerParams::default()).expect("a head to follow");
    }
    let nobody = before_a_wall(None, 0);
    assert_eq!(detector.detect(&nobody, 12.0..=80.0), Ok(None));
    assert!(matches!(detector.detect(&nobody, 1.0..=80.0), Err(TrackingError::Parameter { .. })));
    let untaught = HeadDetector::learn([], &HeadTrackerParams::default());
    assert!(matches!(untaught, Err(TrackingError::Empty { .. })));
}
