use clap::ValueEnum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_sensor_log::{LogFormat, LogMetadata};
use wayfix_slam_ekf::{
    AckermannVehicle, AnchorParams, CorrelatedNoise, ExternalParams, JointCompatibilityParams,
    LandmarkConfirmationParams, LandmarkMergingParams, NearestNeighbourParams, OdometryMotion, OutlierRule,
    RangeBearingSensor, SlamParams, VelocityMotion,
};
use wayfix_system_core::{VELOCITY_TIMEOUT, settings::over_defaults};

use crate::slam::{AssociationRule, Smoothing};

/// Everything that can be set for EKF-SLAM on a log.
///
/// ```
/// use wayfix_slam_system::points::{PointSlamParams, RobotProfile};
/// let params = PointSlamParams::from_toml("profile = 'utias'\n[filter]\ngate_probability = 0.99", RobotProfile::Generic)?;
/// assert_eq!(params.filter.gate_probability, 0.99);
/// assert_eq!(params.velocity_noise, PointSlamParams::of(RobotProfile::Utias).velocity_noise); // not named in the file
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PointSlamParams {
    /// The robot whose defaults these are.
    pub profile: RobotProfile,
    /// How detections find their landmarks; when not given, by identity where the log has identities, else joint compatibility.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub association: Option<AssociationRule>,
    /// Start pose, m and rad; when not given, the truth where odometry starts, a fit to the first true positions, or the origin.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub start_pose: Option<[f64; 3]>,
    /// Number of true landmarks of the log, nearest to the start first, that the robot is given as known: anchors that tie the map to the
    /// world. For logs that have true landmarks.
    pub n_anchors: usize,
    /// Landmarks that are known before the run.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub anchors: Vec<AnchorParams<[f64; 2]>>,
    /// Sensors of the pose that do not use the map.
    pub external: ExternalParams,
    /// Timing of the robot, kind and scale of its ranges.
    pub robot: RobotTimingParams,
    /// Where things sit on the robot.
    pub mounting: MountingParams,
    /// Measures of a car-like vehicle.
    pub vehicle: AckermannVehicle,
    /// Noise of the range-bearing sensor.
    pub sensor: RangeBearingSensor,
    /// Noise of velocity odometry.
    pub velocity_noise: VelocityMotion,
    /// Noise of odometry increments.
    pub increment_noise: OdometryMotion,
    /// Gate and outliers; its `merging` is for landmarks that were found without identities.
    pub filter: SlamParams,
    /// Thresholds of nearest neighbour.
    pub nearest_neighbour: NearestNeighbourParams,
    /// Thresholds of joint compatibility.
    pub joint_compatibility: JointCompatibilityParams,
    /// What a landmark must show that was found without an identity; takes the place of the filter's `confirmation` then.
    pub unlabelled_confirmation: LandmarkConfirmationParams,
    /// Whether to record what the run observes; a command-line option, since it is no property of the robot.
    #[serde(skip)]
    pub record_observability: bool,
    /// Whether to keep the text of the batch.
    #[serde(skip)]
    pub record_graph: bool,
    /// Whether a smoother follows the filter; a command-line option too.
    #[serde(skip)]
    pub smoothing: Smoothing,
}

/// Where sensor and antenna sit on the robot: x forward and y left of the point whose motion odometry measures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MountingParams {
    /// The range-bearing sensor, m.
    pub sensor_x: f64,
    /// The range-bearing sensor, m.
    pub sensor_y: f64,
    /// Its direction, rad; 0 ahead, counter-clockwise.
    pub sensor_heading: f64,
    /// The antenna whose positions the log has, m.
    pub antenna_x: f64,
    /// The antenna, m.
    pub antenna_y: f64,
}

/// Timing of a robot, kind and scale of its ranges.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotTimingParams {
    /// Time from the exposure of the sensor to the stamp of what it saw, s.
    pub sensor_latency: f64,
    /// Time from the stamp of a velocity command to the motion it makes, s.
    pub command_delay: f64,
    /// Time that a commanded turn loses: the turn is shorter than in the log by this time, s.
    pub turn_command_time_loss: f64,
    /// A velocity holds for this long after its stamp, s; then the motion is unknown. Default: as in ROS 2 navigation.
    pub velocity_timeout: f64,
    /// Whether the sensor gives depth along its axis instead of distance.
    pub range_is_depth: bool,
    /// Standard deviation of the logarithm of the sensor's range scale, which is estimated; 0 when the scale is exact.
    pub range_scale_sigma: f64,
}

impl Default for RobotTimingParams {
    fn default() -> Self {
        Self {
            sensor_latency: 0.0,
            command_delay: 0.0,
            turn_command_time_loss: 0.0,
            velocity_timeout: VELOCITY_TIMEOUT,
            range_is_depth: false,
            range_scale_sigma: 0.0,
        }
    }
}

/// A kind of robot and its defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum RobotProfile {
    /// Nothing is known of the robot: a good sensor (5 cm, 0.01 rad), odometry as it comes.
    Generic,
    /// The simulated range-bearing logs for comparing programs: 0.02 m, 0.005 rad per increment; 0.05 m, 0.01 rad per detection.
    RangeBearing,
    /// The truck of the Victoria Park set: a car with a laser that finds tree trunks.
    VictoriaPark,
    /// The robots of the UTIAS set: iRobot Create with a monocular camera that reads bar codes.
    Utias,
}

impl RobotProfile {
    /// The robot that recorded a log, as far as the first format of the log shows it.
    pub fn of_log(meta: &LogMetadata) -> Self {
        match meta.first_format() {
            LogFormat::Utias => Self::Utias,
            LogFormat::RangeBearing => Self::RangeBearing,
            LogFormat::VictoriaPark => Self::VictoriaPark,
            _ => Self::Generic,
        }
    }
}

impl PointSlamParams {
    /// The defaults of a kind of robot.
    pub fn of(profile: RobotProfile) -> Self {
        match profile {
            RobotProfile::Generic => Self {
                profile,
                association: None,
                start_pose: None,
                n_anchors: 0,
                anchors: Vec::new(),
                external: ExternalParams::default(),
                robot: RobotTimingParams::default(),
                mounting: MountingParams::default(),
                vehicle: AckermannVehicle::default(),
                sensor: RangeBearingSensor::default(),
                velocity_noise: VelocityMotion::default(),
                increment_noise: OdometryMotion::default(),
                filter: SlamParams::default(),
                nearest_neighbour: NearestNeighbourParams::default(),
                joint_compatibility: JointCompatibilityParams::default(),
                unlabelled_confirmation: LandmarkConfirmationParams {
                    min_detections: 3,
                    max_consecutive_misses: Some(20),
                    ..LandmarkConfirmationParams::default()
                },
                record_observability: false,
                record_graph: false,
                smoothing: Smoothing::Off,
            },
            RobotProfile::RangeBearing => Self {
                increment_noise: OdometryMotion {
                    translation_variance_per_meter: 0.0,
                    heading_variance_per_meter: 0.0,
                    heading_variance_per_radian: 0.0,
                    translation_variance_per_step: 0.02 * 0.02,
                    heading_variance_per_step: 0.005 * 0.005,
                },
                ..Self::of(RobotProfile::Generic)
            }
            .named(profile),
            RobotProfile::VictoriaPark => Self {
                mounting: MountingParams {
                    sensor_x: 3.78,
                    sensor_y: 0.5,
                    sensor_heading: 0.0,
                    antenna_x: 3.78,
                    antenna_y: 0.5,
                },
                sensor: RangeBearingSensor {
                    range_sigma: 1.0,
                    range_sigma_per_meter: 0.0,
                    bearing_sigma: 0.05,
                    sensor_range: 30.0,
                    half_field_of_view: 1.3,
                    correlated_noise: None,
                },
                velocity_noise: VelocityMotion {
                    linear_sigma: 0.0,
                    angular_sigma: 0.0,
                    turning_sigma: 0.05,
                    linear_sigma_per_meter: 0.1,
                    angular_sigma_per_meter: 0.01,
                    ..VelocityMotion::default()
                },
                nearest_neighbour: NearestNeighbourParams {
                    new_landmark_nis: 60.0,
                    ..NearestNeighbourParams::default()
                },
                joint_compatibility: JointCompatibilityParams {
                    gate_probability: 0.99,
                    new_landmark_nis: 60.0,
                    ..JointCompatibilityParams::default()
                },
                unlabelled_confirmation: LandmarkConfirmationParams {
                    min_detections: 8,
                    max_consecutive_misses: Some(5),
                    min_detection_rate: 0.4,
                    ..LandmarkConfirmationParams::default()
                },
                ..Self::of(RobotProfile::Generic)
            }
            .named(profile),
            // Measured as residuals against truth on set 7, robots 1-3 (docs/adr/0019-parameters-of-the-utias-profile.md).
            RobotProfile::Utias => Self {
                robot: RobotTimingParams {
                    sensor_latency: 0.04,
                    command_delay: 0.15,
                    turn_command_time_loss: 0.04,
                    velocity_timeout: VELOCITY_TIMEOUT,
                    range_is_depth: true,
                    range_scale_sigma: 0.04,
                },
                sensor: RangeBearingSensor {
                    range_sigma: 0.01,
                    range_sigma_per_meter: 0.03,
                    bearing_sigma: 0.035,
                    sensor_range: 5.0,
                    half_field_of_view: 0.45,
                    // By the differences of detections in one frame and the next, set 7: 0.004-0.006 rad and 0.02-0.04 m within a frame;
                    // in common what is left against the truth, 0.006-0.018 rad, and 0.8 % once the scale is estimated.
                    correlated_noise: Some(CorrelatedNoise {
                        independent_range_sigma: 0.02,
                        independent_range_sigma_per_meter: 0.0,
                        independent_bearing_sigma: 0.006,
                        common_range_sigma_per_meter: 0.01,
                        common_bearing_sigma: 0.018,
                    }),
                },
                velocity_noise: VelocityMotion { speed_loss_in_turns: 0.8, ..VelocityMotion::default() },
                filter: SlamParams {
                    // Errors are correlated in time and have heavy tails, so the threshold is the mean NIS, d² = 2.
                    outlier_rule: OutlierRule::Downweight,
                    gate_probability: 0.632,
                    // The tubes of a group stand 0.18-0.3 m apart.
                    merging: Some(LandmarkMergingParams { min_separation: 0.13, n_sigmas: 2.0 }),
                    ..SlamParams::default()
                },
                joint_compatibility: JointCompatibilityParams {
                    new_landmark_nis: 20.0,
                    one_detection_per_landmark: true,
                    ..JointCompatibilityParams::default()
                },
                unlabelled_confirmation: LandmarkConfirmationParams {
                    min_detections: 8,
                    max_consecutive_misses: Some(20),
                    ..LandmarkConfirmationParams::default()
                },
                ..Self::of(RobotProfile::Generic)
            }
            .named(profile),
        }
    }

    /// Parameters from TOML text; what it does not name keeps the default of the profile it names, else of `profile`.
    ///
    /// # Errors
    /// When the text is not TOML, a key is unknown or a value has the wrong type. [`Self::validated`] checks ranges.
    pub fn from_toml(text: &str, profile: RobotProfile) -> Result<Self, toml::de::Error> {
        #[derive(Deserialize)]
        struct Named {
            profile: Option<RobotProfile>,
        }
        let named: Named = toml::from_str(text)?;
        let defaults = Self::of(named.profile.unwrap_or(profile));
        over_defaults(&defaults, text)
    }

    fn named(self, profile: RobotProfile) -> Self {
        Self { profile, ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_changes_what_it_names_and_nothing_else() {
        let text = "association = 'nn'\n[robot]\ncommand_delay = 0.2\n[filter.confirmation]\nmax_consecutive_misses = 7";
        let params = PointSlamParams::from_toml(text, RobotProfile::Utias).unwrap();
        let mut expected = PointSlamParams::of(RobotProfile::Utias);
        expected.association = Some(AssociationRule::Nn);
        expected.robot.command_delay = 0.2;
        expected.filter.confirmation.max_consecutive_misses = Some(7);
        assert_eq!(params, expected);
    }

    #[test]
    fn the_profile_of_the_file_goes_before_that_of_the_log() {
        let params = PointSlamParams::from_toml("profile = 'range-bearing'", RobotProfile::Utias).unwrap();
        assert_eq!(params, PointSlamParams::of(RobotProfile::RangeBearing));
    }

    #[test]
    fn what_is_not_understood_is_named() {
        let error = |text| PointSlamParams::from_toml(text, RobotProfile::Generic).unwrap_err().to_string();
        for (text, named) in [
            ("[sensor]\nrange_sigm = 1.0", "`range_sigm`"),
            ("[sensor]\nrange_sigma = 'far'", "2 | range_sigma = 'far'"),
            ("sensor = 3", "1 | sensor = 3"),
            ("[filter]\noutlier_rule = 'ignore'", "2 | outlier_rule = 'ignore'"),
            ("[filter.confirmation]\nmin_detections = -1", "2 | min_detections = -1"),
            ("[sensor", "line 1"),
        ] {
            assert!(error(text).contains(named), "{text}: {}", error(text));
        }
    }

    #[test]
    fn parameters_survive_being_written() {
        for profile in [
            RobotProfile::Generic,
            RobotProfile::RangeBearing,
            RobotProfile::VictoriaPark,
            RobotProfile::Utias,
        ] {
            let params = PointSlamParams::of(profile);
            let text = toml::to_string(&params).unwrap();
            assert_eq!(PointSlamParams::from_toml(&text, RobotProfile::Generic).unwrap(), params);
        }
    }
}
