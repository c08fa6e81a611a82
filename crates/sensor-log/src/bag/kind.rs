use crate::ros::RosSchema;

/// Kinds of topics in a bag; one topic of each kind is read, except for transforms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Scan,
    Motion,
    Image,
    CameraInfo,
    TruePose,
    EstimatedPose,
    MeasuredPosition,
    MeasuredHeading,
    MeasuredPose,
    Transforms,
}

/// Message type of a topic, and the kind that it is read as.
pub(crate) type BagRoute = (RosSchema, Kind);

/// Parts of a topic's name that indicate motion capture or a simulator.
const TRUTH: [&str; 6] = ["truth", "mocap", "motion_capture", "vicon", "optitrack", "qualisys"];
/// Parts of the name of a topic of poses that a sensor measures without a map of its own.
const MEASURED: [&str; 6] = ["camera", "marker", "apriltag", "aruco", "beacon", "uwb"];
/// Names of poses that are goals or manual inputs and not estimates.
const NO_ESTIMATE: [&str; 5] = ["goal", "target", "setpoint", "waypoint", "initialpose"];

impl Kind {
    /// Kind of the messages of this schema on this topic; `None` for poses that are not the robot's.
    pub(super) fn of(schema: RosSchema, topic: &str) -> Option<Self> {
        match schema {
            RosSchema::LaserScan => Some(Self::Scan),
            RosSchema::Odometry if is_ground_truth(topic) => Some(Self::TruePose),
            RosSchema::Odometry | RosSchema::TwistStamped | RosSchema::Twist => Some(Self::Motion),
            RosSchema::Image | RosSchema::CompressedImage => Some(Self::Image),
            RosSchema::CameraInfo => Some(Self::CameraInfo),
            RosSchema::PoseStamped | RosSchema::PoseWithCovarianceStamped if is_ground_truth(topic) => {
                Some(Self::TruePose)
            }
            RosSchema::PoseStamped | RosSchema::PoseWithCovarianceStamped => {
                let topic = topic.to_ascii_lowercase();
                let is_measured = MEASURED.iter().any(|word| topic.contains(word));
                if is_measured && schema == RosSchema::PoseWithCovarianceStamped {
                    return Some(Self::MeasuredPose);
                }
                (!NO_ESTIMATE.iter().any(|word| topic.contains(word))).then_some(Self::EstimatedPose)
            }
            RosSchema::NavSatFix => Some(Self::MeasuredPosition),
            RosSchema::Imu => Some(Self::MeasuredHeading),
            RosSchema::Transforms => Some(Self::Transforms),
        }
    }

    /// In words.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Scan => "laser scan",
            Self::Motion => "odometry",
            Self::Image => "image",
            Self::CameraInfo => "camera info",
            Self::TruePose => "true pose",
            Self::EstimatedPose => "estimated pose",
            Self::MeasuredPosition => "measured position",
            Self::MeasuredHeading => "measured heading",
            Self::MeasuredPose => "measured pose",
            Self::Transforms => "transforms",
        }
    }
}

fn is_ground_truth(topic: &str) -> bool {
    let topic = topic.to_ascii_lowercase();
    TRUTH.iter().any(|word| topic.contains(word))
        || topic.split(|c: char| !c.is_ascii_alphanumeric()).any(|part| part == "gt")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_are_true_where_the_name_of_the_topic_says_so() {
        let kind = |topic| Kind::of(RosSchema::PoseStamped, topic);
        for topic in ["/ground_truth/pose", "/robot_gt/pose", "/gt", "/vicon/base", "/Optitrack/robot"] {
            assert_eq!(kind(topic), Some(Kind::TruePose), "{topic}");
        }
        for topic in ["/amcl_pose", "/length/pose", "/slam/gtsam_pose"] {
            assert_eq!(kind(topic), Some(Kind::EstimatedPose), "{topic}");
        }
        assert_eq!(kind("/goal_pose"), None);
        assert_eq!(Kind::of(RosSchema::Odometry, "/ground_truth/odom"), Some(Kind::TruePose));
        assert_eq!(Kind::of(RosSchema::Odometry, "/odom"), Some(Kind::Motion));
    }
}
