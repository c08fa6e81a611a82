use nalgebra::Vector3;
use rand::RngExt;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use rand_distr::StandardNormal;
use wayfix_appearance_cml::OdometryNoise;
use wayfix_estimation_traits::{LieGroup, Manifold, Pose2};

/// Random stream of the odometry noise, different from all other streams.
const STREAM: u64 = 3;

/// Increments of a path, each in the body frame before it, with noise that grows with distance and turn.
pub fn synthetic_odometry(path: &[Pose2<f64>], noise: &OdometryNoise, seed: u64) -> Vec<Pose2<f64>> {
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
        let none = OdometryNoise {
            forward_sigma_per_meter: 0.0,
            sideways_sigma_per_meter: 0.0,
            heading_sigma_per_meter: 0.0,
            heading_sigma_per_radian: 0.0,
        };
        let end = |noise: &OdometryNoise| {
            synthetic_odometry(&path, noise, 1)
                .iter()
                .fold(path[0], |pose, increment| pose.compose(increment))
        };
        let error = |noise: &OdometryNoise| (end(noise).translation - path[49].translation).norm();
        // The filter's floor of 1e-6 a step remains.
        assert!(error(&none) < 1e-4);
        assert!((0.005..1.0).contains(&error(&OdometryNoise::default())));
    }
}
