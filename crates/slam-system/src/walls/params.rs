use anyhow::ensure;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use wayfix_estimation_traits::Pose2;
use wayfix_line_extract::LineExtractionParams;
use wayfix_scan_match::ScanMatchParams;
use wayfix_slam_ekf::{
    AnchorParams, ExternalParams, JointCompatibility, JointCompatibilityParams, LandmarkConfirmationParams,
    LinearizationPoint, NearestNeighbour, NearestNeighbourParams, OdometryMotion, SlamError, SlamParams,
    WallSensor,
};
use wayfix_system_core::VELOCITY_TIMEOUT;

use crate::slam::{AssociationRule, increment_numbers, number};

/// Everything that can be set for EKF-SLAM with walls.
///
/// ```
/// use wayfix_slam_system::walls::WallSlamParams;
/// use wayfix_system_core::settings::from_toml;
/// let params = from_toml::<WallSlamParams>("[sensor]\nrho_sigma = 0.05")?;
/// assert_eq!(params.sensor.rho_sigma, 0.05);
/// assert_eq!(params.line_extraction, WallSlamParams::default().line_extraction); // not named in the text
/// # Ok::<(), toml::de::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WallSlamParams {
    /// How pieces of walls find their walls: `nn` or `jcbb`; walls have no identities.
    pub association: AssociationRule,
    /// Start pose, m and rad; when not given, that of the log where odometry starts, or the origin.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub start_pose: Option<[f64; 3]>,
    /// Pose of the laser on the robot: x forward, y left, heading; m and rad. Default: that of the log, else the robot's centre.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub laser_pose: Option<[f64; 3]>,
    /// How many true walls of the log, nearest to the start first, the robot is given as known: anchors that tie the map to the world. For
    /// experiments with logs that have true walls.
    pub n_anchors: usize,
    /// Walls that are known before the run, by their ends.
    #[serde(skip_serializing_if = "Vec::is_empty", default)]
    pub anchors: Vec<AnchorParams<[[f64; 2]; 2]>>,
    /// Sensors of the pose that do not use the map.
    pub external: ExternalParams,
    /// The antenna whose positions the log has, in the robot frame, m.
    pub antenna: [f64; 2],
    /// Distance and rotation between keyframes, which are the scans that correct the map.
    pub keyframes: KeyframeThreshold,
    /// Noise of the difference between odometry and scans, per scan.
    pub odometry_noise_per_scan: OdometryNoisePerScan,
    /// Whether each scan is matched to the last keyframe, which measures the motion better than wheels do.
    pub match_scans: bool,
    /// Parameters of scan matching.
    pub scan_match: ScanMatchParams,
    /// How walls are found in a scan.
    pub line_extraction: LineExtractionParams,
    /// Pieces shorter than this correct nothing, m: legs, posters and door leaves.
    pub min_wall_length: f64,
    /// Whether a shorter piece corrects too if it lies within two standard deviations of a wall that the map expects there.
    pub expected_walls: bool,
    /// How walls are seen.
    pub sensor: WallSensor,
    /// Prior standard deviation of the heading drift of odometry, rad/m; the drift is estimated.
    pub heading_drift_sigma: f64,
    /// A velocity holds for this long after its stamp, s; then the motion is unknown. Default: as in ROS 2 navigation.
    pub velocity_timeout: f64,
    /// Delay of the odometry stamps relative to the scan stamps, s; negative for earlier odometry stamps.
    pub odometry_delay: f64,
    /// Whether scans are corrected for the motion of the laser, if the log has the time from beam to beam.
    pub deskew_scans: bool,
    /// Noise of odometry increments.
    pub increment_noise: OdometryMotion,
    /// Gate and outliers.
    pub filter: SlamParams,
    /// Thresholds of nearest neighbour.
    pub nearest_neighbour: NearestNeighbourParams,
    /// Thresholds of joint compatibility.
    pub joint_compatibility: JointCompatibilityParams,
    /// Whether to record what the run observes; a command-line option, since it is no property of the robot.
    #[serde(skip)]
    pub record_observability: bool,
}

/// Noise of the difference between odometry and scans at every scan: stamps differ and wheels slip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct OdometryNoisePerScan {
    /// Along either axis, m.
    pub translation_sigma: f64,
    /// Of the heading, rad.
    pub heading_sigma: f64,
}

impl Default for OdometryNoisePerScan {
    /// A tenth of a second at walking pace, less what odometry at the scan's own stamp saves.
    fn default() -> Self {
        Self { translation_sigma: 0.02, heading_sigma: 0.01 }
    }
}

/// Motion between two keyframes. A scan in between shows the same walls with the same errors again and is skipped.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct KeyframeThreshold {
    /// Distance after which a scan becomes a keyframe, m.
    pub min_distance: f64,
    /// Rotation after which a scan becomes a keyframe, rad.
    pub min_rotation: f64,
}

impl Default for KeyframeThreshold {
    fn default() -> Self {
        Self { min_distance: 0.25, min_rotation: 0.2 }
    }
}

impl Default for WallSlamParams {
    fn default() -> Self {
        Self {
            association: AssociationRule::Jcbb,
            start_pose: None,
            laser_pose: None,
            n_anchors: 0,
            anchors: Vec::new(),
            external: ExternalParams::default(),
            antenna: [0.0; 2],
            keyframes: KeyframeThreshold::default(),
            odometry_noise_per_scan: OdometryNoisePerScan::default(),
            match_scans: true,
            scan_match: ScanMatchParams::default(),
            line_extraction: LineExtractionParams::default(),
            min_wall_length: 1.0,
            expected_walls: false,
            sensor: WallSensor::default(),
            heading_drift_sigma: 0.05,
            velocity_timeout: VELOCITY_TIMEOUT,
            odometry_delay: 0.0,
            deskew_scans: true,
            increment_noise: OdometryMotion {
                translation_variance_per_meter: 1e-2,
                heading_variance_per_meter: 5e-3,
                heading_variance_per_radian: 3e-2,
                ..OdometryMotion::default()
            },
            filter: SlamParams {
                linearization_point: LinearizationPoint::FirstEstimates,
                confirmation: LandmarkConfirmationParams {
                    min_detections: 3,
                    max_consecutive_misses: Some(10),
                    ..LandmarkConfirmationParams::default()
                },
                ..SlamParams::default()
            },
            nearest_neighbour: NearestNeighbourParams::default(),
            joint_compatibility: JointCompatibilityParams {
                gate_probability: 0.95,
                ambiguity_margin: 9.0,
                ..JointCompatibilityParams::default()
            },
            record_observability: false,
        }
    }
}

/// Smallest value, and the range in words.
type Range = (f64, &'static str);
const POSITIVE: Range = (1e-9, "from 1e-9 to 1e6");
/// Stamps that are further apart are on different clocks, s.
const LARGEST_DELAY: f64 = 60.0;
const NOT_NEGATIVE: Range = (0.0, "from 0 to 1e6");

impl WallSlamParams {
    /// Where the laser sits on the robot.
    pub(super) fn mount(&self) -> Pose2<f64> {
        let [x, y, heading] = self.laser_pose.unwrap_or_default();
        Pose2::new(x, y, heading)
    }

    /// The same parameters, when each is within its range.
    ///
    /// # Errors
    /// The first that is not, by name.
    pub fn validated(self) -> anyhow::Result<Self> {
        self.line_extraction.check()?;
        self.external.check()?;
        self.scan_match.check()?;
        NearestNeighbour::new(self.nearest_neighbour)?;
        JointCompatibility::new(self.joint_compatibility)?;
        ensure!(
            self.association != AssociationRule::Known,
            "parameter association is known, but walls have no identities: use nn or jcbb"
        );
        let Self { sensor, keyframes, odometry_noise_per_scan, .. } = &self;
        for (name, value, (low, range)) in [
            number!(sensor.rho_sigma, POSITIVE),
            number!(sensor.alpha_sigma, POSITIVE),
            number!(sensor.max_wall_gap, NOT_NEGATIVE),
            number!(sensor.sensor_range, POSITIVE),
            number!(sensor.half_field_of_view, POSITIVE),
            ("min_wall_length", self.min_wall_length, NOT_NEGATIVE),
            number!(keyframes.min_distance, NOT_NEGATIVE),
            number!(keyframes.min_rotation, NOT_NEGATIVE),
            number!(odometry_noise_per_scan.translation_sigma, NOT_NEGATIVE),
            number!(odometry_noise_per_scan.heading_sigma, NOT_NEGATIVE),
            ("heading_drift_sigma", self.heading_drift_sigma, NOT_NEGATIVE),
            ("velocity_timeout", self.velocity_timeout, NOT_NEGATIVE),
        ]
        .into_iter()
        .chain(increment_numbers(&self.increment_noise).map(|(name, value)| (name, value, NOT_NEGATIVE)))
        {
            if !(low..=1e6).contains(&value) {
                return Err(SlamError::Parameter { name, value, range }.into());
            }
        }
        if !(-LARGEST_DELAY..=LARGEST_DELAY).contains(&self.odometry_delay) {
            let (name, value) = ("odometry_delay", self.odometry_delay);
            return Err(SlamError::Parameter { name, value, range: "from -60 to 60" }.into());
        }
        let places = self.laser_pose.iter().chain(&self.start_pose).flatten().chain(&self.antenna);
        if let Some(value) = places.copied().find(|value| !value.is_finite()) {
            return Err(SlamError::Parameter {
                name: "laser_pose, start_pose or antenna",
                value,
                range: "finite",
            }
            .into());
        }
        let mut headings = self.laser_pose.iter().chain(&self.start_pose).map(|[.., heading]| *heading);
        if let Some(value) = headings.find(|heading| heading.abs() > std::f64::consts::TAU) {
            let (name, range) = ("heading of laser_pose or start_pose", "from -2π to 2π rad");
            return Err(SlamError::Parameter { name, value, range }.into());
        }
        Ok(self)
    }
}
