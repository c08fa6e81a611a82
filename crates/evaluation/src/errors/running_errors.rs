use super::PoseWithTruth;
use crate::report::Metric;

/// Errors of estimates that come one by one, so that none need be kept.
#[derive(Clone, Copy, Debug, Default)]
pub struct RunningErrors {
    n: usize,
    position: f64,
    position_max: f64,
    position_squared: f64,
    heading: f64,
    nees: (f64, usize),
}

impl RunningErrors {
    /// Adds an estimate.
    pub fn add(&mut self, sample: &PoseWithTruth) {
        let position = sample.position_error();
        self.n += 1;
        self.position += position;
        self.position_max = self.position_max.max(position);
        self.position_squared += (sample.estimate.translation - sample.truth.translation).norm_squared();
        self.heading += sample.heading_error();
        if let Some(nees) = sample.nees() {
            self.nees = (self.nees.0 + nees, self.nees.1 + 1);
        }
    }

    /// Number of estimates.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Means, maximum, root mean square and NEES; none without an estimate.
    pub fn metrics(&self) -> Vec<Metric> {
        if self.n == 0 {
            return Vec::new();
        }
        let n = self.n as f64;
        let mut metrics = vec![
            Metric::new("position_mean_m", self.position / n, "m"),
            Metric::new("position_error_max_m", self.position_max, "m"),
            Metric::new("heading_mean_deg", (self.heading / n).to_degrees(), "°"),
            Metric::new("ate_rmse_m", (self.position_squared / n).sqrt(), "m"),
        ];
        let (nees, n) = self.nees;
        metrics.extend((n > 0).then(|| Metric::new("nees_mean", nees / n as f64, "")));
        metrics
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;
    use wayfix_estimation_traits::Pose2;

    use super::*;
    use crate::errors::trajectory_errors;

    #[test]
    fn running_errors_are_those_of_all_estimates_bit_for_bit() {
        let sample = |number: usize| {
            let t = 0.01 * number as f64;
            PoseWithTruth {
                estimate: Pose2::new(t.sin(), t.cos(), t),
                covariance: if number == 7 { Matrix3::zeros() } else { Matrix3::identity() * 0.1 },
                truth: Pose2::new(t.sin() + 0.1 * t.cos(), t.cos() - 0.2, t + 0.1 * t.sin()),
            }
        };
        let all: Vec<PoseWithTruth> = (0..100_000).map(sample).collect();
        let mut running = RunningErrors::default();
        assert!(running.metrics().is_empty());
        all.iter().for_each(|sample| running.add(sample));
        let values: Vec<f64> = running.metrics().iter().map(|metric| metric.value).collect();
        let (of_all, n) = (trajectory_errors(&all).unwrap(), all.len() as f64);
        let positions = || all.iter().map(PoseWithTruth::position_error);
        let heading = all.iter().map(PoseWithTruth::heading_error).sum::<f64>() / n;
        let expected = [
            positions().sum::<f64>() / n,
            positions().fold(0.0, f64::max),
            heading.to_degrees(),
            of_all.ate_rmse,
            of_all.nees_mean.unwrap(),
        ];
        assert_eq!(values, expected);
    }
}
