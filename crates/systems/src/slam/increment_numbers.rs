use wayfix_slam_ekf::IncrementMotion;

/// The numbers of `increment` by their names in a parameter file.
pub(crate) fn increment_numbers(increment: &IncrementMotion) -> [(&'static str, f64); 5] {
    [
        ("increment.translation_variance_per_meter", increment.translation_variance_per_meter),
        ("increment.heading_variance_per_meter", increment.heading_variance_per_meter),
        ("increment.heading_variance_per_radian", increment.heading_variance_per_radian),
        ("increment.translation_variance_per_step", increment.translation_variance_per_step),
        ("increment.heading_variance_per_step", increment.heading_variance_per_step),
    ]
}
