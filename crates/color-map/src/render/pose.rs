use wayfix_estimation_traits::Pose3;

use crate::RenderError;

/// Farthest coordinate of the eye, metres, as that of a map.
const MAX_COORDINATE: f64 = 1e6;
/// Difference of the squared quaternion length from one that is still rounding.
const UNIT: f64 = 1e-6;

/// Checks a camera pose.
pub(super) fn check(pose: &Pose3<f64>) -> Result<(), RenderError> {
    for &value in &pose.translation {
        if !(-MAX_COORDINATE..=MAX_COORDINATE).contains(&value) {
            return Err(RenderError::Pose { what: "coordinate, m", value, must: "within ±1e6" });
        }
    }
    let value = pose.rotation.as_ref().norm_squared();
    if !(1.0 - UNIT..=1.0 + UNIT).contains(&value) {
        return Err(RenderError::Pose { what: "squared length of the quaternion", value, must: "1" });
    }
    Ok(())
}
