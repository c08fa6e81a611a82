//! Renamed parameters: an old parameter file gets a hint with the new name.

/// Old name, new name. An old name may have several new ones.
const RENAMED: [(&str, &str); 152] = [
    ("accept", "gate_nis"),
    ("acquisition", "search"),
    ("active", "forgetting_rate"),
    ("active_forgetting", "forgetting_rate"),
    ("adapt_above", "adapt_above_intersection"),
    ("adaptation", "color_adaptation_rate"),
    ("adapts", "adapts_colors"),
    ("alike_share", "color_agreement_share"),
    ("anchored_share", "share_from_last_measurement"),
    ("area_gain", "area_extrapolation"),
    ("area_memory", "mean_area_weight"),
    ("background", "background_model"),
    ("bearing", "bearing_sigma"),
    ("bearing_per_extent", "bearing_sigma_per_extent"),
    ("bimodal", "bimodal_colors"),
    ("bins", "color_bins"),
    ("certainly_new", "new_landmark_nis"),
    ("choice", "action_selection"),
    ("clutter", "mean_clutter"),
    ("color_memory", "previous_colors_weight"),
    ("color_rate", "color_histogram_rate"),
    ("color_share", "color_channel_share"),
    ("color_weight", "color_histogram_weight"),
    ("combination", "fusion_rule"),
    ("command_erosion", "turn_command_time_loss"),
    ("confidence", "goal_confidence"),
    ("confirmations", "n_confirmations"),
    ("contradiction", "restart_nis"),
    ("correlation_angle_rad", "point_error_correlation_angle_rad"),
    ("corroboration", "skip_outlier_views_in_mapping"),
    ("damping", "velocity_retention"),
    ("detection", "detection_probability"),
    ("disagreement", "odometry_noise_per_scan"),
    ("disturbance", "disturbance_sigmas"),
    ("dominance", "dominant_gray_criterion"),
    ("doubt_below", "no_evidence_below"),
    ("drift", "disturbance_drift"),
    ("drift", "lighting_drift"),
    ("edge_margin", "edge_margin_pixels"),
    ("euler_range", "euler_number_range"),
    ("false_alarm_rate", "false_alarms_per_view"),
    ("first_kernel_m", "initial_kernel_m"),
    ("floor", "min_variance_share"),
    ("floor", "outlier_share"),
    ("forget_after", "accept_change_after"),
    ("forgetting", "forgetting_mode"),
    ("forward", "forward_sigma_per_meter"),
    ("found_from", "found_above"),
    ("greatest_count", "max_observation_count"),
    ("greatest_sigma", "max_sigma"),
    ("grey_share", "gray_channel_share"),
    ("heading", "heading_sigma"),
    ("heading_per_meter", "heading_sigma_per_meter"),
    ("heading_per_metre", "heading_sigma_per_meter"),
    ("heading_per_radian", "heading_sigma_per_radian"),
    ("hidden_views", "occlusion"),
    ("increment", "increment_noise"),
    ("independent_rad", "point_error_correlation_angle_rad"),
    ("inertia", "previous_filter_weight"),
    ("kept_distance", "alternative_kept_distance"),
    ("largest_gap", "max_wall_gap"),
    ("laser", "laser_pose"),
    ("leak", "kidnapping_probability"),
    ("learn_above", "learn_above_psr"),
    ("least_effective", "tempering_min_ess_share"),
    ("least_share_seen", "min_detection_rate"),
    ("least_turn", "min_rotation"),
    ("least_way", "min_distance"),
    ("least_weight", "min_weight"),
    ("light", "light_error_correlation"),
    ("light_stays", "light_persistence"),
    ("lights", "light_changes"),
    ("linearization", "linearization_point"),
    ("lines", "line_extraction"),
    ("log_area", "log_area_sigma"),
    ("look_errors", "correlated_noise"),
    ("looks", "keyframes"),
    ("made_odometry", "synthetic_odometry"),
    ("map", "covariance_update"),
    ("match_share", "match_limit_fraction"),
    ("max_count", "max_observation_count"),
    ("max_particles_lost", "max_particles"),
    ("max_steps", "max_iterations"),
    ("mean_noise", "mean_color_variance"),
    ("min_effective_share", "tempering_min_ess_share"),
    ("min_particles", "max_particles"),
    ("most", "max_components"),
    ("most_references", "max_references"),
    ("motion_width", "motion_sigma"),
    ("moved_per_km", "kidnappings_per_km"),
    ("mu", "quality_weights"),
    ("n_places", "n_refined_places"),
    ("n_scales", "n_scale_hypotheses"),
    ("n_searches", "n_search_places"),
    ("n_sightings", "n_detections"),
    ("n_trials", "max_pairings"),
    ("never_twice", "one_detection_per_landmark"),
    ("noise", "beam_noise"),
    ("noise", "color_state_noise"),
    ("noise", "noise_covariance"),
    ("normalization", "brightness_normalization"),
    ("online", "online_appearance"),
    ("order", "update_order"),
    ("outliers", "outlier_rule"),
    ("own_bearing_sigma", "independent_bearing_sigma"),
    ("own_range_sigma", "independent_range_sigma"),
    ("own_range_sigma_per_meter", "independent_range_sigma_per_meter"),
    ("patience", "lost_after"),
    ("patience", "max_missed"),
    ("penalty", "domain_agreement_weight"),
    ("pixel_noise", "pixel_color_variance"),
    ("pooling", "pooled_share"),
    ("position", "position_sigma"),
    ("probability", "gate_probability"),
    ("reach", "search_distance"),
    ("reach", "search_radius"),
    ("reach", "sensor_range"),
    ("reach_m", "max_range_m"),
    ("recognize_above", "recognize_above_psr"),
    ("recognize_share", "recognition_response_share"),
    ("reject_outliers", "skip_outlier_views_in_mapping"),
    ("relocation", "relocalization"),
    ("scale_rate", "scale_filter_rate"),
    ("sense", "azimuth_direction"),
    ("separation", "min_separation"),
    ("sideways", "sideways_sigma_per_meter"),
    ("sigma", "quality_sigma"),
    ("sigma_m", "point_sigma_m"),
    ("smoothing", "smoothing_sigma"),
    ("split", "split_method"),
    ("start", "start_pose"),
    ("start", "start_uncertainty"),
    ("start_spacing_rad", "initial_heading_spacing_rad"),
    ("stays", "stay_probability"),
    ("strays", "other_action_probability"),
    ("tail", "likelihood_tail"),
    ("taught", "taught_pose_uncertainty"),
    ("taught_pose", "taught_pose_uncertainty"),
    ("tolerance", "same_place_tolerance"),
    ("tone", "intensity_scale"),
    ("turn_command_shortening", "turn_command_time_loss"),
    ("uneven_brightness", "brightness_variation"),
    ("uneven_chroma", "brightness_variation"),
    ("unimodal", "unimodal_weight"),
    ("unseen", "unseen_colors"),
    ("velocity", "velocity_noise"),
    ("views", "panorama_descriptor"),
    ("visit", "imaging_conditions"),
    ("weighting", "mixture_weighting"),
    ("whole_scene", "whole_scene_appearance"),
    ("with_things", "with_unmapped_objects"),
    ("yuv", "yuv_standard"),
];

/// The new name of `old`, among the allowed names.
pub(super) fn present_name<'a>(old: &str, allowed: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let new: Vec<&str> = RENAMED.iter().filter(|(name, _)| *name == old).map(|(_, new)| *new).collect();
    allowed.into_iter().find(|name| new.contains(name))
}

/// Old name, a name beside which it stood, and what replaces it.
const REPLACED: [(&str, &str, &str); 14] = [
    ("doubtful_fit", "relocalization", "`relocalization` decides when the robot has been moved"),
    ("fast_rate", "relocalization", "`relocalization` decides when the robot has been moved"),
    ("lost_fit", "relocalization", "a pose is lost if the last frames do not tell it from the background"),
    ("resample_below", "relocalization", "every frame resamples"),
    ("slow_rate", "relocalization", "`relocalization` decides when the robot has been moved"),
    ("delay", "unimodal_weight", "a view waits until the robot is a match radius away"),
    (
        "insertion",
        "match_limit_fraction",
        "a view becomes a reference beyond the distance of successive views",
    ),
    ("longest_wait", "unimodal_weight", "`relocalization.alternative_kept_distance` bounds the wait"),
    ("match_limit", "match_limit_fraction", "`match_limit_fraction` sets it"),
    ("memory", "unimodal_weight", "references are not moved any more"),
    ("merge_distance", "match_limit_fraction", "`fusion.gate` holds for places too"),
    ("most_matches", "unimodal_weight", "`simplify.max_components` holds for matches too"),
    ("patience", "unimodal_weight", "`relocalization.alternative_kept_distance` bounds the wait"),
    ("place_gate", "match_limit_fraction", "`fusion.gate` holds for places too"),
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
        assert_eq!(of("place_gate", "match_limit_fraction"), Some("`fusion.gate` holds for places too"));
        assert_eq!(of("delay", "range_sigma"), None);
    }
}
