use wayfix_estimation_traits::Pose2;

use super::WheeledRobotParams;
use crate::random::{GaussMarkovProcess, RandomStreamPurpose, RandomStreams};
use crate::{SimulationError, plane};

/// Two driven wheels on one axle: motors that lag, wheels that slip and are not as built.
///
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_estimation_traits::Pose2;
/// use wayfix_scene_sim::{drive::{DifferentialDrive, WheeledRobotParams}, random::RandomStreams};
/// let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(1));
/// let mut robot = DifferentialDrive::new(WheeledRobotParams::default(), Pose2::new(0.0, 0.0, 0.0))?;
/// for _ in 0..1000 {
///     robot.step(1e-3, 1.0, 0.0, &mut streams);
/// }
/// assert!((robot.pose().x() - 0.9).abs() < 1e-3); // 1 s at 1 m/s less the motors' lag of 0.1 s
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug)]
pub struct DifferentialDrive {
    params: WheeledRobotParams,
    pose: Pose2<f64>,
    /// Turning speeds of the left and right wheel, rad/s.
    wheel_rates: [f64; 2],
    /// Angle of each wheel since the start, rad.
    wheel_angles: [f64; 2],
    common_slip: GaussMarkovProcess,
    own_slips: [GaussMarkovProcess; 2],
}

impl DifferentialDrive {
    /// A robot at rest at `start`.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] if a parameter is out of range.
    pub fn new(params: WheeledRobotParams, start: Pose2<f64>) -> Result<Self, SimulationError> {
        params.validate()?;
        let slip = GaussMarkovProcess::new(params.slip.correlation_time_s);
        Ok(Self {
            params,
            pose: start,
            wheel_rates: [0.0; 2],
            wheel_angles: [0.0; 2],
            common_slip: slip.clone(),
            own_slips: [slip.clone(), slip],
        })
    }

    /// Lets `step_s` seconds pass under a commanded forward speed (m/s) and turning rate (rad/s).
    pub fn step(&mut self, step_s: f64, linear: f64, angular: f64, streams: &mut RandomStreams) {
        self.follow_command(step_s, linear, angular);
        let slips = self.slips(step_s, streams);
        let true_radii = [self.params.left_radius_error, self.params.right_radius_error]
            .map(|error| self.params.wheel_radius_m * (1.0 + error));
        let true_track = self.params.wheel_separation_m * (1.0 + self.params.wheel_separation_error);
        let [left, right] = [0, 1].map(|k| self.wheel_rates[k] * step_s * true_radii[k] * (1.0 - slips[k]));
        self.pose = plane::advance(&self.pose, 0.5 * (left + right), (right - left) / true_track);
        for (angle, rate) in self.wheel_angles.iter_mut().zip(self.wheel_rates) {
            *angle += rate * step_s;
        }
    }

    /// True pose of the robot.
    pub fn pose(&self) -> Pose2<f64> {
        self.pose
    }

    /// Angles of the left and the right wheel since the start, rad: the input of encoders.
    pub fn wheel_angles(&self) -> [f64; 2] {
        self.wheel_angles
    }

    /// The controller uses the nominal parameters.
    fn follow_command(&mut self, step_s: f64, linear: f64, angular: f64) {
        let half_track = 0.5 * self.params.wheel_separation_m;
        let wanted = [linear - half_track * angular, linear + half_track * angular]
            .map(|ground_speed| ground_speed / self.params.wheel_radius_m);
        let reached = 1.0 - libm::exp(-step_s / self.params.motor_lag_s);
        for (rate, wanted) in self.wheel_rates.iter_mut().zip(wanted) {
            *rate += reached * (wanted - *rate);
        }
    }

    fn slips(&mut self, step_s: f64, streams: &mut RandomStreams) -> [f64; 2] {
        let rng = streams.of(RandomStreamPurpose::Slip);
        let common = self.common_slip.advance(step_s, rng);
        let (of_common, of_own) =
            (self.params.slip.wheel_correlation.sqrt(), (1.0 - self.params.slip.wheel_correlation).sqrt());
        self.own_slips
            .each_mut()
            .map(|own| self.params.slip.slip_sigma * (of_common * common + of_own * own.advance(step_s, rng)))
    }
}
