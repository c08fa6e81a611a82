use std::collections::BTreeMap;

use anyhow::{Result, ensure};
use nalgebra::{Matrix3, Vector2};
use wayfix_estimation_traits::{LieGroup, Pose2};
use wayfix_evaluation::errors::{PoseWithTruth, ReferencePath};
use wayfix_sensor_log::{Record, RecordData, Stamp};
use wayfix_slam_smoother::range_only::{
    self, Calibration, CalibrationPrior, RangeOnlyEstimate, RangeOnlyNoise, RangeOnlyParams,
};
use wayfix_system_core::{
    EventCounts, Stopwatch, TrueStartPose, warn_of_large_errors, warn_of_no_overlap, warn_of_start,
};
use wayfix_table_log::RangeRecording;

use super::input::StampedInput;
use crate::slam::StampedEstimate;

/// The result of the batch on a recording of ranges, with the truth.
pub struct RangeRun {
    /// Path, beacons, calibration and noise.
    pub estimate: RangeOnlyEstimate,
    /// Poses with covariances, evenly over the run.
    pub stamped_estimates: Vec<StampedEstimate>,
    /// True poses, where the recording has them.
    pub truth: ReferencePath,
    /// True beacons, where the recording has them.
    pub true_beacons: BTreeMap<u32, Vector2<f64>>,
    /// What happened.
    pub events: EventCounts,
}

/// Estimates path and beacons of a recording; `truth` may replace its own. The start pose is the truth where odometry starts, else the origin;
/// nothing else ties the run to the truth.
///
/// # Errors
/// When no range can be used, no beacon can be placed, or the least squares problem cannot be solved.
pub fn run(recording: &RangeRecording, truth: &[Record]) -> Result<RangeRun> {
    let mut events = EventCounts::default();
    let path = ReferencePath::from_records(truth);
    let begin = recording.odometry.first().map(|(stamp, _)| *stamp).unwrap_or_default();
    let increment = |(stamp, increment): &(Stamp, Pose2<f64>)| Record {
        stamp: *stamp,
        data: RecordData::OdometryIncrement(*increment),
    };
    let odometry: Vec<Record> = recording.odometry.iter().map(increment).collect();
    let known = TrueStartPose::at(begin, &path, &odometry);
    if known.is_some() {
        warn_of_start(&mut events, known, &path);
    } else {
        events.warn(
            "start_pose_unknown",
            "no true pose at the start: the run starts at (0, 0, 0), and figures are aligned ones only",
        );
    }
    let stopwatch = Stopwatch::start();
    let StampedInput { stamps, input } =
        StampedInput::new(recording, known.map_or(Pose2::identity(), |known| known.pose), &mut events);
    ensure!(!input.ranges.is_empty(), "no range is positive and within the time of odometry");
    let estimate = range_only::estimate(&input, &RangeOnlyParams::default())?;
    let dead_reckoning = input.dead_reckoning();
    let step = stopwatch.elapsed() / stamps.len() as u32;
    let stamped = |(index, covariance): &(usize, Matrix3<f64>)| StampedEstimate {
        stamp: stamps[*index],
        pose: estimate.poses[*index],
        covariance: *covariance,
        dead_reckoning: dead_reckoning[*index],
        n_landmarks: estimate.beacons.len(),
        nis: (0.0, 0),
        step,
    };
    let stamped_estimates: Vec<_> = estimate.pose_covariances.iter().map(stamped).collect();
    say_assumptions(&estimate, &CalibrationPrior::default(), &mut events);
    let span = stamps.first().copied().zip(stamps.last().copied());
    warn_of_no_overlap(&mut events, &path, span);
    let true_beacons = truth.iter().filter_map(|record| match record.data {
        RecordData::TrueLandmark(beacon) => Some((beacon.id, Vector2::new(beacon.x, beacon.y))),
        _ => None,
    });
    let true_beacons = true_beacons.collect();
    let mut run = RangeRun { estimate, stamped_estimates, truth: path, true_beacons, events };
    let samples: Vec<PoseWithTruth> = run.samples().into_iter().map(|(_, sample)| sample).collect();
    warn_of_large_errors(&mut run.events, &run.truth, &samples);
    Ok(run)
}

fn say_assumptions(estimate: &RangeOnlyEstimate, prior: &CalibrationPrior, events: &mut EventCounts) {
    let RangeOnlyNoise { translation_per_sqrt_meter, heading_per_sqrt_meter, .. } = estimate.noise;
    let (range, sigma) = (estimate.range_sigma, estimate.calibration_sigma);
    let Calibration { bias, log_scale } = estimate.calibration;
    events.warn(
        "receiver_calibration_estimated",
        format!(
            "one bias and one scale for all beacons, by the log: {bias:.3} m (σ {:.3}) and {:.4} (σ {:.4}); beforehand 0 m (σ {}) and 1 (σ {})",
            sigma.bias, log_scale.exp(), sigma.log_scale, prior.bias_sigma, prior.log_scale_sigma
        ),
    );
    events.warn(
        "noise_estimated",
        format!(
            "noise by the likelihood of the log: ranges {range:.3} m, odometry {translation_per_sqrt_meter:.4} m/√m and {heading_per_sqrt_meter:.5} rad/√m, white; large residuals weigh less (Cauchy)"
        ),
    );
    events.warn(
        "odometry_scale_and_direction_unknown",
        format!(
            "no range constrains scale and direction of odometry: covariances include {:.1} % of the distance from the start, by the scale of the receiver",
            100.0 * estimate.odometry_error_sigma
        ),
    );
    events.add("range_outlier", estimate.n_outliers as u64);
    events.add("observation_accepted", estimate.n_ranges as u64);
    for unplaced in &estimate.unplaced {
        let places: Vec<String> =
            unplaced.places.iter().map(|place| format!("({:.1}, {:.1})", place.x, place.y)).collect();
        let why = match places.as_slice() {
            [] => "too few ranges".to_owned(),
            [one] => format!("its ranges hardly constrain it to {one}"),
            several => format!("{} fit equally well", several.join(" and ")),
        };
        let text = format!(
            "beacon {} has no place ({why}): its {} ranges are not used",
            unplaced.beacon, unplaced.n_ranges
        );
        events.warn("beacon_not_placed", text);
    }
}

impl RangeRun {
    /// Estimates with their true poses.
    pub fn samples(&self) -> Vec<(StampedEstimate, PoseWithTruth)> {
        let sample = |estimate: &StampedEstimate| {
            let StampedEstimate { stamp, pose, covariance, .. } = estimate;
            Some((*estimate, self.truth.sample(*stamp, *pose, covariance)?))
        };
        self.stamped_estimates.iter().filter_map(sample).collect()
    }
}
