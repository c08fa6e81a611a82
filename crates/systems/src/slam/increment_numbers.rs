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
