use nalgebra::Dim;

use crate::VariableTuple;

/// A difference between what was measured and what the variables say, with its derivatives.
///
/// **Laws**, at all values of the variables:
///
/// 1. value and Jacobians are finite,
/// 2. Jacobian $`k`$ is $`∂\, r(x_1, …, x_k ⊞ δ, …) / ∂δ`$ at $`δ = 0`$, with one column for each tangent coordinate,
/// 3. the number of rows never changes.
///
/// [`laws::residual`](crate::laws::residual) checks them. Without `jacobians` they are central differences, which cost two values for
/// each tangent coordinate.
///
/// ```
/// use nalgebra::{Const, Vector1, Vector2};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_smoother::{Residual, laws};
/// /// The distance to a beacon, measured from a robot.
/// struct Range(f64);
/// impl Residual for Range {
///     type Dim = Const<1>;
///     type Variables = (Pose2<f64>, Vector2<f64>);
///     fn value(&self, (robot, beacon): (&Pose2<f64>, &Vector2<f64>)) -> Vector1<f64> {
///         Vector1::new((beacon - robot.translation).norm() - self.0)
///     }
/// }
/// laws::residual(&Range(5.0), (&Pose2::new(1.0, 2.0, 3.0), &Vector2::new(4.0, -1.0)))?;
/// # Ok::<(), laws::LawViolation>(())
/// ```
pub trait Residual: Send + 'static {
    /// Number of rows: `Const<N>`, or `Dyn` when it is only known at run time.
    type Dim: Dim;
    /// The types of the variables, as a tuple of one to four.
    type Variables: VariableTuple<Self::Dim>;

    /// $`r(x)`$, in the unit of the measurement.
    fn value(&self, variables: Refs<'_, Self>) -> Value<Self>;

    /// $`∂r/∂x_k`$ for each variable, in its tangent space.
    fn jacobians(&self, variables: Refs<'_, Self>) -> Jacobians<Self>
    where
        Self: Sized,
    {
        Self::Variables::differentiate(self, variables)
    }
}

/// References to the variables of a residual.
pub type Refs<'a, R> = <<R as Residual>::Variables as VariableTuple<<R as Residual>::Dim>>::Refs<'a>;
/// Identifiers of the variables of a residual.
pub type Ids<R> = <<R as Residual>::Variables as VariableTuple<<R as Residual>::Dim>>::Ids;
/// The value of a residual: a vector of `Dim` rows.
pub type Value<R> = <<R as Residual>::Variables as VariableTuple<<R as Residual>::Dim>>::Value;
/// The Jacobians of a residual: a tuple of `Dim` × tangent dimension matrices.
pub type Jacobians<R> = <<R as Residual>::Variables as VariableTuple<<R as Residual>::Dim>>::Jacobians;
/// The information matrix of a residual: the inverse of its covariance.
pub type Information<R> = <<R as Residual>::Variables as VariableTuple<<R as Residual>::Dim>>::Information;
