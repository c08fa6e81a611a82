use anyhow::{Result, bail};
use wayfix_estimation_traits::{Manifold, Pose2};
use wayfix_sensor_log::{Data, Record};

use super::{WallSlamParams, WallSystem};
use crate::{
    evaluate::{Sample, TrueTrack},
    slam::Keyframe,
    system::{Events, System, drive},
};

/// A log of scans that went through EKF-SLAM with walls, beside the poses that the log itself holds.
pub struct WallRun {
    /// The system in its last state.
    pub system: WallSystem,
    /// True poses, or those that another program corrected, where the log has them.
    pub truth: TrueTrack,
}

/// Runs EKF-SLAM with walls over the records of a log and shows the system to `observe` after each.
///
/// The start pose is the log's own where its first scan is, else the origin; nothing else ties the run to it.
///
/// # Errors
/// When there is no odometry, no scan, or a parameter is out of range.
pub fn run(records: &[Record], params: &WallSlamParams, observe: impl FnMut(&WallSystem)) -> Result<WallRun> {
    let first = |is: fn(&Data) -> bool| records.iter().find(|record| is(&record.data));
    let Some(scan) = first(|data| matches!(data, Data::Scan(_))) else {
        bail!("the log has no laser scans (`wayfix info` shows what a log holds)");
    };
    if first(|data| matches!(data, Data::OdometryIncrement(_))).is_none() {
        bail!(
            "the log has no odometry increments, which EKF-SLAM with walls needs (`wayfix info` shows what it holds)"
        );
    }
    let truth = TrueTrack::from_records_or_estimates(records);
    let start = match params.start {
        Some([x, y, heading]) => Pose2::new(x, y, heading),
        None => truth.at(scan.stamp).unwrap_or(Pose2::new(0.0, 0.0, 0.0)),
    };
    let mut system = WallSystem::new(params.clone(), start)?;
    drive(&mut system, records, observe);
    if system.keyframes().is_empty() {
        bail!("none of the scans could be used; the events tell why");
    }
    let mut run = WallRun { system, truth };
    if run
        .samples()
        .iter()
        .all(|(keyframe, sample)| sample.truth.local(&keyframe.dead_reckoning).norm() < SAME)
    {
        run.truth = TrueTrack::default(); // the log's poses are its odometry
    }
    Ok(run)
}

/// Below this distance poses are the same but for printed digits, m and rad.
const SAME: f64 = 1e-3;

impl WallRun {
    /// Keyframes with the poses of the log.
    pub fn samples(&self) -> Vec<(Keyframe, Sample)> {
        let sample = |keyframe: &Keyframe| {
            let truth = self.truth.at(keyframe.stamp)?;
            Some((*keyframe, Sample { estimate: keyframe.pose, covariance: keyframe.covariance, truth }))
        };
        self.system.keyframes().iter().filter_map(sample).collect()
    }
    /// What happened.
    pub fn events(&mut self) -> &mut Events {
        self.system.events()
    }
}
