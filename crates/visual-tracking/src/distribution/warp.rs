use nalgebra::{Matrix3, Rotation3, Vector3};

/// Smaller axis deviations are those of a flat set, which is not stretched: one step of an 8-bit channel.
const FLAT: f64 = 1.0 / 255.0;

/// Maximum factor by which one step stretches or shrinks an axis.
const MAX_SCALE: f64 = 3.0;

/// An affine map of the colour space. [`ColorDistributionState::warp_from`](super::ColorDistributionState::warp_from) makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AffineColorMap {
    linear: Matrix3<f64>,
    offset: Vector3<f64>,
}

impl AffineColorMap {
    pub(super) fn new(
        from: &Vector3<f64>,
        to: &Vector3<f64>,
        axes: &Rotation3<f64>,
        turn: &Rotation3<f64>,
        scales: &Vector3<f64>,
    ) -> Self {
        let linear =
            axes.matrix() * turn.matrix() * Matrix3::from_diagonal(scales) * axes.matrix().transpose();
        Self { linear, offset: to - linear * from }
    }

    /// Factor that stretches an axis from the deviation `from` to `to`; bounded, and 1 for a flat axis.
    pub(super) fn scale(from: f64, to: f64) -> f64 {
        (to.max(FLAT) / from.max(FLAT)).clamp(1.0 / MAX_SCALE, MAX_SCALE)
    }

    /// Maps a colour.
    pub fn apply(&self, color: &Vector3<f64>) -> Vector3<f64> {
        self.linear * color + self.offset
    }
}
