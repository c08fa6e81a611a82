use anyhow::Result;
use nalgebra::{Matrix1, Matrix1x2, Matrix2, Vector1, Vector2};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::StandardNormal;
use wayfix_evaluation::report::Metric;
use wayfix_gaussian_core::Gaussian;
use wayfix_kalman::{KalmanFilter, LinearMotion, LinearSensor};

/// Likelihood of the measurements of one drive with one landmark, and what the filter expects of it; $`P_{r,0|0} = V = W = 1`$.
struct DriveLikelihood {
    /// $`\ln Λ = \sum_i \ln N(\tilde z_i; 0, s_i)`$. [Andrade-Cetto 2005, Eqs. 10 and 11]
    log_likelihood: f64,
    /// $`E[\ln Λ] = -\frac{1}{2} \sum_i (1 + \ln 2π s_i)`$.
    expected_log_likelihood: f64,
    /// First entry of $`\sum_i H^T s_i^{-1} \tilde z_i`$. [Andrade-Cetto 2005, Eq. 12]
    gradient: f64,
    /// First entry of $`\sum_i H^T s_i^{-1} H`$. [Andrade-Cetto 2005, Eq. 14]
    information: f64,
}

/// Compares the Fisher information by its definition, the mean square of the gradient over drives, with the sum that the filter computes, and the
/// mean log-likelihood with its expectation. [Andrade-Cetto 2005, Eqs. 10–14]
///
/// # Errors
/// Returns an error if the filter refuses, which it has no reason to.
pub(crate) fn likelihood_metrics(n_drives: u64, n_steps: usize, seed: u64) -> Result<Vec<Metric>> {
    let drives: Vec<DriveLikelihood> =
        (0..n_drives).map(|k| one_drive(n_steps, &mut rng(seed, k))).collect::<Result<_>>()?;
    let sum = |of: fn(&DriveLikelihood) -> f64| drives.iter().map(of).sum::<f64>();
    let square = sum(|drive| drive.gradient * drive.gradient);
    Ok(vec![
        Metric::new("log_likelihood_mean", sum(|drive| drive.log_likelihood) / n_drives as f64, ""),
        Metric::new(
            "log_likelihood_over_expected",
            sum(|drive| drive.log_likelihood) / sum(|drive| drive.expected_log_likelihood),
            "",
        ),
        Metric::new("gradient_square_over_information", square / sum(|drive| drive.information), ""),
    ])
}

fn rng(seed: u64, drive: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(drive);
    rng
}

fn one_drive(n_steps: usize, rng: &mut ChaCha8Rng) -> Result<DriveLikelihood> {
    let mut noise = || rng.sample::<f64, _>(StandardNormal);
    let (mut robot, landmark) = (noise(), 1.0); // the filter believes that the robot is at 0 ± 1
    let distance = landmark - robot + noise();
    // The first measurement puts the landmark into the map.
    let prior = Gaussian::new(Vector2::new(0.0, distance), Matrix2::new(1.0, 1.0, 1.0, 2.0))?;
    let motion = LinearMotion::stationary(Matrix2::new(1.0, 0.0, 0.0, 0.0))?;
    let sensor = LinearSensor::new(Matrix1x2::new(-1.0, 1.0), Matrix1::new(1.0))?;
    let mut filter = KalmanFilter::new(motion, prior)?;
    let mut drive = DriveLikelihood {
        log_likelihood: 0.0,
        expected_log_likelihood: 0.0,
        gradient: 0.0,
        information: 0.0,
    };
    for _ in 0..n_steps {
        robot += noise();
        filter.predict(None)?;
        let innovation = filter.update(&sensor, &Vector1::new(landmark - robot + noise()))?;
        let variance = innovation.covariance().x;
        drive.log_likelihood += innovation.log_likelihood();
        drive.expected_log_likelihood -= 0.5 * (1.0 + (std::f64::consts::TAU * variance).ln());
        drive.gradient -= innovation.residual().x / variance;
        drive.information += 1.0 / variance;
    }
    Ok(drive)
}
