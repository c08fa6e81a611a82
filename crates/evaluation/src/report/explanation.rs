/// Figures by the end of their names, or by the beginning where it ends in `_`; the first match counts.
const MEANINGS: [(&str, &str); 47] = [
    ("_ci95", "half the width of the 95 % confidence interval of the mean"),
    ("_low95", "lower end of the 95 % confidence interval"),
    ("dead_reckoning_aligned_rmse_m", "as ate_aligned_rmse_m, of the odometry alone"),
    ("dead_reckoning_error_mean_m", "mean position error of the odometry alone, from the same start"),
    (
        "dead_reckoning_position_error_mean_m",
        "mean position error of the odometry alone, from the same start",
    ),
    (
        "landmark_aligned_rmse_m",
        "root mean square error of the landmarks after the best rigid alignment of the map",
    ),
    ("landmark_rmse_m", "root mean square error of the landmarks, start pose given, no alignment"),
    (
        "ate_aligned_rmse_m",
        "absolute trajectory error: root mean square after the best rigid alignment of the path",
    ),
    ("ate_rmse_m", "absolute trajectory error: root mean square, start pose given, no alignment"),
    ("rpe_m_per_m", "relative pose error: mean error of the motion, per m driven"),
    ("rpe_rad_per_rad", "relative pose error: mean heading error of the motion, per radian turned"),
    ("heading_rmse_deg", "root mean square error of the heading"),
    ("heading_mean_deg", "mean error of the heading"),
    (
        "nees_outside_band_share",
        "share of the steps whose NEES is outside the 95 % band of a consistent filter",
    ),
    (
        "nees_mean",
        "normalized estimation error squared: its mean is the number of dimensions (3 of a pose) if the covariance is right; far above it is too small",
    ),
    (
        "extracted_walls_within_2_sigma_share",
        "share of the errors within two standard deviations: 0.865 in two dimensions, if the covariance is right",
    ),
    (
        "walls_within_2_sigma_share",
        "share of the walls of the map within two standard deviations of the true ones: 0.954 if the covariance is right",
    ),
    ("n_landmarks", "landmarks in the map"),
    ("n_rejected", "measurements and records that the filter did not use"),
    ("n_references", "views in the appearance map"),
    ("references", "views in the appearance map"),
    ("n_skipped", "scans that could not be used; the events say why"),
    ("n_scans", "laser scans in the log"),
    ("n_frames_lost", "frames in which the tracker reported the target lost"),
    ("n_frames", "camera frames"),
    ("segments_mean", "mean number of walls in a scan"),
    ("residual_rms_m", "root mean square distance of the laser points from their walls"),
    ("false_wall_share", "share of the extracted walls that match no true wall"),
    ("found_wall_share", "share of the visible true walls that were extracted"),
    ("iou_mean", "overlap of estimate and truth: intersection over union, 1 is perfect"),
    (
        "success_auc",
        "area under the success curve: share of the frames above each overlap threshold, averaged",
    ),
    ("precision_20px", "share of the frames whose centre is within 20 pixels of the truth"),
    ("reacquired_share", "share of the films in which the target was found again after it was hidden"),
    ("lost_detection_recall", "share of the frames without a visible target that were reported lost"),
    ("center_error_mean_px", "distance of the centre of the target from the truth"),
    ("classification_rate", "share of the labelled pixels that got their true colour class"),
    ("rate_", "share that is right"),
    ("ess_mean", "mean effective number of particles"),
    ("n_particles_mean", "mean number of particles"),
    ("position_", "distance from the true position"),
    ("successes", "drives that ended at the right view, of all drives"),
    ("steps_to_certainty_mean", "mean number of steps until the belief was certain"),
    ("steps_mean", "mean number of steps of a drive"),
    ("error_", "distance from the true position"),
    ("n_figures_changed", "figures that differ from the stored reference"),
    ("scans_per_second", "scans that one core processes in a second"),
    ("step_", "computing time of a step"),
];

/// What a figure means, by its name; `None` for a figure that only its run explains.
///
/// ```
/// use wayfix_evaluation::report::explanation;
/// assert!(explanation("ate_rmse_m").unwrap().starts_with("absolute trajectory error"));
/// assert!(explanation("standard_nees_mean").unwrap().starts_with("normalized estimation error squared"));
/// assert_eq!(explanation("fisher_information_rank"), None);
/// ```
pub fn explanation(name: &str) -> Option<&'static str> {
    let is_meant = |words: &str| name.ends_with(words) || words.ends_with('_') && name.starts_with(words);
    MEANINGS.iter().find(|(words, _)| is_meant(words)).map(|(_, meaning)| *meaning)
}
