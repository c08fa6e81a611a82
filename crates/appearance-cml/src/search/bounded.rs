use super::{LowerBoundTable, ViewDescriptor, ViewDifference};

/// A descriptor whose distance can be bounded from below for less than it costs: what an exact index needs.
///
/// **Laws**, for a view `v` and a reference `r`, up to rounding: `r.bound(&v.probe(), enough)` ≤ `v.compare(&r).distance`;
/// `r.compare_with(&v.probe())` is `v.compare(&r)` to the bit; descriptors that are not comparable have infinite distance.
///
/// ```
/// use wayfix_appearance_cml::{LowerBoundedDistance, ViewDifference, ViewDescriptor, WithoutLowerBounds};
/// /// A colour that is the same from everywhere.
/// #[derive(Clone)]
/// struct Grey(f64);
/// impl ViewDescriptor for Grey {
///     fn compare(&self, reference: &Self) -> ViewDifference {
///         ViewDifference { distance: (self.0 - reference.0).abs(), rotation: 0.0 }
///     }
/// }
/// impl LowerBoundedDistance for Grey {
///     type Probe = Grey;
///     type Table = WithoutLowerBounds;
///     fn probe(&self) -> Grey {
///         self.clone()
///     }
///     fn bound(&self, view: &Grey, _enough: f64) -> f64 {
///         self.compare(view).distance
///     }
///     fn compare_with(&self, view: &Grey) -> ViewDifference {
///         view.compare(self)
///     }
///     fn is_comparable(&self, _: &Self) -> bool {
///         true
///     }
/// }
/// assert_eq!(Grey(3.0).bound(&Grey(5.0), 1.0), 2.0);
/// ```
pub trait LowerBoundedDistance: ViewDescriptor + Sized {
    /// A view made ready to be compared with many references.
    type Probe;
    /// The first numbers of many references, side by side.
    type Table: LowerBoundTable<Self>;

    /// This view, made ready.
    fn probe(&self) -> Self::Probe;

    /// A lower bound of the distance of a view to this reference. It may stop anywhere above `enough`: nothing is gained by more.
    fn bound(&self, view: &Self::Probe, enough: f64) -> f64;

    /// Compares a view with this reference.
    fn compare_with(&self, view: &Self::Probe) -> ViewDifference;

    /// Whether the distance to another descriptor is finite.
    fn is_comparable(&self, other: &Self) -> bool;
}
