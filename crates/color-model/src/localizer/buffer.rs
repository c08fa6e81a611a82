use std::collections::VecDeque;

use nalgebra::{UnitQuaternion, Vector3};
use wayfix_estimation_traits::Pose3;

use super::odometry::OdometryDelta;
use crate::YuvImage;

/// A frame, and the odometry since the one before.
#[derive(Clone, Debug)]
pub(crate) struct BufferedFrame {
    pub(crate) image: YuvImage,
    pub(crate) mount: Pose3<f64>,
    pub(crate) odometry: OdometryDelta,
}

/// Angle between the views of a camera at two mounts with this odometry between, rad: rotation of the camera, and translation as seen at a distance of 1 m.
pub(crate) fn view_change(before: &Pose3<f64>, odometry: &OdometryDelta, after: &Pose3<f64>) -> f64 {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), odometry.increment.heading());
    let rotation = before.rotation.inverse() * turn * after.rotation;
    rotation.angle() + odometry.increment.translation.norm()
}

/// The last frames, for the global search.
#[derive(Clone, Debug, Default)]
pub(crate) struct FrameBuffer(VecDeque<BufferedFrame>);

impl FrameBuffer {
    /// Adds the newest frame and keeps the last `capacity`.
    pub(crate) fn push(&mut self, frame: BufferedFrame, capacity: usize) {
        self.0.push_back(frame);
        while self.0.len() > capacity {
            self.0.pop_front();
        }
    }

    /// All frames, the newest last.
    pub(crate) fn frames(&self) -> Vec<BufferedFrame> {
        self.0.iter().cloned().collect()
    }
}
