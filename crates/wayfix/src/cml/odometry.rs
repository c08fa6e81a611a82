use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_appearance_cml::OdometryNoise;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};
use wayfix_sensor_log::{Stamp, Velocity};

/// Not the stream of any other draw.
const STREAM: u64 = 3;

/// The increments of a path, each in the body frame before it, with noise that grows with the way and with the turn.
pub fn made_odometry(path: &[Pose2<f64>], noise: &OdometryNoise, seed: u64) -> Vec<Pose2<f64>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(STREAM);
    let mut noisy = |pair: &[Pose2<f64>]| {
        let increment = pair[0].inverse().compose(&pair[1]);
        let covariance = noise.covariance(&increment);
        let error = |axis: usize, normal: f64| covariance[(axis, axis)].sqrt() * normal;
        let normals: [f64; 3] = std::array::from_fn(|_| rng.sample(StandardNormal));
        increment.retract(&Vector3::new(error(0, normals[0]), error(1, normals[1]), error(2, normals[2])))
    };
    path.windows(2).map(&mut noisy).collect()
}

/// A velocity that holds until the next one, as increments.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct HeldVelocity {
    since: Option<(Stamp, Velocity)>,
}

impl HeldVelocity {
    /// The motion up to `stamp`; `None` when there is no velocity or no time has passed.
    pub(super) fn until(&mut self, stamp: Stamp) -> Option<Pose2<f64>> {
        let (since, velocity) = self.since?;
        let seconds = stamp.seconds_since(since);
        if seconds <= 0.0 {
            return None;
        }
        self.since = Some((stamp, velocity));
        Some(Pose2::exp(&Vector3::new(velocity.linear * seconds, 0.0, velocity.angular * seconds)))
    }

    pub(super) fn hold(&mut self, stamp: Stamp, velocity: Velocity) {
        self.since = Some((stamp, velocity));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn increments_lead_along_the_path_but_for_the_noise() {
        let path: Vec<Pose2<f64>> = (0..50)
            .map(|i| {
                let turn = 0.1 * f64::from(i);
                Pose2::new(turn.sin(), 1.0 - turn.cos(), turn)
            })
            .collect();
        let none =
            OdometryNoise { forward: 0.0, sideways: 0.0, heading_per_metre: 0.0, heading_per_radian: 0.0 };
        let end = |noise: &OdometryNoise| {
            made_odometry(&path, noise, 1).iter().fold(path[0], |pose, increment| pose.compose(increment))
        };
        let error = |noise: &OdometryNoise| (end(noise).translation - path[49].translation).norm();
        // The filter's floor of 1e-6 a step remains.
        assert!(error(&none) < 1e-4);
        assert!((0.005..1.0).contains(&error(&OdometryNoise::default())));
    }

    #[test]
    fn a_velocity_holds_until_the_next() {
        let mut held = HeldVelocity::default();
        let at = Stamp::from_nanoseconds;
        assert_eq!(held.until(at(5)), None);
        held.hold(at(1_000_000_000), Velocity { linear: 2.0, angular: 0.0 });
        assert!((held.until(at(1_500_000_000)).unwrap().x() - 1.0).abs() < 1e-12);
        assert_eq!(held.until(at(1_500_000_000)), None);
        assert!((held.until(at(1_600_000_000)).unwrap().x() - 0.2).abs() < 1e-9);
    }
}
