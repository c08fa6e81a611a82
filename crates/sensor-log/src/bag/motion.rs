use wayfix_estimation_traits::{LieGroup, Pose2};

use crate::fault::{Fault, finite, inconsistent};
use crate::planar::heading_of;
use crate::ros::Pose;
use crate::{RowProblemKind, Stamp};

/// Maximum speed of a ground robot, m/s; faster motion is an odometry reset.
const FASTEST: f64 = 100.0;
/// Assumed stamp jitter of drivers, s.
const JITTER: f64 = 0.01;
/// Makes increments of poses that follow each other.
#[derive(Debug, Default)]
pub(super) struct Odometer {
    last: Option<(Stamp, Pose2<f64>)>,
    /// A pose that is too far from the last one: an outlier, or the first after an odometry reset.
    doubtful: Option<(Stamp, Pose2<f64>)>,
}

impl Odometer {
    /// Motion since the previous pose, in the robot frame there; `None` at the first.
    ///
    /// An implausible pose is skipped. If the next pose is consistent with it, odometry was reset.
    pub(super) fn increment(&mut self, stamp: Stamp, pose: Pose2<f64>) -> Result<Option<Pose2<f64>>, Fault> {
        let Some((before, from)) = self.last else {
            self.last = Some((stamp, pose));
            return Ok(None);
        };
        if stamp < before {
            return Err((
                RowProblemKind::TooLate,
                format!("odometry of {stamp} comes after that of {before}"),
            ));
        }
        let from_doubtful =
            self.doubtful.take().and_then(|(since, from)| motion(since, &from, stamp, &pose).ok());
        match motion(before, &from, stamp, &pose).map_err(Some).or_else(|why| from_doubtful.ok_or(why)) {
            Ok(increment) => {
                self.last = Some((stamp, pose));
                Ok(Some(increment))
            }
            Err(why) => {
                self.doubtful = Some((stamp, pose));
                Err(inconsistent(&why.unwrap_or_default()))
            }
        }
    }
}

/// The motion between two poses; an error if it is too fast.
fn motion(since: Stamp, from: &Pose2<f64>, stamp: Stamp, pose: &Pose2<f64>) -> Result<Pose2<f64>, String> {
    let seconds = stamp.seconds_since(since);
    let increment = from.inverse().compose(pose);
    let distance = increment.x().hypot(increment.y());
    if distance <= FASTEST * (seconds + JITTER) {
        return Ok(increment);
    }
    Err(format!("odometry jumps by {} m in {seconds:.3} s; the jump is left out", short(distance)))
}

/// A number without hundreds of digits.
fn short(number: f64) -> String {
    if number.abs() < 1e6 { format!("{number:.1}") } else { format!("{number:.1e}") }
}

/// The pose on the ground: x, y and the heading of the body's x axis.
pub(super) fn planar(pose: &Pose) -> Result<Pose2<f64>, Fault> {
    let ([x, y, _], heading) = (pose.position, heading_of(pose.orientation));
    finite([x, y, heading])?;
    Ok(Pose2::new(x, y, heading))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn at(nanoseconds: u64) -> Stamp {
        Stamp::from_nanoseconds(nanoseconds)
    }

    #[test]
    fn increments_add_up_to_the_path() {
        let mut odometer = Odometer::default();
        let poses = [Pose2::new(1.0, 2.0, 0.5), Pose2::new(1.5, 2.5, 3.0), Pose2::new(1.0, 2.0, -3.0)];
        assert_eq!(odometer.increment(at(0), poses[0]), Ok(None));
        let mut path = poses[0];
        for (k, pose) in poses.iter().enumerate().skip(1) {
            path = path.compose(&odometer.increment(at(k as u64 * 100_000_000), *pose).unwrap().unwrap());
        }
        assert_abs_diff_eq!(path.x(), 1.0, epsilon = 1e-15);
        assert_abs_diff_eq!(path.heading(), -3.0, epsilon = 1e-15);
    }

    #[test]
    fn overtaken_message_is_dropped() {
        let mut odometer = Odometer::default();
        let pose = |x| Pose2::new(x, 0.0, 0.0);
        odometer.increment(at(5_000_000_000), pose(1.0)).unwrap();
        assert_eq!(odometer.increment(at(4_990_000_000), pose(0.5)).unwrap_err().0, RowProblemKind::TooLate);
        assert_eq!(odometer.increment(at(5_010_000_000), pose(1.5)), Ok(Some(pose(0.5))));
    }

    #[test]
    fn one_absurd_pose_is_lost_alone() {
        let mut odometer = Odometer::default();
        let pose = |x| Pose2::new(x, 0.0, 0.0);
        odometer.increment(at(0), pose(1.0)).unwrap();
        let fault = odometer.increment(at(20_000_000), pose(1e256)).unwrap_err();
        assert!(fault.1.len() < 90, "{}", fault.1);
        assert_eq!(odometer.increment(at(40_000_000), pose(1.5)), Ok(Some(pose(0.5))));
    }

    #[test]
    fn odometry_that_is_set_back_is_no_motion() {
        let mut odometer = Odometer::default();
        odometer.increment(at(0), Pose2::new(50.0, 0.0, 0.0)).unwrap();
        let fault = odometer.increment(at(20_000_000), Pose2::new(0.0, 0.0, 0.0)).unwrap_err();
        assert_eq!(fault.0, RowProblemKind::Inconsistent);
        let step = odometer.increment(at(40_000_000), Pose2::new(0.5, 0.0, 0.0));
        assert_eq!(step, Ok(Some(Pose2::new(0.5, 0.0, 0.0))));
    }
}
