use std::time::Duration;

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_sensor_log::{EncodedImage, Record, RecordData, Stamp};
use wayfix_system_core::{EventCounts, Stopwatch, System};
use wayfix_visual_tracking::{
    BoundingBox, HeadDetector, RgbImage, TargetEstimate, TrackStatus, TrackingError,
};

use super::{
    BoxScore, FrameTracker, InitialTargetRegion, LostStatusScore, TargetColorDistribution, TargetTruth,
    TrackParams, TrackSystemError, TrackingMethod, TrueBoxes, frozen_film::FrozenFilmCheck,
};

/// A tracker that processes the images of a log.
///
/// It starts in the first readable frame with a box: the given box or mask, else a true box. With a detector it starts where a head is found. An unreadable or rejected frame has no
/// estimate. If its truth is known, it counts with overlap 0, like a frame in which the tracker reports the target lost.
pub struct TrackSystem {
    setup: TrackerConfig,
    rng: ChaCha8Rng,
    tracker: Option<Box<dyn FrameTracker>>,
    failure: Option<TrackSystemError>,
    next_index: usize,
    last: Option<TrackFrameResult>,
    was_lost: bool,
    score: BoxScore,
    status_score: LostStatusScore,
    totals: Totals,
    /// The first frame with an estimate, if a detector found it, and its overlap with the true box.
    detected: Option<(usize, Option<f64>)>,
    film: FrozenFilmCheck,
    events: EventCounts,
}

/// Setup of a [`TrackSystem`].
#[derive(Clone, Debug, Default)]
pub struct TrackerConfig {
    /// The tracker.
    pub method: TrackingMethod,
    /// Its parameters.
    pub params: TrackParams,
    /// Position of the target in the first frame; `None` uses the first true box.
    pub init: Option<InitialTargetRegion>,
    /// Finds a head that the tracker starts with, in the first frame that shows one; `init` and the truth then start nothing.
    pub detector: Option<HeadDetector>,
    /// The true boxes.
    pub truth: TrueBoxes,
    /// Frame rate of a folder, in Hz. It gives the frame number from the stamp; without it, frames are counted.
    pub rate_hz: Option<f64>,
}

/// Result of one frame.
#[derive(Clone, Debug)]
pub struct TrackFrameResult {
    /// Frame number in the sequence, from 0, including unreadable frames.
    pub index: usize,
    /// Capture time.
    pub stamp: Stamp,
    /// The pixels.
    pub picture: RgbImage,
    /// The tracker's estimate.
    pub target: TargetEstimate,
    /// The truth of this frame.
    pub truth: TargetTruth,
    /// Overlap with the truth, 0 if the tracker reports the target lost; `None` without a true box.
    pub iou: Option<f64>,
    /// Colour distribution of the target, if the tracker models it.
    pub colors: Option<TargetColorDistribution>,
    /// Computing time of the tracker, without decoding; zero in the first frame.
    pub step: Duration,
}

/// Counts and times of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Totals {
    pub(super) n_lost: u64,
    pub(super) n_frames_without_estimate: u64,
    pub(super) n_steps: u64,
    pub(super) time: Duration,
    pub(super) longest: Duration,
}

impl TrackSystem {
    /// Creates a system before its first image.
    pub fn new(setup: TrackerConfig, seed: u64) -> Self {
        let mut events = EventCounts::default();
        if let Some(doubt) = setup.truth.unusable_lines_message() {
            events.warn("truth_line_unusable", doubt);
        }
        Self {
            setup,
            rng: ChaCha8Rng::seed_from_u64(seed),
            tracker: None,
            failure: None,
            next_index: 0,
            last: None,
            was_lost: false,
            score: BoxScore::default(),
            status_score: LostStatusScore::default(),
            totals: Totals::default(),
            detected: None,
            film: FrozenFilmCheck::default(),
            events,
        }
    }

    /// Result of the newest frame; `None` if it has no estimate.
    pub fn frame(&self) -> Option<&TrackFrameResult> {
        self.last.as_ref()
    }

    /// Tracking accuracy so far.
    pub fn score(&self) -> &BoxScore {
        &self.score
    }

    /// Error rates of the lost status so far.
    pub(crate) fn status_score(&self) -> &LostStatusScore {
        &self.status_score
    }

    /// The true boxes.
    pub fn truth(&self) -> &TrueBoxes {
        &self.setup.truth
    }

    /// Number of frames so far, including unreadable ones.
    pub fn n_frames(&self) -> usize {
        self.next_index
    }

    pub(super) fn detected(&self) -> Option<(usize, Option<f64>)> {
        self.detected
    }

    pub(super) fn totals(&self) -> &Totals {
        &self.totals
    }

    pub(super) fn has_begun(&self) -> bool {
        self.tracker.is_some()
    }

    /// Takes the error that kept the tracker from starting.
    pub(super) fn take_failure(&mut self) -> Option<TrackSystemError> {
        self.failure.take()
    }

    /// Counts the missing, unreadable frames before `index`.
    pub(super) fn pass_over(&mut self, index: usize) {
        while self.next_index < index {
            self.without_estimate();
            self.events.count("frame_unreadable");
        }
    }

    /// Counts the next frame as one without an estimate.
    fn without_estimate(&mut self) {
        self.last = None;
        if let (true, TargetTruth::At(truth)) = (self.has_begun(), self.setup.truth.at(self.next_index)) {
            self.score.add(None, &truth);
        }
        self.totals.n_frames_without_estimate += 1;
        self.next_index += 1;
    }

    fn see(&mut self, stamp: Stamp, image: &EncodedImage) -> Result<(), String> {
        if let Some(rate_hz) = self.setup.rate_hz {
            self.pass_over((stamp.nanoseconds() as f64 * 1e-9 * rate_hz).round() as usize);
        }
        match self.follow(image) {
            Ok(Some((picture, target, step))) => {
                let is_repeated = self.last.as_ref().is_some_and(|last| last.picture == picture);
                self.film.check(stamp, is_repeated, &mut self.events);
                self.account(stamp, picture, target, step);
                Ok(())
            }
            Ok(None) => {
                self.without_estimate();
                let detects = self.setup.detector.is_some();
                self.events.count(if detects { "head_not_detected" } else { "record_before_start" });
                Ok(())
            }
            Err(reason) => {
                let reason = format!("frame {}: {reason}", self.next_index);
                self.without_estimate();
                Err(reason)
            }
        }
    }

    /// Tracks the target in a frame; `None` before the first box.
    fn follow(
        &mut self,
        image: &EncodedImage,
    ) -> Result<Option<(RgbImage, TargetEstimate, Duration)>, String> {
        if self.failure.is_some() {
            return Err("the tracker could not begin".to_owned());
        }
        let decoded = image.decode_rgb().map_err(|error| error.to_string())?;
        let (width, height) = (decoded.width, decoded.height);
        let picture = RgbImage::from_raw(width, height, decoded.pixels)
            .ok_or_else(|| format!("the image has not three bytes for each of {width} x {height} pixels"))?;
        if let Some(tracker) = &mut self.tracker {
            let stopwatch = Stopwatch::start();
            let target = tracker.track_frame(&picture, &mut self.rng).map_err(|error| error.to_string())?;
            return Ok(Some((picture, target, stopwatch.elapsed())));
        }
        let true_box = self.setup.truth.at(self.next_index).target();
        let start = match &self.setup.detector {
            Some(detector) => detected(detector, &picture).map_err(|error| error.to_string())?,
            None => self.setup.init.clone().or(true_box.map(InitialTargetRegion::Box)),
        };
        let Some(start) = start else { return Ok(None) };
        let begun = self.setup.method.begin(&self.setup.params, &picture, &start);
        match begun.and_then(|tracker| Ok((tracker, start.bounding_box()?))) {
            Ok((tracker, bounding_box)) => {
                self.tracker = Some(tracker);
                if self.setup.detector.is_some() {
                    self.detected = Some((self.next_index, true_box.map(|truth| bounding_box.iou(&truth))));
                }
                let (outline, status) = (Vec::new(), TrackStatus::Tracked);
                let target = TargetEstimate { bounding_box, outline, status, quality: 1.0 };
                Ok(Some((picture, target, Duration::ZERO)))
            }
            Err(source) => {
                self.failure = Some(TrackSystemError::Start { init: start.name(), width, height, source });
                Err("the tracker could not begin".to_owned())
            }
        }
    }

    fn account(&mut self, stamp: Stamp, picture: RgbImage, target: TargetEstimate, step: Duration) {
        let index = self.next_index;
        let truth = self.setup.truth.at(index);
        let lost = target.status == TrackStatus::Lost;
        let estimate = (!lost).then_some(&target.bounding_box);
        if let TargetTruth::At(truth) = &truth {
            self.score.add(estimate, truth);
        }
        match truth {
            TargetTruth::At(truth) => self.status_score.add(target.bounding_box.iou(&truth), lost),
            TargetTruth::Absent => self.status_score.add(0.0, lost),
            TargetTruth::Unknown => {}
        }
        match (lost, truth) {
            (true, TargetTruth::Absent) => self.events.count("target_absent_and_reported_lost"),
            (false, TargetTruth::Absent) => self.events.count("target_absent_but_reported_tracked"),
            _ => {}
        }
        match (self.was_lost, lost) {
            (false, true) => self.events.count("target_lost"),
            (true, false) => self.events.count("target_reacquired"),
            _ => {}
        }
        self.was_lost = lost;
        self.totals.n_lost += u64::from(lost);
        if step > Duration::ZERO {
            self.totals.n_steps += 1;
            self.totals.time += step;
            self.totals.longest = self.totals.longest.max(step);
        }
        let iou = truth.target().map(|truth| estimate.map_or(0.0, |estimate| estimate.iou(&truth)));
        let colors = self.tracker.as_ref().and_then(|tracker| tracker.colors());
        self.next_index += 1;
        self.last = Some(TrackFrameResult { index, stamp, picture, target, truth, iou, colors, step });
    }
}

/// The head that a detector finds in a picture, of any width from the smallest that a tracker can follow to the picture's.
fn detected(
    detector: &HeadDetector,
    picture: &RgbImage,
) -> Result<Option<InitialTargetRegion>, TrackingError> {
    let most = f64::from(picture.width().min(picture.height())).max(HeadDetector::MIN_WIDTH);
    let found: Option<BoundingBox> = detector.detect(picture, HeadDetector::MIN_WIDTH..=most)?;
    Ok(found.map(InitialTargetRegion::Box))
}

impl System for TrackSystem {
    fn take(&mut self, record: &Record) -> Result<(), String> {
        match &record.data {
            RecordData::Image(image) => self.see(record.stamp, image),
            _ => Ok(()),
        }
    }

    fn events(&mut self) -> &mut EventCounts {
        &mut self.events
    }
}
