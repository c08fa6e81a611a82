use anyhow::{Result, ensure};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use wayfix_evaluation::{errors::MeanInterval, report::Metric};
use wayfix_scene_sim::{monobot::MonobotParams, random::RandomStreams};

use super::{MonobotDrive, WorldReference, drive};

/// Many drives with the same parameters and different noise.
#[derive(Clone, Debug)]
pub(crate) struct MonobotMonteCarlo {
    /// One a seed.
    pub drives: Vec<MonobotDrive>,
}

/// Runs `n_runs` drives.
///
/// # Errors
/// Returns an error if `n_runs` is below 2, a parameter is out of range or the filter fails.
pub(crate) fn monte_carlo(
    params: &MonobotParams,
    reference: WorldReference,
    n_runs: u64,
    seed: u64,
) -> Result<MonobotMonteCarlo> {
    ensure!(n_runs >= 2, "an interval needs two runs or more, not {n_runs}");
    let one = |k: u64| {
        let seed = seed.wrapping_mul(1_000_003).wrapping_add(k); // no two of a call share one
        let run = params.simulate(&mut RandomStreams::new(ChaCha8Rng::seed_from_u64(seed)))?;
        drive(params, &run, reference)
    };
    Ok(MonobotMonteCarlo { drives: (0..n_runs).map(one).collect::<Result<_>>()? })
}

impl MonobotMonteCarlo {
    /// Root mean square of the mean landmark error at the end, m.
    pub(crate) fn end_rms(&self) -> f64 {
        root_mean_square(&self.errors(|drive| drive.steps.len() - 1))
    }

    /// The figures of the paper's Figs. 4-6.
    pub(crate) fn metrics(&self) -> Vec<Metric> {
        let (first, end) = (self.errors(|_| 0), self.errors(|drive| drive.steps.len() - 1));
        let claimed: Vec<f64> =
            self.drives.iter().filter_map(|drive| Some(drive.steps.last()?.landmark_sigma)).collect();
        let bias = MeanInterval::of(&end).map_or(f64::NAN, |mean| mean.mean.abs() / mean.half_width);
        let gain = |steps: &[super::MonobotStep]| steps.last().map_or(f64::NAN, |step| step.gains[1]);
        let gains: Vec<f64> = self.drives.iter().map(|drive| gain(&drive.steps)).collect();
        let rank = |drive: &MonobotDrive| {
            (drive.observability.rank() as f64, drive.observability.dimension() as f64)
        };
        let (rank, dimension) = self.drives.first().map_or((f64::NAN, f64::NAN), rank);
        vec![
            Metric::new("landmark_error_rms_at_start_m", root_mean_square(&first), "m"),
            Metric::new("landmark_error_rms_at_end_m", root_mean_square(&end), "m"),
            Metric::new("estimated_landmark_sigma_at_end_m", root_mean_square(&claimed), "m"),
            Metric::new("slope_of_end_error_on_start_error", slope(&first, &end), ""),
            Metric::new("end_landmark_bias_over_ci95_half_width", bias, ""),
            Metric::new("landmark_kalman_gain_at_end", root_mean_square(&gains), ""),
            Metric::new("fisher_information_rank", rank, ""),
            Metric::new("state_dimension", dimension, ""),
        ]
    }

    fn errors(&self, at: impl Fn(&MonobotDrive) -> usize) -> Vec<f64> {
        self.drives.iter().map(|drive| drive.steps[at(drive)].mean_landmark_error).collect()
    }
}

fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// Slope of the best line through the origin: 1 if the last error equals the first, 0 if they are unrelated.
fn slope(first: &[f64], end: &[f64]) -> f64 {
    let products: f64 = first.iter().zip(end).map(|(first, end)| first * end).sum();
    products / first.iter().map(|first| first * first).sum::<f64>()
}
