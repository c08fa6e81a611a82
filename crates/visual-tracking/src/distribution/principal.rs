use nalgebra::{Matrix3, Rotation3, SymmetricEigen, Vector3};

use crate::TrackingError;

/// Variance below which axes are not distinguished: a step of an 8-bit channel, uniformly spread, $`(1/255)^2 / 12`$.
const TIE: f64 = 1.0 / (255.0 * 255.0 * 12.0);

/// Centroid and principal components of a set of colours: $`\mathbf m`$, $`\boldsymbol λ`$ and the axes that go with them.
/// [Andrade-Cetto 2005, Sec. 3.3, "Parameterization and pdf of color distribution"]
///
/// Magnitudes are standard deviations along the axes, in units of the colour space. The axes are a right-handed frame.
///
/// ```
/// use nalgebra::Vector3;
/// use wayfix_visual_tracking::PrincipalColors;
/// let line = [0.2, 0.4, 0.6].map(|red| Vector3::new(red, 0.5, 0.5));
/// let colors = PrincipalColors::of(&line, &[1.0; 3], None)?;
/// assert!((colors.mean - Vector3::new(0.4, 0.5, 0.5)).norm() < 1e-12);
/// assert!((colors.axis_sigmas[0] - (0.08_f64 / 3.0).sqrt()).abs() < 1e-12 && colors.axis_sigmas[1] < 1e-9);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PrincipalColors {
    /// The centroid $`\mathbf m`$.
    pub mean: Vector3<f64>,
    /// Standard deviations along the axes, $`\boldsymbol λ`$.
    pub axis_sigmas: Vector3<f64>,
    /// The axes, as columns.
    pub axes: Rotation3<f64>,
}

impl PrincipalColors {
    /// The principal axes of weighted colours.
    ///
    /// With `previous` the axes keep their identity: each continues the axis of the same number, with the same sign. If the colours do not
    /// determine the direction of an axis, because they have no extent there or equal extents in several directions, the previous
    /// direction remains: the eigenvectors are those of $`C + ε\, U \operatorname{diag}(2, 1, 0)\, Uᵀ`$, with the previous axes $`U`$ and a
    /// variance $`ε`$ that 8-bit colours cannot resolve. Without `previous`, $`U`$ is the identity and axes are in falling order.
    ///
    /// # Errors
    /// Returns [`TrackingError::Empty`] without weight, [`TrackingError::Dimension`] if lists differ in length, [`TrackingError::NotFinite`], or
    /// [`TrackingError::Parameter`] for a negative weight.
    pub fn of(
        colors: &[Vector3<f64>],
        weights: &[f64],
        previous: Option<&Self>,
    ) -> Result<Self, TrackingError> {
        let total = check(colors, weights)?;
        let weighted = || colors.iter().zip(weights);
        let mean = weighted().map(|(color, weight)| color * *weight).sum::<Vector3<f64>>() / total;
        let mut covariance = Matrix3::zeros();
        for (color, weight) in weighted() {
            let offset = color - mean;
            covariance += offset * offset.transpose() * *weight;
        }
        covariance /= total;
        let before = previous.map_or_else(Matrix3::identity, |previous| previous.axes.into_inner());
        let tie = before * Matrix3::from_diagonal(&Vector3::new(2.0 * TIE, TIE, 0.0)) * before.transpose();
        let eigen = SymmetricEigen::new(covariance + tie);
        let axes = match previous {
            Some(_) => matched(&eigen.eigenvectors, &before),
            None => in_falling_order(&eigen),
        };
        let axis_sigmas = Vector3::from_fn(|i, _| {
            let axis = axes.column(i);
            axis.dot(&(covariance * axis)).max(0.0).sqrt()
        });
        Ok(Self { mean, axis_sigmas, axes: Rotation3::from_matrix_unchecked(axes) })
    }

    /// The angles $`θ, φ`$ that turn the leading axes of `previous` into these: $`θ`$ turns the first axis towards the second, $`φ`$ lifts
    /// it towards the third; radians. A turn about the first axis itself is not part of the two.
    pub fn angles_since(&self, previous: &Self) -> [f64; 2] {
        let leading = previous.axes.inverse() * self.axes.matrix().column(0);
        [leading[1].atan2(leading[0]), leading[2].clamp(-1.0, 1.0).asin()]
    }
}

/// The sum of the weights.
fn check(colors: &[Vector3<f64>], weights: &[f64]) -> Result<f64, TrackingError> {
    crate::error::check_size("weights of colours", colors.len(), weights.len())?;
    for (index, (color, &weight)) in colors.iter().zip(weights).enumerate() {
        for &value in color.iter().chain([&weight]) {
            if !value.is_finite() {
                return Err(TrackingError::NotFinite { what: "colour", index, value });
            }
        }
        crate::error::checked("weight of a colour", weight, weight >= 0.0, "not negative")?;
    }
    let total: f64 = weights.iter().sum();
    let finite = total.is_finite() && colors.iter().all(|color| color.amax() < 1e100);
    crate::error::checked("sum of the weights of colours", total, finite, "finite")?;
    if total > 0.0 { Ok(total) } else { Err(TrackingError::Empty { what: "colours" }) }
}

/// The order and signs of `vectors` that turn least against `before`: of all 24 right-handed ones that of the largest trace.
fn matched(vectors: &Matrix3<f64>, before: &Matrix3<f64>) -> Matrix3<f64> {
    const ORDERS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
    let cosines = before.transpose() * vectors;
    let score = |order: &[usize; 3]| (0..3).map(|i| cosines[(i, order[i])].abs()).sum::<f64>();
    let order = ORDERS
        .into_iter()
        .fold(ORDERS[0], |best, order| if score(&order) > score(&best) { order } else { best });
    let mut axes =
        Matrix3::from_fn(|row, i| vectors[(row, order[i])] * 1_f64.copysign(cosines[(i, order[i])]));
    if axes.determinant() < 0.0 {
        // The axis with the least certain sign.
        let least = (0..3).fold(0, |least, i| {
            if cosines[(i, order[i])].abs() < cosines[(least, order[least])].abs() { i } else { least }
        });
        axes.column_mut(least).neg_mut();
    }
    axes
}

/// Axes in falling order of their eigenvalues, the largest coordinate of the first two positive, right-handed.
fn in_falling_order(eigen: &SymmetricEigen<f64, nalgebra::Const<3>>) -> Matrix3<f64> {
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
    let upright = |i: usize| {
        let axis = eigen.eigenvectors.column(order[i]).into_owned();
        axis * 1_f64.copysign(axis[axis.iamax()])
    };
    let (first, second) = (upright(0), upright(1));
    Matrix3::from_columns(&[first, second, first.cross(&second)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn ellipsoid(axes: &Rotation3<f64>, axis_sigmas: [f64; 3]) -> Vec<Vector3<f64>> {
        let mean = Vector3::new(0.5, 0.4, 0.3);
        let ends = [0, 1, 2].map(|i| axes.matrix().column(i) * axis_sigmas[i]);
        ends.into_iter().flat_map(|end| [mean + end, mean - end]).collect()
    }

    #[test]
    fn principal_axes_keep_order_and_sign_through_a_whole_turn() {
        let turn = |angle: f64| Rotation3::from_axis_angle(&Vector3::z_axis(), angle);
        let mut previous =
            PrincipalColors::of(&ellipsoid(&turn(0.0), [0.2, 0.1, 0.05]), &[1.0; 6], None).unwrap();
        for step in 1..=63 {
            // During the rotation the second axis becomes longer than the first.
            let colors = ellipsoid(&turn(f64::from(step) * 0.1), [0.2, 0.1 + 0.003 * f64::from(step), 0.05]);
            let next = PrincipalColors::of(&colors, &[1.0; 6], Some(&previous)).unwrap();
            assert!(next.axes.angle_to(&previous.axes) < 0.3, "step {step}");
            previous = next;
        }
        assert!(previous.axis_sigmas[1] > previous.axis_sigmas[0]);
    }

    #[test]
    fn sets_without_extent_keep_the_axes_of_before() {
        let axes = Rotation3::from_euler_angles(0.3, -0.4, 0.5);
        let previous = PrincipalColors::of(&ellipsoid(&axes, [0.2, 0.1, 0.05]), &[1.0; 6], None).unwrap();
        let one_color = PrincipalColors::of(&[Vector3::repeat(0.5)], &[3.0], Some(&previous)).unwrap();
        assert!(one_color.axes.angle_to(&previous.axes) < 1e-6);
        assert_eq!(one_color.axis_sigmas, Vector3::zeros());
        let line = [Vector3::new(0.1, 0.5, 0.5), Vector3::new(0.9, 0.5, 0.5)];
        let planar = PrincipalColors::of(&line, &[1.0; 2], Some(&previous)).unwrap();
        assert_abs_diff_eq!(planar.axes.matrix().determinant(), 1.0, epsilon = 1e-9);
    }

    #[test]
    fn angles_recover_the_turn_of_the_leading_axis() {
        let previous =
            PrincipalColors::of(&ellipsoid(&Rotation3::identity(), [0.2, 0.1, 0.05]), &[1.0; 6], None)
                .unwrap();
        let turn = Rotation3::from_euler_angles(0.0, -0.1, 0.2);
        let next =
            PrincipalColors::of(&ellipsoid(&turn, [0.2, 0.1, 0.05]), &[1.0; 6], Some(&previous)).unwrap();
        let [theta, phi] = next.angles_since(&previous);
        // The prior of the previous axes biases the angle by ε over the gap of the variances, 1.3e-6 / 0.03 here, twice.
        assert_abs_diff_eq!(theta, 0.2, epsilon = 1e-4);
        assert_abs_diff_eq!(phi, 0.1, epsilon = 1e-4);
    }

    #[test]
    fn impossible_sets_are_refused() {
        let grey = Vector3::repeat(0.5);
        assert!(matches!(PrincipalColors::of(&[], &[], None), Err(TrackingError::Empty { .. })));
        assert!(matches!(PrincipalColors::of(&[grey], &[0.0], None), Err(TrackingError::Empty { .. })));
        assert!(PrincipalColors::of(&[grey], &[-1.0], None).is_err());
        assert!(PrincipalColors::of(&[grey * f64::NAN], &[1.0], None).is_err());
        assert!(PrincipalColors::of(&[grey], &[1.0, 2.0], None).is_err());
    }
}
