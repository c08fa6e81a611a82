//! Faults of a single message, and the common checks.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use wayfix_encoded_image::ImageError;
use wayfix_estimation_traits::Pose3;

use crate::RowProblemKind;
use crate::planar::NORM_TOLERANCE;

/// A fault of a message.
pub(crate) type Fault = (RowProblemKind, String);

/// Tolerance of the norm of a unit quaternion in doubles after a few products.
const ROUNDING: f64 = 1e-12;

pub(crate) fn unreadable_image(error: &ImageError) -> Fault {
    (RowProblemKind::UnreadableImage, error.to_string())
}

pub(crate) fn inconsistent(reason: &str) -> Fault {
    (RowProblemKind::Inconsistent, reason.to_owned())
}

pub(crate) fn finite(numbers: impl IntoIterator<Item = f64>) -> Result<(), Fault> {
    match numbers.into_iter().find(|number| !number.is_finite()) {
        None => Ok(()),
        Some(number) => Err((RowProblemKind::NotFinite, format!("{number} is not finite"))),
    }
}

/// A spatial pose from a position, metres, and the quaternion `[x, y, z, w]`.
pub(crate) fn spatial(position: [f64; 3], orientation: [f64; 4]) -> Result<Pose3<f64>, Fault> {
    finite(position)?;
    finite(orientation)?;
    let [x, y, z, w] = orientation;
    let quaternion = Quaternion::new(w, x, y, z);
    let norm = quaternion.norm();
    let rotation = if orientation == [0.0; 4] {
        UnitQuaternion::identity() // most writers use a missing quaternion for no rotation
    } else if (norm - 1.0).abs() > NORM_TOLERANCE {
        return Err(inconsistent(&format!("quaternion of norm {norm:.3e}")));
    } else if (norm - 1.0).abs() > ROUNDING {
        UnitQuaternion::new_normalize(quaternion)
    } else {
        UnitQuaternion::new_unchecked(quaternion) // unchanged, to the bit
    };
    Ok(Pose3 { translation: Vector3::from(position), rotation })
}
