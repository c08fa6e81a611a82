use std::collections::VecDeque;

use wayfix_color_map::PinholeCamera;
use wayfix_estimation_traits::Pose3;

use super::{buffer::view_change, odometry::OdometryDelta};

/// A camera of the robot, and what its last frames said.
#[derive(Clone, Debug)]
pub(crate) struct RobotCamera {
    pub(crate) model: PinholeCamera,
    /// Since its last frame.
    pub(crate) delta: OdometryDelta,
    /// At its last frame.
    mount: Option<Pose3<f64>>,
    /// Log-likelihood ratios of its last frames to the background at the estimate, nats, and the share of each that is independent of the frame before.
    log_ratios: VecDeque<(f64, f64)>,
}

impl RobotCamera {
    pub(crate) fn new(model: PinholeCamera) -> Self {
        Self { model, delta: OdometryDelta::default(), mount: None, log_ratios: VecDeque::new() }
    }

    /// Share of the evidence of a frame at `mount` that is independent of the frame before: what is not on the map, as another robot, stays in view until the camera has
    /// turned by its field of view, and is one error until then.
    pub(crate) fn independent_share(&self, mount: &Pose3<f64>) -> f64 {
        let Some(before) = &self.mount else { return 1.0 };
        let half = f64::from(self.model.height()) / 2.0;
        let field_of_view = 2.0 * (half / self.model.fy()).atan();
        (view_change(before, &self.delta, mount) / field_of_view).min(1.0)
    }

    /// Remembers a frame as long as it is among the last `n_frames`.
    pub(crate) fn remember(&mut self, mount: &Pose3<f64>, (log_ratio, share): (f64, f64), n_frames: usize) {
        (self.mount, self.delta) = (Some(*mount), OdometryDelta::default());
        self.log_ratios.push_back((log_ratio, share));
        self.log_ratios.drain(..self.log_ratios.len().saturating_sub(n_frames));
    }

    /// Log-likelihood ratio of the last frames to the background, nats: the mean of a frame times the number of independent frames.
    pub(crate) fn log_support(&self) -> f64 {
        let mean =
            self.log_ratios.iter().map(|(log, _)| log).sum::<f64>() / self.log_ratios.len().max(1) as f64;
        mean * self.log_ratios.iter().map(|(_, share)| share).sum::<f64>().max(1.0)
    }
}
