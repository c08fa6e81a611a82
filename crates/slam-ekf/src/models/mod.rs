//! Motion and sensor models of planar robots, and of a robot on a line.

mod ackermann;
mod correlated_noise;
mod drifting;
mod external;
mod increment;
mod monobot;
mod motion_statistics;
mod mounted;
mod planar;
mod range_bearing;
mod relative_position;
mod scaled;
mod sequential_motion;
mod unknown_motion;
mod velocity;
#[cfg(feature = "lines")]
mod wall;

pub use ackermann::AckermannVehicle;
pub use correlated_noise::CorrelatedNoise;
pub use drifting::{HeadingDriftSensor, PoseWithHeadingDrift, SensorWithHeadingDrift};
pub use external::{
    ExternalError, ExternalParams, HeadingSensor, LocalPlane, MapMeasurement, MovedSensor, PlanarRobot,
    PoseSensor, PositionSensor,
};
pub use increment::OdometryMotion;
pub use monobot::{LineDistanceSensor, MonobotMotion};
pub use motion_statistics::MotionStatistics;
pub use mounted::MountedSensor;
pub use planar::{PLANAR_SYMMETRIES, point_symmetry, pose_symmetry};
pub use range_bearing::{RangeBearing, RangeBearingSensor};
pub use relative_position::{RelativePosition, RelativePositionSensor};
pub use scaled::{MotionWithRangeScale, PoseWithRangeScale, RangeBearingSensorWithScale};
pub use sequential_motion::SequentialMotion;
pub use unknown_motion::UnknownMotion;
pub use velocity::{VelocityControl, VelocityMotion};
#[cfg(feature = "lines")]
pub use wall::{Wall, WallLine, WallMeasurement, WallSensor};
