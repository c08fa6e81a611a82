/// How far a view is from a reference, and by how much the robot has turned between them.
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
pub trait ViewDescriptor {
    /// Compares a view with a reference.
    fn compare(&self, reference: &Self) -> ViewDifference;
}
