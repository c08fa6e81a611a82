use anyhow::Result;
use nalgebra::{Matrix1, Vector1};
use wayfix_scene_sim::monobot::{MonobotParams, MonobotRun};
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkConfirmationParams, LandmarkId, LineDistanceSensor, MonobotMotion,
    Observation, SlamParams, observability::ObservabilityRecorder,
};

use super::{FixedPositionSensor, WorldReference};

/// Estimate and truth after one scan: of the first landmark, and of the mean over all.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MonobotStep {
    /// True position of the robot, m.
    pub true_position: f64,
    /// Estimated position of the robot, m.
    pub position: f64,
    /// Standard deviation of that.
    pub position_sigma: f64,
    /// Estimated position of the first landmark, m.
    pub landmark: f64,
    /// Standard deviation of that.
    pub landmark_sigma: f64,
    /// Mean error over all landmarks: estimate minus truth.
    pub mean_landmark_error: f64,
    /// Kalman gains of the measurement of the first landmark, for robot and landmark; NaN before it is in the map, which plots leave out.
    pub gains: [f64; 2],
}

/// One drive through the filter.
#[derive(Clone, Debug)]
pub(crate) struct MonobotDrive {
    /// One step per scan; the first one initializes the landmarks.
    pub steps: Vec<MonobotStep>,
    /// True place of the landmarks, m.
    pub true_landmark: f64,
    /// Information of the measurements.
    pub observability: ObservabilityRecorder,
}

/// The anchor's identity, after those of all landmarks.
const ANCHOR: LandmarkId = LandmarkId(u32::MAX);
/// Minimum σ of a range, m: noise in proportion to distance alone would make a range of 0 exact.
const SMALLEST_SIGMA: f64 = 1e-6;

/// The plain Kalman filter: every landmark is used at once, without gating.
pub(crate) fn plain_filter() -> SlamParams {
    let confirmation =
        LandmarkConfirmationParams { min_detections: 1, ..LandmarkConfirmationParams::default() };
    SlamParams { gate_probability: 1.0 - 1e-12, confirmation, ..SlamParams::default() }
}

/// Runs a simulated drive through EKF-SLAM from the true start.
///
/// # Errors
/// Returns an error if the filter refuses a simulated measurement.
pub(crate) fn drive(
    params: &MonobotParams,
    run: &MonobotRun,
    reference: WorldReference,
) -> Result<MonobotDrive> {
    let sensor = LineDistanceSensor { sigma: SMALLEST_SIGMA, sigma_per_meter: params.range_sigma_share };
    let motion = MonobotMotion { sigma: 0.0, sigma_per_meter: params.motion_sigma_share };
    let camera = FixedPositionSensor(params.external_position_sigma_m);
    let mut slam = EkfSlam::new(sensor, plain_filter(), Vector1::new(run.positions[0]))?;
    if reference == WorldReference::Anchor {
        slam.add_anchor(ANCHOR, Vector1::zeros())?;
    }
    let mut observability = ObservabilityRecorder::new(&slam);
    let mut steps = Vec::with_capacity(run.positions.len());
    for (k, true_position) in run.positions.iter().enumerate() {
        if let Some(before) = k.checked_sub(1) {
            slam.predict(&motion, &Vector1::new(run.controls[before]))?;
        }
        if reference == WorldReference::Camera {
            let innovation = slam.update_robot(&camera, &Vector1::new(run.external_positions[k]))?;
            observability.record_robot(&slam, &Matrix1::identity(), &innovation.covariance);
        }
        let gains = gains(&slam, run.ranges[k].first().copied());
        let seen = observations(run, k, reference);
        slam.update(&seen, &mut KnownIdAssociation)?;
        observability.record(&slam, &seen.iter().filter_map(|seen| seen.label).collect::<Vec<_>>());
        steps.extend(step(&slam, *true_position, params.landmark_position_m, gains));
    }
    Ok(MonobotDrive { steps, true_landmark: params.landmark_position_m, observability })
}

fn observations(run: &MonobotRun, k: usize, reference: WorldReference) -> Vec<Observation<Vector1<f64>>> {
    let ids = (0..).map(LandmarkId);
    let anchor = (reference == WorldReference::Anchor).then_some((ANCHOR, run.anchor_ranges[k]));
    let all = anchor.into_iter().chain(ids.zip(run.ranges[k].iter().copied()));
    all.map(|(id, distance)| Observation { label: Some(id), measurement: Vector1::new(distance) }).collect()
}

/// $`K = P H^T s^{-1}`$ with $`H = (-1, 1)`$ for a measurement of the first landmark alone; NaN before it is in the map.
fn gains(slam: &EkfSlam<LineDistanceSensor>, distance: Option<f64>) -> [f64; 2] {
    use wayfix_slam_ekf::LandmarkModel;
    let (Some(distance), true) = (distance, slam.contains(LandmarkId(0))) else { return [f64::NAN; 2] };
    let p = slam.covariance();
    let noise = slam.model().noise(&Vector1::new(distance)).x;
    let s = p[(0, 0)] - 2.0 * p[(0, 1)] + p[(1, 1)] + noise;
    [(p[(0, 1)] - p[(0, 0)]) / s, (p[(1, 1)] - p[(0, 1)]) / s]
}

fn step(
    slam: &EkfSlam<LineDistanceSensor>,
    true_position: f64,
    true_landmark: f64,
    gains: [f64; 2],
) -> Option<MonobotStep> {
    let first = slam.landmark(LandmarkId(0))?;
    let errors: Vec<f64> = slam.landmarks().map(|landmark| landmark.mean.x - true_landmark).collect();
    Some(MonobotStep {
        true_position,
        position: slam.robot().x,
        position_sigma: slam.robot_covariance().x.sqrt(),
        landmark: first.mean.x,
        landmark_sigma: first.covariance.x.sqrt(),
        mean_landmark_error: errors.iter().sum::<f64>() / errors.len() as f64,
        gains,
    })
}
