//! The correlation tracker on painted scenes: where the target is, when it is lost, and what is refused.

use crate::common::scene;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_visual_tracking::{
    BoundingBox, CorrelationTracker, CorrelationTrackerParams, RgbImage, TargetEstimate, TrackStatus,
    Tracker, TrackingError,
};

const WIDTH: usize = 160;
const HEIGHT: usize = 120;
/// Overlap from which detection benchmarks count a box as right. [Everingham et al. 2010]
const RIGHT: f64 = 0.5;

/// The target: a painted square with finer structure than the ground has.
struct Painting {
    ground: RgbImage,
    target: RgbImage,
}

impl Painting {
    fn new() -> Self {
        Self { ground: scene(WIDTH, HEIGHT, 1), target: scene(120, 120, 2) }
    }

    /// The target of `side` pixels around `center`, and before it a plain board in the columns `hidden`.
    fn with(&self, center: [f64; 2], side: f64, hidden: std::ops::Range<usize>) -> RgbImage {
        let pixel = |i: usize| {
            let (u, v) = (i % WIDTH, i / WIDTH);
            let along = |at: usize, axis: usize| (at as f64 + 0.5 - center[axis]) / side + 0.5;
            let (x, y) = (along(u, 0), along(v, 1));
            if hidden.contains(&u) {
                [200, 190, 60]
            } else if (0.0..1.0).contains(&x) && (0.0..1.0).contains(&y) {
                self.target.get_pixel((x * 120.0) as u32, (y * 120.0) as u32).0
            } else {
                self.ground.get_pixel(u as u32, v as u32).0
            }
        };
        RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, (0..WIDTH * HEIGHT).flat_map(pixel).collect())
            .expect("3 bytes a pixel")
    }

    /// The target of `side` pixels around `center`, a quarter turned.
    fn turned_at(&self, center: [f64; 2], side: f64) -> RgbImage {
        let target = RgbImage::from_fn(120, 120, |u, v| *self.target.get_pixel(v, 119 - u));
        Self { ground: self.ground.clone(), target }.at(center, side)
    }

    fn at(&self, center: [f64; 2], side: f64) -> RgbImage {
        self.with(center, side, 0..0)
    }
}

fn square(center: [f64; 2], side: f64) -> BoundingBox {
    BoundingBox::from_center(center, side, side).expect("a box")
}

fn tracker(painting: &Painting, center: [f64; 2], side: f64) -> CorrelationTracker {
    let params = CorrelationTrackerParams::default();
    CorrelationTracker::new(&painting.at(center, side), square(center, side), params).expect("a target")
}

fn next(tracker: &mut CorrelationTracker, picture: &RgbImage) -> TargetEstimate {
    tracker.track(picture, &mut ChaCha8Rng::seed_from_u64(0)).expect("a picture of the same size")
}

#[test]
fn follows_a_target_that_moves_grows_and_darkens() {
    let painting = Painting::new();
    let mut tracker = tracker(&painting, [50.0, 60.0], 28.0);
    for t in 1..40 {
        let (center, side) = ([50.0 + 1.5 * f64::from(t), 60.0], 28.0 * 1.008_f64.powi(t));
        let mut dimmed = painting.at(center, side);
        dimmed.iter_mut().for_each(|value| *value = (f64::from(*value) * (1.0 - 0.01 * f64::from(t))) as u8);
        let target = next(&mut tracker, &dimmed);
        assert_eq!(target.status, TrackStatus::Tracked, "{t}");
        let iou = target.bounding_box.iou(&square(center, side));
        assert!(iou > RIGHT, "{t}: {iou}");
    }
}

#[test]
fn occluded_target_is_found_behind_the_board() {
    let painting = Painting::new();
    let mut tracker = tracker(&painting, [30.0, 60.0], 28.0);
    let mut last = None;
    for t in 1..50 {
        let center = [30.0 + 2.0 * f64::from(t), 60.0];
        let target = next(&mut tracker, &painting.with(center, 28.0, 70..90));
        last = Some(target.bounding_box.iou(&square(center, 28.0)));
    }
    assert!(last.is_some_and(|iou| iou > RIGHT), "{last:?}");
}

#[test]
fn a_target_that_leaves_is_lost_and_found_where_it_comes_back() {
    let painting = Painting::new();
    let mut tracker = tracker(&painting, [50.0, 50.0], 28.0);
    for t in 1..10 {
        next(&mut tracker, &painting.at([50.0 + f64::from(t), 50.0], 28.0));
    }
    let patience = CorrelationTrackerParams::default().lost_after_n_frames;
    let statuses: Vec<_> = (0..patience + 20).map(|_| next(&mut tracker, &painting.ground).status).collect();
    assert!(statuses[patience..].iter().all(|&status| status == TrackStatus::Lost), "{statuses:?}");

    // every place is looked at within as many pictures as there are places, here fewer than 20
    let back = [120.0, 80.0];
    let found = (0..20)
        .map(|_| next(&mut tracker, &painting.at(back, 28.0)))
        .find(|t| t.status == TrackStatus::Tracked);
    let iou = found.map(|target| target.bounding_box.iou(&square(back, 28.0)));
    assert!(iou.is_some_and(|iou| iou > RIGHT), "{iou:?}");
}

#[test]
fn a_target_that_comes_back_turned_is_found() {
    let painting = Painting::new();
    let mut tracker = tracker(&painting, [50.0, 50.0], 28.0);
    // Pictures that repeat to the bit teach nothing: the target moves a little, as every real one does.
    for t in 0..10 {
        next(&mut tracker, &painting.at([50.0 + 0.1 * f64::from(t), 50.0], 28.0));
    }
    for _ in 0..15 {
        next(&mut tracker, &painting.ground);
    }
    let back = [90.0, 70.0];
    // half of the angles are tried in every picture
    let targets: Vec<_> = (0..4).map(|_| next(&mut tracker, &painting.turned_at(back, 28.0))).collect();
    let found = targets.iter().find(|target| target.status == TrackStatus::Tracked);
    let iou = found.map(|target| target.bounding_box.iou(&square(back, 28.0)));
    assert!(iou.is_some_and(|iou| iou > RIGHT), "{targets:?}");
}

#[test]
fn nothing_is_found_in_pictures_of_one_colour() {
    let painting = Painting::new();
    let mut tracker = tracker(&painting, [50.0, 50.0], 28.0);
    let plain = RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, vec![90; 3 * WIDTH * HEIGHT])
        .expect("3 bytes a pixel");
    let targets: Vec<_> = (0..30).map(|_| next(&mut tracker, &plain)).collect();
    assert!(targets.iter().all(|target| target.quality < 0.1));
    assert!(targets[29].status == TrackStatus::Lost);
    assert!(
        targets[29].bounding_box.iou(&square([50.0, 50.0], 28.0)) > RIGHT,
        "stays where it was seen last"
    );
}

#[test]
fn follows_in_grey_too() {
    let painting = Painting::new();
    let grey = |picture: RgbImage| {
        let luma = |[r, g, b]: [f64; 3]| (0.299 * r + 0.587 * g + 0.114 * b).round() as u8;
        let bytes = picture.pixels().flat_map(|pixel| [luma(pixel.0.map(f64::from)); 3]).collect();
        RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, bytes).expect("3 bytes a pixel")
    };
    let first = grey(painting.at([50.0, 60.0], 28.0));
    let params = CorrelationTrackerParams::default();
    let mut tracker = CorrelationTracker::new(&first, square([50.0, 60.0], 28.0), params).unwrap();
    for t in 1..20 {
        let center = [50.0 + 2.0 * f64::from(t), 60.0];
        let target = next(&mut tracker, &grey(painting.at(center, 28.0)));
        assert!(target.bounding_box.iou(&square(center, 28.0)) > RIGHT, "{t}");
    }
}

#[test]
fn a_picture_of_another_size_is_refused_and_changes_nothing() {
    let painting = Painting::new();
    let mut tracker = tracker(&painting, [50.0, 50.0], 28.0);
    let mut untouched = tracker.clone();
    let refused = tracker.track(&scene(WIDTH - 1, HEIGHT, 1), &mut ChaCha8Rng::seed_from_u64(0));
    assert!(matches!(refused, Err(TrackingError::Dimension { expected: WIDTH, .. })), "{refused:?}");
    let picture = painting.at([53.0, 50.0], 28.0);
    assert_eq!(next(&mut tracker, &picture), next(&mut untouched, &picture));
}

#[test]
fn refuses_targets_that_cannot_be_followed() {
    let picture = scene(WIDTH, HEIGHT, 1);
    let start = |corner: [f64; 2], size: [f64; 2]| {
        let target = BoundingBox::from_corner(corner[0], corner[1], size[0], size[1])?;
        CorrelationTracker::new(&picture, target, CorrelationTrackerParams::default())
    };
    let outside = start([200.0, 10.0], [20.0, 20.0]);
    assert!(matches!(outside, Err(TrackingError::OutsidePicture { .. })));
    assert!(matches!(start([10.0, 10.0], [1.0, 1.0]), Err(TrackingError::Parameter { .. })));
    // all but one column is outside
    assert!(matches!(start([159.0, 10.0], [20.0, 20.0]), Err(TrackingError::Parameter { .. })));
    assert!(start([-1e9, -1e9], [2e9, 2e9]).is_ok(), "what lies outside is cut off");

    let plain = RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, vec![90; 3 * WIDTH * HEIGHT])
        .expect("3 bytes a pixel");
    let target = square([50.0, 50.0], 28.0);
    let featureless = CorrelationTracker::new(&plain, target, CorrelationTrackerParams::default());
    assert!(matches!(featureless, Err(TrackingError::Empty { .. })));
    for params in [
        CorrelationTrackerParams { search_window_scale: f64::NAN, ..Default::default() },
        CorrelationTrackerParams { color_histogram_weight: 1.5, ..Default::default() },
        CorrelationTrackerParams { n_scale_hypotheses: 8, ..Default::default() },
        CorrelationTrackerParams { scale_step: 1.0, ..Default::default() },
        CorrelationTrackerParams { previous_filter_weight: -1.0, ..Default::default() },
    ] {
        let refused = CorrelationTracker::new(&picture, target, params);
        assert!(matches!(refused, Err(TrackingError::Parameter { .. })));
    }
}

#[test]
fn a_picture_that_does_not_change_leaves_the_box_where_it_is() {
    for is_grey in [true, false] {
        let painted = Painting::new().at([70.3, 55.6], 30.0);
        let bytes = painted.pixels().flat_map(|pixel| if is_grey { [pixel.0[1]; 3] } else { pixel.0 });
        let picture =
            RgbImage::from_raw(WIDTH as u32, HEIGHT as u32, bytes.collect()).expect("3 bytes a pixel");
        // beside the middle of the target and a little too small: what is followed is what the box holds
        let first = BoundingBox::from_center([71.0, 54.0], 27.0, 28.0).unwrap();
        let mut tracker =
            CorrelationTracker::new(&picture, first, CorrelationTrackerParams::default()).unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(0);
        let last = (0..100).map(|_| tracker.track(&picture, &mut rng).unwrap()).last().unwrap();
        assert_eq!(last.status, TrackStatus::Tracked);
        // nothing moves, so that nothing adds up however often it is looked at
        assert!(last.bounding_box.iou(&first) > 1.0 - 1e-6, "{is_grey}: {:?}", last.bounding_box);
    }
}
