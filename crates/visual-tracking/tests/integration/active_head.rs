//! A camera on a pan/tilt head that follows a target, and a head that does not answer.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_visual_tracking::{
    ActiveTracker, BoundingBox, HeadTracker, HeadTrackerParams, PanTiltAim, PanTiltHead, PanTiltLimits,
    RgbImage, SimulatedPanTilt, TrackStatus, Tracker, TrackingError,
};

const FOCAL_LENGTH_PX: f64 = 150.0;
const SIZE: [u32; 2] = [160, 120];

/// A disc at a bearing, as a camera at `angles` shows it.
fn picture(bearing: [f64; 2], angles: [f64; 2]) -> (RgbImage, [f64; 2]) {
    let at = [0, 1].map(|k| f64::from(SIZE[k]) / 2.0 + FOCAL_LENGTH_PX * (bearing[k] - angles[k]).tan());
    let shown = RgbImage::from_fn(SIZE[0], SIZE[1], |u, v| {
        let (x, y) = (f64::from(u) + 0.5 - at[0], f64::from(v) + 0.5 - at[1]);
        image::Rgb(if x.hypot(y) < 12.0 { [220, 160, 130] } else { [90, 120, 150] })
    });
    (shown, at)
}

fn started() -> HeadTracker {
    let head = BoundingBox::from_center([80.0, 60.0], 24.0, 24.0).expect("a box");
    HeadTracker::new(&picture([0.0; 2], [0.0; 2]).0, head, HeadTrackerParams::default()).expect("a head")
}

fn aim(delay: f64) -> PanTiltAim {
    PanTiltAim::new(FOCAL_LENGTH_PX, [80.0, 60.0], delay).expect("an aim")
}

fn rng() -> ChaCha8Rng {
    ChaCha8Rng::seed_from_u64(0)
}

/// Pixels from the middle after three seconds, and the status, of a target that pans at `rate` rad/s.
fn off_after_3_s(rate: f64, limits: PanTiltLimits) -> (f64, TrackStatus) {
    let head = SimulatedPanTilt::new(limits, 1, 0.04).expect("a head");
    let mut active = ActiveTracker::new(started(), aim(2.0), head);
    let (mut off, mut status) = (0.0, TrackStatus::Tracked);
    for t in 1..=75 {
        active.head.advance();
        let angles = active.head.angles().expect("it answers");
        let (shown, at) = picture([0.04 * rate * f64::from(t), 0.0], angles);
        off = (at[0] - 80.0).abs();
        status = active.step(&shown, &mut rng()).expect("a picture").target.status;
    }
    (off, status)
}

#[test]
fn keeps_the_middle_within_its_limits_and_loses_beyond() {
    let (off, status) = off_after_3_s(0.4, PanTiltLimits::default());
    // a constant velocity is predicted without lag; the tracker counts whole pixels, three of them with the delay
    assert!(off <= 3.0 && status == TrackStatus::Tracked, "{off} {status:?}");
    let short = PanTiltLimits { pan: -0.2..=0.2, ..PanTiltLimits::default() };
    let (off, status) = off_after_3_s(0.4, short);
    assert!(off > 80.0 && status == TrackStatus::Lost, "{off} {status:?}");
}

/// It answers while the flag is set.
struct Loose(bool);

impl PanTiltHead for Loose {
    type Error = &'static str;

    fn angles(&mut self) -> Result<[f64; 2], Self::Error> {
        if self.0 { Ok([0.0; 2]) } else { Err("no answer") }
    }

    fn turn_to(&mut self, _angles: [f64; 2]) -> Result<(), Self::Error> {
        if self.0 { Ok(()) } else { Err("no answer") }
    }
}

#[test]
fn a_head_that_does_not_answer_is_counted_and_tracking_goes_on() {
    let (mut active, mut alone) = (ActiveTracker::new(started(), aim(1.0), Loose(true)), started());
    for t in 0..10 {
        active.head.0 = t < 3;
        let (shown, _) = picture([0.01 * f64::from(t), 0.0], [0.0; 2]);
        let both = active.step(&shown, &mut rng()).expect("a picture");
        assert_eq!(both.target, alone.track(&shown, &mut rng()).expect("a picture"));
        assert_eq!(both.sent.is_err(), t >= 3);
    }
    assert_eq!(active.n_unanswered(), 7);
}

#[test]
fn refuses_what_no_camera_and_no_head_has() {
    for (focal_length, delay) in [(0.0, 1.0), (f64::NAN, 1.0), (100.0, -1.0), (100.0, f64::INFINITY)] {
        let refused = PanTiltAim::new(focal_length, [80.0, 60.0], delay);
        assert!(matches!(refused, Err(TrackingError::Parameter { .. })), "{focal_length} {delay}");
    }
    let elsewhere = PanTiltLimits { pan: 0.5..=1.0, ..PanTiltLimits::default() };
    assert!(matches!(SimulatedPanTilt::new(elsewhere, 0, 0.04), Err(TrackingError::Parameter { .. })));
    let mut head = SimulatedPanTilt::new(PanTiltLimits::default(), 0, 0.04).expect("a head");
    assert!(matches!(head.turn_to([f64::NAN, 0.0]), Err(TrackingError::NotFinite { .. })));
    head.advance();
    assert_eq!(head.angles(), Ok([0.0; 2]));
}
