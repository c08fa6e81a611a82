use anyhow::Result;
use nalgebra::{Matrix1, Vector1};
use wayfix_slam_ekf::{
    EkfSlam, KnownIdAssociation, LandmarkId, LineDistanceSensor, MonobotMotion, Observation, SlamParams,
    observability::ObservabilityRecorder,
};

/// The first entry of the total Fisher information after each of `n_steps` scans of `n_landmarks`, with $`P_{r,0|0} = V = W = 1`$.
/// [Andrade-Cetto 2005, Eq. 15, Fig. 3]
///
/// The system is linear with constant noise, so the information does not depend on the measurements.
/// # Errors
/// Returns an error if the filter refuses, which it has no reason to.
pub(crate) fn first_entry(n_landmarks: u32, n_steps: usize) -> Result<Vec<f64>> {
    let sensor = LineDistanceSensor { sigma: 1.0, sigma_per_meter: 0.0 };
    let motion = MonobotMotion { sigma: 1.0, sigma_per_meter: 0.0 };
    let start = (Vector1::zeros(), Matrix1::identity());
    let mut slam = EkfSlam::with_start_covariance(sensor, SlamParams::default(), start.0, start.1)?;
    let ids: Vec<LandmarkId> = (0..n_landmarks).map(LandmarkId).collect();
    let seen: Vec<_> =
        ids.iter().map(|id| Observation { label: Some(*id), measurement: Vector1::new(1.0) }).collect();
    slam.update(&seen, &mut KnownIdAssociation)?;
    let mut recorder = ObservabilityRecorder::new(&slam);
    (0..n_steps)
        .map(|_| {
            slam.predict(&motion, &Vector1::zeros())?;
            recorder.record(&slam, &ids);
            slam.update(&seen, &mut KnownIdAssociation)?;
            Ok(recorder.information()[(0, 0)])
        })
        .collect()
}

/// The asymptotic gain per scan: $`n / (n p + 1)`$, with $`p = (n + \sqrt{n^2 + 4 n}) / 2n`$ the predicted variance of the robot relative to its map,
/// where $`p = 1 + p / (n p + 1)`$.
/// ```
/// // One landmark: p is the golden ratio.
/// let golden = (1.0 + 5.0_f64.sqrt()) / 2.0;
/// assert!((wayfix_experiments::monobot::expected_rate(1) - 1.0 / (golden + 1.0)).abs() < 1e-12);
/// ```
pub fn expected_rate(n_landmarks: u32) -> f64 {
    let n = f64::from(n_landmarks);
    let predicted = (n + (n * n + 4.0 * n).sqrt()) / (2.0 * n);
    n / (n * predicted + 1.0)
}
