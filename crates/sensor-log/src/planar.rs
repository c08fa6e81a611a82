//! Planar headings in formats that know only quaternions.

use wayfix_estimation_traits::wrap_angle;

/// Heading of the body's x axis for the quaternion `[x, y, z, w]` body → world; its norm does not matter.
pub(crate) fn heading_of([x, y, z, w]: [f64; 4]) -> f64 {
    if x == 0.0 && y == 0.0 {
        wrap_angle(2.0 * z.atan2(w))
    } else {
        (2.0 * (w * z + x * y)).atan2(w * w + x * x - y * y - z * z)
    }
}

/// The quaternion `[x, y, z, w]` of a heading, chosen among the nearest ones so that [`heading_of`] gives the heading back to the bit.
///
/// A step of the smaller component moves the angle by at most one unit in its last place; where the rounding of the arctangent skips the
/// heading all the same, a step of the larger component shifts the pattern by a fraction of a unit.
/// (Subnormal headings cannot be halved exactly and come back rounded.)
pub(crate) fn quaternion_of(heading: f64) -> [f64; 4] {
    const MAX_SHIFTS: usize = 32;
    let half = heading / 2.0;
    let (mut z, mut w) = half.sin_cos();
    let nearest = [0.0, 0.0, z, w];
    for _ in 0..MAX_SHIFTS {
        if let Some((z, w)) = step_to_angle(half, z, w) {
            return [0.0, 0.0, z, w];
        }
        if z.abs() < w {
            w = w.next_down();
        } else {
            z = if z > 0.0 { z.next_down() } else { z.next_up() };
        }
    }
    nearest
}

/// Steps the smaller component until `atan2(z, w)` is `angle`; `None` when it steps across.
fn step_to_angle(angle: f64, mut z: f64, mut w: f64) -> Option<(f64, f64)> {
    const MAX_STEPS: usize = 8;
    for _ in 0..MAX_STEPS {
        let error = angle - z.atan2(w);
        if error == 0.0 {
            return Some((z, w));
        }
        if z.abs() < w {
            z = if error > 0.0 { z.next_up() } else { z.next_down() };
        } else {
            // The angle shrinks towards 0 as w grows.
            w = if (error > 0.0) == (z > 0.0) { w.next_down() } else { w.next_up() };
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::PI;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300_000))]
        #[test]
        fn headings_survive_to_the_bit(heading in prop_oneof![-PI..=PI, -1e-3..1e-3, Just(PI), Just(0.0), 3.1415926..PI]) {
            let heading = wrap_angle(heading);
            let [x, y, z, w] = quaternion_of(heading);
            prop_assert_eq!(heading_of([x, y, z, w]).to_bits(), heading.to_bits());
            prop_assert!((z * z + w * w - 1.0).abs() < 1e-14);
        }

        #[test]
        fn a_tilted_body_keeps_the_heading_of_its_x_axis(heading in -3.1..3.1_f64, roll in -1.5..1.5_f64) {
            // q = q_z(heading) q_x(roll): rolling about the x axis does not turn it.
            let ((sz, cz), (sx, cx)) = ((0.5 * heading).sin_cos(), (0.5 * roll).sin_cos());
            let back = heading_of([cz * sx, sz * sx, sz * cx, cz * cx]);
            prop_assert!((back - heading).abs() < 1e-12);
        }
    }
}
