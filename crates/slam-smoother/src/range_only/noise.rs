use nalgebra::{Matrix1, Matrix3, Vector3};
use wayfix_estimation_traits::Pose2;

use super::batch::RangeGraph;
use crate::SlamSmootherError;

/// Standard deviations of odometry and ranges.
///
/// Odometry is a random walk: variances grow with the distance driven, as in the motion models of EKF-SLAM.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeOnlyNoise {
    /// Along and across the motion, m/√m.
    pub translation_per_sqrt_meter: f64,
    /// Heading, rad/√m.
    pub heading_per_sqrt_meter: f64,
    /// Of a range, m: the scale of its heavy-tailed distribution, somewhat below the standard deviation where there are no outliers.
    pub range: f64,
}

/// Distance that every motion counts at least, m: a robot at rest may still shake.
const SHORTEST_MOTION: f64 = 1e-3;

impl RangeOnlyNoise {
    pub(super) fn motion_information(&self, motion: &Pose2<f64>) -> Matrix3<f64> {
        let distance = motion.translation.norm().max(SHORTEST_MOTION);
        let translation = 1.0 / (self.translation_per_sqrt_meter.powi(2) * distance);
        let heading = 1.0 / (self.heading_per_sqrt_meter.powi(2) * distance);
        Matrix3::from_diagonal(&Vector3::new(translation, translation, heading))
    }

    pub(super) fn range_information(&self) -> Matrix1<f64> {
        Matrix1::new(self.range.powi(-2))
    }

    fn scaled(&self, coordinate: usize, factor: f64) -> Self {
        let mut scaled = *self;
        match coordinate {
            0 => scaled.translation_per_sqrt_meter *= factor,
            1 => scaled.heading_per_sqrt_meter *= factor,
            _ => scaled.range *= factor,
        }
        scaled
    }
}

const N_COORDINATES: usize = 3;
/// The first factor that is tried.
const FIRST_FACTOR: f64 = 4.0;
/// The search ends below this factor: closer than that, the likelihood of some thousand measurements hardly changes.
const LAST_FACTOR: f64 = 1.1;
/// Smaller changes of $`-2 \ln p`$ are no reason to go on, towards zero for instance: one standard deviation of a parameter changes it by 1.
const LEAST_CHANGE: f64 = 0.1;
/// Likelihoods that are computed at most.
const MAX_EVALUATIONS: usize = 120;

/// The noise under which the measurements are most likely, starting from that of the graph; the graph ends at its minimum with this noise.
///
/// Maximizes the Laplace approximation $`-2 \ln p(z) ≈ χ^2 + \ln \det H - \sum \ln \det Ω_i`$ by a compass search in logarithms. [MacKay 2003, chapter 27]
pub(super) fn maximize_likelihood(graph: &mut RangeGraph) -> Result<(), SlamSmootherError> {
    let (mut best, mut n_evaluations) = (graph.negative_log_likelihood()?, 1);
    let mut factor = FIRST_FACTOR;
    while factor > LAST_FACTOR && n_evaluations < MAX_EVALUATIONS {
        let mut is_better = false;
        for coordinate in 0..N_COORDINATES {
            for candidate in [factor, 1.0 / factor] {
                let before = *graph.noise();
                graph.set_noise(before.scaled(coordinate, candidate))?;
                let value = graph.negative_log_likelihood().unwrap_or(f64::INFINITY);
                n_evaluations += 1;
                if value < best - LEAST_CHANGE {
                    (best, is_better) = (value, true);
                    break;
                }
                graph.set_noise(before)?;
            }
        }
        if !is_better {
            factor = factor.sqrt();
        }
    }
    graph.optimize()?;
    Ok(())
}
