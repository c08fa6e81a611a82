use super::Descriptor;

/// A descriptor whose distance can be bounded from below for less than it costs: what an exact index needs.
///
/// **Laws**, up to rounding: the invariants of `a` and `b` are as many and
/// $`\lVert \mathrm{inv}(a) - \mathrm{inv}(b) \rVert ≤ \mathrm{bound}(a, b) ≤ \mathrm{distance}(a, b)`$, whatever `enough` is; descriptors that are not
/// comparable have infinite distance.
///
/// ```
/// use wayfix_appearance_cml::{Bounded, Comparison, Descriptor};
/// /// A colour that looks the same from everywhere.
/// struct Grey(f64);
/// impl Descriptor for Grey {
///     fn compare(&self, reference: &Self) -> Comparison {
///         Comparison { distance: (self.0 - reference.0).abs(), rotation: 0.0 }
///     }
/// }
/// impl Bounded for Grey {
///     fn invariants(&self) -> Vec<f64> {
///         vec![self.0]
///     }
///     fn bound(&self, reference: &Self, _enough: f64) -> f64 {
///         self.compare(reference).distance
///     }
///     fn is_comparable(&self, _: &Self) -> bool {
///         true
///     }
/// }
/// assert_eq!(Grey(3.0).bound(&Grey(5.0), 1.0), 2.0);
/// ```
pub trait Bounded: Descriptor {
    /// Numbers that do not depend on the heading.
    fn invariants(&self) -> Vec<f64>;

    /// A lower bound of the distance. Nothing is gained by making it larger than `enough`.
    fn bound(&self, reference: &Self, enough: f64) -> f64;

    /// Whether the distance to another descriptor is finite.
    fn is_comparable(&self, other: &Self) -> bool;
}
