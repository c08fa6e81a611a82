use super::LinearRgb;

/// Linear sRGB of a black body of the given temperature (kelvin, clamped to 1667 … 25 000), with luminance 1.
///
/// Chromaticity by the cubic splines of [Kim et al. 2002], then the matrix of IEC 61966-2-1. Warm light has almost no blue primary; negative values become 0.
/// ```
/// use wayfix_scene_sim::league::black_body;
/// let (warm, day) = (black_body(2700.0), black_body(6500.0));
/// assert!(warm.x > 2.0 * warm.z && (day.x / day.z - 1.0).abs() < 0.05);
/// ```
pub fn black_body(kelvin: f64) -> LinearRgb {
    let t = 1000.0 / kelvin.clamp(1667.0, 25_000.0);
    let x = if t > 0.25 {
        ((-0.266_123_9 * t - 0.234_358_9) * t + 0.877_695_6) * t + 0.179_910
    } else {
        ((-3.025_846_9 * t + 2.107_037_9) * t + 0.222_634_7) * t + 0.240_390
    };
    let y = if t > 1000.0 / 2222.0 {
        ((-1.106_381_4 * x - 1.348_110_2) * x + 2.185_558_32) * x - 0.202_196_83
    } else if t > 0.25 {
        ((-0.954_947_6 * x - 1.374_185_93) * x + 2.091_370_15) * x - 0.167_488_67
    } else {
        ((3.081_758 * x - 5.873_386_7) * x + 3.751_129_97) * x - 0.370_014_83
    };
    from_xyz(x / y, (1.0 - x - y) / y)
}

/// Linear sRGB of luminance 1.
fn from_xyz(x: f64, z: f64) -> LinearRgb {
    LinearRgb::new(
        3.240_6 * x - 1.537_2 - 0.498_6 * z,
        -0.968_9 * x + 1.875_8 + 0.041_5 * z,
        0.055_7 * x - 0.204_0 + 1.057_0 * z,
    )
    .sup(&LinearRgb::repeat(0.01))
}
