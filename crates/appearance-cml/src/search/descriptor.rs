/// How far a view is from a reference, and by how much the robot has turned between them.
///
/// ```
/// use wayfix_appearance_cml::{PanoramaDescriptor, ViewDescriptor};
/// let view = |re: i8, im: i8| PanoramaDescriptor::from_parts(0.01, 1, vec![3, re, im]);
/// let (before, after) = (view(20, 0)?, view(0, -20)?);
/// let turn = after.compare(&before); // to the left by a quarter
/// assert!(turn.distance < 1e-6 && (turn.rotation - std::f64::consts::FRAC_PI_2).abs() < 1e-9);
/// let of_two_rings = PanoramaDescriptor::from_parts(0.01, 2, vec![3; 6])?;
/// assert_eq!(after.compare(&of_two_rings).distance, f64::INFINITY); // not comparable
/// # Ok::<(), wayfix_appearance_cml::AppearanceMapError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewDifference {
    /// Distance at the best rotation, 0 for the same view; never negative, never NaN.
    pub distance: f64,
    /// Heading of the view less heading of the reference, rad in $`(-π, π]`$.
    pub rotation: f64,
}

/// The appearance of a view, in numbers that can be compared.
///
/// **Laws**: `a.compare(&a).distance` is 0; the distance is symmetric and does not change when either view is taken with another heading;
/// `a.compare(&b).rotation` is the opposite of `b.compare(&a).rotation`.
///
/// ```
/// use wayfix_appearance_cml::{ViewDescriptor, ViewDifference};
/// use wayfix_estimation_traits::wrap_angle;
/// /// A lamp: its brightness, and its direction in the body frame, rad.
/// struct Lamp(f64, f64);
/// impl ViewDescriptor for Lamp {
///     fn compare(&self, reference: &Self) -> ViewDifference {
///         ViewDifference { distance: (self.0 - reference.0).abs(), rotation: wrap_angle(reference.1 - self.1) }
///     }
/// }
/// // After a turn to the left by 1 rad the lamp is 1 rad further to the right.
/// assert_eq!(Lamp(0.7, -0.5).compare(&Lamp(0.7, 0.5)), ViewDifference { distance: 0.0, rotation: 1.0 });
/// ```
pub trait ViewDescriptor {
    /// Compares a view with a reference.
    fn compare(&self, reference: &Self) -> ViewDifference;
}
