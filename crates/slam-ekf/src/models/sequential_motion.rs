use nalgebra::Matrix3;
use wayfix_estimation_traits::{MotionModel, Pose2};

/// One motion after another as a single motion: a filter takes all of them or none, and moves its covariance once.
///
/// $`F = F_n ⋯ F_1,\; Q = F_n (⋯ F_2 Q_1 F_2^T + Q_2 ⋯) F_n^T + Q_n`$
#[derive(Clone, Copy, Debug)]
pub struct SequentialMotion<M>(pub M);

impl<M> MotionModel for SequentialMotion<M>
where
    M: MotionModel<State = Pose2<f64>>,
    M::Control: Sized,
{
    type State = Pose2<f64>;
    type Control = [M::Control];

    fn propagate(&self, pose: &Pose2<f64>, controls: &[M::Control]) -> Pose2<f64> {
        controls.iter().fold(*pose, |pose, control| self.0.propagate(&pose, control))
    }

    fn jacobian(&self, pose: &Pose2<f64>, controls: &[M::Control]) -> Matrix3<f64> {
        let step = |(pose, jacobian): (Pose2<f64>, Matrix3<f64>), control| {
            (self.0.propagate(&pose, control), self.0.jacobian(&pose, control) * jacobian)
        };
        controls.iter().fold((*pose, Matrix3::identity()), step).1
    }

    fn noise(&self, pose: &Pose2<f64>, controls: &[M::Control]) -> Matrix3<f64> {
        let step = |(pose, noise): (Pose2<f64>, Matrix3<f64>), control| {
            let jacobian = self.0.jacobian(&pose, control);
            let carried = jacobian * noise * jacobian.transpose();
            (self.0.propagate(&pose, control), carried + self.0.noise(&pose, control))
        };
        controls.iter().fold((*pose, Matrix3::zeros()), step).1
    }
}

#[cfg(test)]
mod tests {
    use crate::{VelocityControl, VelocityMotion};
    use approx::assert_abs_diff_eq;
    use wayfix_estimation_traits::laws;

    use super::*;

    const CONTROLS: [VelocityControl; 3] = [
        VelocityControl { linear: 0.3, angular: 0.5, duration: 0.7 },
        VelocityControl { linear: 0.0, angular: -1.2, duration: 0.2 },
        VelocityControl { linear: -0.4, angular: 0.0, duration: 1.5 },
    ];

    #[test]
    fn a_sequence_is_a_motion_by_the_laws() {
        let poses = [Pose2::new(0.0, 0.0, 0.0), Pose2::new(3.0, -2.0, 3.1), Pose2::new(-1.0, 50.0, -1.5)];
        let cases = poses.map(|pose| (pose, CONTROLS.as_slice()));
        laws::motion(&SequentialMotion(VelocityMotion::default()), &cases).unwrap();
    }

    #[test]
    fn a_command_cut_in_pieces_is_still_the_same_motion() {
        let motion = VelocityMotion::default();
        let whole = VelocityControl { linear: 0.3, angular: 0.4, duration: 1.0 };
        let pieces = [VelocityControl { duration: 0.01, ..whole }; 100];
        let pose = Pose2::new(1.0, 2.0, 0.5);
        let in_pieces = SequentialMotion(motion);
        let (one, many) = (motion.propagate(&pose, &whole), in_pieces.propagate(&pose, &pieces));
        assert_abs_diff_eq!(one.translation, many.translation, epsilon = 1e-12);
        assert_abs_diff_eq!(one.heading(), many.heading(), epsilon = 1e-12);
        let jacobians = motion.jacobian(&pose, &whole) - in_pieces.jacobian(&pose, &pieces);
        assert!(jacobians.amax() < 1e-12);
        // Variances along the path and in heading are a random walk, hence the same however time is cut.
        let (one, many) = (motion.noise(&pose, &whole), in_pieces.noise(&pose, &pieces));
        assert_abs_diff_eq!(one.m33, many.m33, epsilon = 1e-12);
    }
}
