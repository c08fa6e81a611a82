//! Renamed parameters: an old parameter file gets a hint with the new name.

/// Old name, new name. An old name may have several new ones.
const RENAMED: [(&str, &str); 48] = [
    ("active", "forgetting_rate"),
    ("active_forgetting", "forgetting_rate"),
    ("alike_share", "color_agreement_share"),
    ("bearing", "bearing_sigma"),
    ("bearing_per_extent", "bearing_sigma_per_extent"),
    ("clutter", "mean_clutter"),
    ("command_erosion", "turn_command_shortening"),
    ("contradiction", "restart_nis"),
    ("corroboration", "reject_outliers"),
    ("detection", "detection_probability"),
    ("disagreement", "odometry_noise_per_scan"),
    ("doubt_below", "no_evidence_below"),
    ("euler_range", "euler_number_range"),
    ("first_kernel_m", "initial_kernel_m"),
    ("found_from", "found_above"),
    ("greatest_count", "max_count"),
    ("greatest_sigma", "max_sigma"),
    ("heading_per_metre", "heading_per_meter"),
    ("independent_rad", "correlation_angle_rad"),
    ("least_share_seen", "min_detection_rate"),
    ("least_turn", "min_rotation"),
    ("least_way", "min_distance"),
    ("least_weight", "min_weight"),
    ("light_stays", "light_persistence"),
    ("log_area", "log_area_sigma"),
    ("look_errors", "correlated_noise"),
    ("looks", "keyframes"),
    ("made_odometry", "synthetic_odometry"),
    ("most", "max_components"),
    ("most_references", "max_references"),
    ("n_sightings", "n_detections"),
    ("never_twice", "one_detection_per_landmark"),
    ("own_bearing_sigma", "independent_bearing_sigma"),
    ("own_range_sigma", "independent_range_sigma"),
    ("own_range_sigma_per_meter", "independent_range_sigma_per_meter"),
    ("patience", "lost_after"),
    ("patience", "max_missed"),
    ("reach", "search_distance"),
    ("reach", "search_radius"),
    ("reach", "sensor_range"),
    ("reach_m", "max_range_m"),
    ("relocation", "relocalization"),
    ("stays", "stay_probability"),
    ("strays", "other_action_probability"),
    ("taught", "taught_pose"),
    ("unimodal", "unimodal_weight"),
    ("visit", "imaging_conditions"),
    ("with_things", "with_unmapped_objects"),
];

/// The new name of `old`, among the allowed names.
pub(super) fn present_name<'a>(old: &str, allowed: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let new: Vec<&str> = RENAMED.iter().filter(|(name, _)| *name == old).map(|(_, new)| *new).collect();
    allowed.into_iter().find(|name| new.contains(name))
}

/// Old name, a name beside which it stood, and what replaces it.
const REPLACED: [(&str, &str, &str); 9] = [
    ("delay", "unimodal_weight", "a view waits until the robot is a match radius away"),
    ("insertion", "match_share", "a view becomes a reference beyond the distance of successive views"),
    ("longest_wait", "unimodal_weight", "`relocalization.kept_distance` bounds the wait"),
    ("match_limit", "match_share", "`match_share` sets it"),
    ("memory", "unimodal_weight", "references are not moved any more"),
    ("merge_distance", "match_share", "`fusion.gate` holds for places too"),
    ("most_matches", "unimodal_weight", "`simplify.max_components` holds for matches too"),
    ("patience", "unimodal_weight", "`relocalization.kept_distance` bounds the wait"),
    ("place_gate", "match_share", "`fusion.gate` holds for places too"),
];

/// What replaces `old`, which stood among the allowed names.
pub(super) fn replacement<'a>(old: &str, mut allowed: impl Iterator<Item = &'a str>) -> Option<&'static str> {
    let (_, beside, what) = REPLACED.iter().find(|(name, ..)| *name == old)?;
    allowed.any(|name| name == *beside).then_some(*what)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn old_name_is_told_the_present_one_that_fits_there() {
        let allowed = ["sensor_range", "range_sigma"];
        assert_eq!(present_name("reach", allowed.into_iter()), Some("sensor_range"));
        assert_eq!(present_name("reach", ["step"].into_iter()), None);
        assert_eq!(present_name("range_sigmas", allowed.into_iter()), None);
    }

    #[test]
    fn replaced_name_is_told_what_replaces_it() {
        let of = |old, beside| replacement(old, std::iter::once(beside));
        assert_eq!(of("place_gate", "match_share"), Some("`fusion.gate` holds for places too"));
        assert_eq!(of("delay", "range_sigma"), None);
    }
}
