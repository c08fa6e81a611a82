use wayfix_slam_ekf::OdometryMotion;

/// The numbers of `increment_noise` by their names in a parameter file.
pub(crate) fn increment_numbers(increment_noise: &OdometryMotion) -> [(&'static str, f64); 5] {
    [
        ("increment_noise.translation_variance_per_meter", increment_noise.translation_variance_per_meter),
        ("increment_noise.heading_variance_per_meter", increment_noise.heading_variance_per_meter),
        ("increment_noise.heading_variance_per_radian", increment_noise.heading_variance_per_radian),
        ("increment_noise.translation_variance_per_step", increment_noise.translation_variance_per_step),
        ("increment_noise.heading_variance_per_step", increment_noise.heading_variance_per_step),
    ]
}

/// Path of a parameter in a parameter file, its value and its range: `number!(sensor.range_sigma, RANGE)`. With `in "sensor"` the path begins there.
macro_rules! number {
    (in $table:literal, $($path:ident).+, $range:expr) => {
        (concat!($table, $(".", stringify!($path)),+), $($path).+, $range)
    };
    ($table:ident . $($path:ident).+, $range:expr) => {
        (concat!(stringify!($table), $(".", stringify!($path)),+), $table.$($path).+, $range)
    };
}
pub(crate) use number;
