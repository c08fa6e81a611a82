use nalgebra::RealField;

/// A generic scalar as the double nearest to it, for reports, weights and errors.
///
/// ```
/// assert_eq!(wayfix_estimation_traits::to_f64(0.5_f32), 0.5);
/// assert!(wayfix_estimation_traits::to_f64(f32::NAN).is_nan());
/// ```
pub fn to_f64<T: RealField>(value: T) -> f64 {
    // Called unchecked for fields beyond the reals; `f32` and `f64` have nothing to check.
    nalgebra::convert_unchecked(value)
}

/// The scalar's rounding unit: the distance from 1 to the next number.
///
/// ```
/// assert_eq!(wayfix_estimation_traits::epsilon::<f32>(), f32::EPSILON);
/// ```
pub fn epsilon<T: RealField>() -> T {
    T::default_epsilon()
}
