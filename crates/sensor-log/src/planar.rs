//! Planar headings in formats that know only quaternions.
//!
//! Sines and arctangents are those of the `libm` crate, not the platform's: written files are the same bytes on every machine
//! (docs/adr/0003), and what one machine writes another reads back to the bit.

use wayfix_estimation_traits::wrap_angle;

/// Tolerance of the norm of an input quaternion; a few printed digits cause 1e-3.
pub(crate) const NORM_TOLERANCE: f64 = 0.05;

/// A roll that no robot has and no viewer shows.
const MAX_RESIDUAL: f64 = 1e-14;

/// Heading of the body's x axis for the quaternion `[x, y, z, w]` body → world; its norm does not matter.
///
/// For a planar quaternion, an `x` below 1e-14 is the residual of [`quaternion_of`] and is added.
pub(crate) fn heading_of([x, y, z, w]: [f64; 4]) -> f64 {
    if y == 0.0 && x.abs() < MAX_RESIDUAL {
        wrap_angle(2.0 * libm::atan2(z, w) + x)
    } else {
        libm::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z)
    }
}

/// A quaternion `[x, y, z, w]` from which [`heading_of`] restores the heading to the bit (except the sign of a zero).
///
/// The arctangent does not reach every number, so some headings would be off by one unit in the last place. The remainder, about 1e-16, is stored
/// in `x`: as a rotation it is far below the resolution of viewers. The difference of two neighbours is exact, and so is the sum.
pub(crate) fn quaternion_of(heading: f64) -> [f64; 4] {
    let (z, w) = libm::sincos(heading / 2.0);
    [heading - 2.0 * libm::atan2(z, w), 0.0, z, w]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300_000))]
        #[test]
        fn headings_survive_to_the_bit(heading in prop_oneof![-PI..=PI, -1e-3..1e-3, Just(PI), Just(0.0), Just(5e-324), any::<f64>().prop_filter("an angle", |x| x.abs() < 4.0), (PI - 1e-7)..PI]) {
            // Protobuf drops the sign of a zero anyway.
            let heading = wrap_angle(heading) + 0.0;
            let [x, y, z, w] = quaternion_of(heading);
            prop_assert_eq!(heading_of([x, y, z, w]).to_bits(), heading.to_bits());
            assert_abs_diff_eq!(z * z + w * w, 1.0, epsilon = 1e-15);
        }

        #[test]
        fn a_tilted_body_keeps_the_heading_of_its_x_axis(heading in -3.1..3.1_f64, roll in -1.5..1.5_f64) {
            // q = q_z(heading) q_x(roll): rolling about the x axis does not turn it.
            let ((sz, cz), (sx, cx)) = ((0.5 * heading).sin_cos(), (0.5 * roll).sin_cos());
            let back = heading_of([cz * sx, sz * sx, sz * cx, cz * cx]);
            assert_abs_diff_eq!(back, heading, epsilon = 1e-12);
        }
    }
}
