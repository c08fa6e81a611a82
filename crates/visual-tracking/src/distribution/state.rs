use nalgebra::{Rotation3, SVector, Vector3};

use super::{AffineColorMap, PrincipalColors};

/// Numbers of a colour distribution: centroid, three axis deviations, two angles.
pub const COLOR_DIM: usize = 8;

/// $`[\mathbf m, \boldsymbol λ, θ, φ]`$.
pub type ColorStateVector = SVector<f64, COLOR_DIM>;

/// Colour state of one sample: $`\mathbf x = [\mathbf mᵀ, \boldsymbol λᵀ, θ, φ]ᵀ`$ and its change per picture.
/// [Andrade-Cetto 2005, Sec. 3.3]
///
/// The angles are against the axes of a reference distribution, so a state means something only beside it.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_visual_tracking::{ColorDistributionState, PrincipalColors};
/// let colors = [Vector3::new(0.2, 0.5, 0.5), Vector3::new(0.4, 0.5, 0.5)];
/// let reference = PrincipalColors::of(&colors, &[1.0; 2], None)?;
/// let mut brighter = ColorDistributionState::at_rest(&reference);
/// brighter.value[0] += 0.1; // the centroid
/// brighter.value[3] *= 2.0; // the deviation along the first axis
/// let warped = brighter.warp_from(&reference).apply(&colors[1]);
/// assert!((warped - Vector3::new(0.6, 0.5, 0.5)).norm() < 1e-9);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColorDistributionState {
    /// $`\mathbf x`$.
    pub value: ColorStateVector,
    /// Change of $`\mathbf x`$ from one picture to the next.
    pub velocity: ColorStateVector,
}

impl ColorDistributionState {
    /// The state of the reference itself, which does not move.
    pub fn at_rest(reference: &PrincipalColors) -> Self {
        let mut value = ColorStateVector::zeros();
        value.fixed_rows_mut::<3>(0).copy_from(&reference.mean);
        value.fixed_rows_mut::<3>(3).copy_from(&reference.axis_sigmas);
        Self { value, velocity: ColorStateVector::zeros() }
    }

    /// The centroid.
    pub fn mean(&self) -> Vector3<f64> {
        self.value.fixed_rows::<3>(0).into_owned()
    }

    /// Standard deviations along the axes.
    pub fn axis_sigmas(&self) -> Vector3<f64> {
        self.value.fixed_rows::<3>(3).into_owned()
    }

    /// $`[θ, φ]`$ in radians.
    pub fn angles(&self) -> [f64; 2] {
        [self.value[6], self.value[7]]
    }

    /// The affine map from the reference's colours to those of this state:
    /// $`\mathbf c ↦ \mathbf m' + U R(θ, φ) \operatorname{diag}(λ'_i / λ_i)\, Uᵀ (\mathbf c - \mathbf m)`$.
    pub fn warp_from(&self, reference: &PrincipalColors) -> AffineColorMap {
        let [theta, phi] = self.angles();
        let turn = Rotation3::from_axis_angle(&Vector3::z_axis(), theta)
            * Rotation3::from_axis_angle(&Vector3::y_axis(), -phi);
        let scales = reference.axis_sigmas.zip_map(&self.axis_sigmas(), AffineColorMap::scale);
        AffineColorMap::new(&reference.mean, &self.mean(), &reference.axes, &turn, &scales)
    }

    /// The same distribution seen from a new reference: angles are counted from its axes.
    pub(crate) fn seen_from(mut self, reference_angles: [f64; 2]) -> Self {
        for (i, angle) in reference_angles.into_iter().enumerate() {
            self.value[6 + i] -= angle;
        }
        self
    }
}
