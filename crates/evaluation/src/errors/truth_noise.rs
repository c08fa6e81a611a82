use nalgebra::{Matrix3, Vector3};
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_sensor_log::{Record, RecordData, Stamp};

/// Covariance of the errors of the truth, estimated from its scatter before odometry first moves; zero if the robot does not stand still.
///
/// The difference of two poses of a standing robot has twice the variance of one.
pub(super) fn truth_noise(poses: &[(Stamp, Pose2<f64>)], records: &[Record]) -> Matrix3<f64> {
    let Some((begin, end)) = standstill(records) else { return Matrix3::zeros() };
    let still = poses.iter().filter(|(stamp, _)| (begin..=end).contains(stamp));
    let still: Vec<&Pose2<f64>> = still.map(|(_, pose)| pose).collect();
    let differences: Vec<Vector3<f64>> = still.windows(2).map(|pair| pair[0].local(pair[1])).collect();
    if differences.is_empty() {
        return Matrix3::zeros();
    }
    let variance = |square: fn(&Vector3<f64>) -> f64| {
        differences.iter().map(square).sum::<f64>() / (2.0 * differences.len() as f64)
    };
    let position = variance(|difference| 0.5 * (difference.x * difference.x + difference.y * difference.y));
    let heading = variance(|difference| difference.z * difference.z);
    Matrix3::from_diagonal(&Vector3::new(position, position, heading))
}

/// From the first record of odometry to the last before the robot moves.
fn standstill(records: &[Record]) -> Option<(Stamp, Stamp)> {
    let mut span: Option<(Stamp, Stamp)> = None;
    for record in records {
        let moves = match &record.data {
            RecordData::Velocity(velocity) => velocity.linear != 0.0 || velocity.angular != 0.0,
            RecordData::Ackermann(drive) => drive.wheel_speed != 0.0,
            RecordData::OdometryIncrement(increment) => *increment != Pose2::identity(),
            _ => continue,
        };
        let is_velocity = !matches!(record.data, RecordData::OdometryIncrement(_));
        span = match span {
            // A velocity holds until the next one.
            Some((begin, _)) if moves => {
                return Some((begin, if is_velocity { record.stamp } else { span?.1 }));
            }
            None if moves => return None,
            None => Some((record.stamp, record.stamp)),
            Some((begin, _)) => Some((begin, record.stamp)),
        };
    }
    span
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::errors::ReferencePath;
    use approx::abs_diff_eq;

    fn at(milliseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(milliseconds * 1_000_000)
    }

    fn increment(milliseconds: u64, x: f64) -> Record {
        Record { stamp: at(milliseconds), data: RecordData::OdometryIncrement(Pose2::new(x, 0.0, 0.0)) }
    }

    fn truth(milliseconds: u64, x: f64) -> Record {
        Record { stamp: at(milliseconds), data: RecordData::TruePose(Pose2::new(x, 0.0, 0.0)) }
    }

    #[test]
    fn truth_noise_is_its_scatter_before_the_first_motion() {
        let odometry = [increment(0, 0.0), increment(300, 0.0), increment(400, 0.5)];
        let poses = [truth(0, 0.0), truth(100, 0.001), truth(200, 0.0), truth(300, 0.001), truth(400, 0.5)];
        let records = [&odometry[..], &poses[..]].concat();
        let noise = *ReferencePath::from_records(&records).noise();
        assert!(
            abs_diff_eq!(noise.m11, 0.25e-6, epsilon = 1e-12),
            "half of the variance 0.5e-6 along x: {noise}"
        );
        let exact = [&odometry[..], &[truth(0, 0.0), truth(300, 0.0)]].concat();
        assert_eq!(*ReferencePath::from_records(&exact).noise(), Matrix3::zeros());
    }
}
