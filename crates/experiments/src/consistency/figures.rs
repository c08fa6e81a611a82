use anyhow::{Result, ensure};
use wayfix_evaluation::report::Metric;
use wayfix_gaussian_core::ChiSquaredBand;
use wayfix_sensor_log::Record;

use super::{ComparedFilter, ConsistencySample, CorridorLaps, drive};

/// Results of one filter over all logs, scan by scan.
#[derive(Clone, Debug, PartialEq)]
pub struct FilterMonteCarloResults {
    /// Which filter.
    pub kind: ComparedFilter,
    /// Averages over the logs: of NEES and heading deviation the mean, of the position error the root mean square.
    pub samples: Vec<ConsistencySample>,
}

/// All filters over the same logs.
#[derive(Clone, Debug, PartialEq)]
pub struct ConsistencyMonteCarlo {
    /// One a filter, in the order of [`ComparedFilter::ALL`].
    pub courses: Vec<FilterMonteCarloResults>,
    /// 95 % band of the average NEES of a consistent filter at any one scan.
    pub band: ChiSquaredBand,
    /// 95 % band for all samples at once, for any correlation in time.
    pub whole_run_band: ChiSquaredBand,
    /// Number of logs.
    pub n_runs: u32,
}

/// Degrees of freedom of a pose in the plane.
const POSE: usize = 3;

/// Runs the filters over `n_runs` logs that differ in everything that is drawn.
///
/// ```
/// use wayfix_experiments::consistency::{CorridorLaps, monte_carlo};
/// let laps = CorridorLaps { length_m: 20.0, width_m: 10.0, n_laps: 1, ..CorridorLaps::default() };
/// let all = monte_carlo(&laps, 2, 1)?;
/// assert_eq!(all.courses.len(), 4);
/// assert!(all.whole_run_band.low < all.band.low && all.band.high < all.whole_run_band.high);
/// assert!(monte_carlo(&laps, 0, 1).is_err());
/// # Ok::<(), anyhow::Error>(())
/// ```
///
/// # Errors
/// Returns an error if `n_runs` is 0, a parameter is out of range, the robot never moves or a filter fails.
pub fn monte_carlo(laps: &CorridorLaps, n_runs: u32, seed: u64) -> Result<ConsistencyMonteCarlo> {
    // No two of a call share a seed.
    over_logs(laps, n_runs, |k| laps.simulate(seed.wrapping_mul(1_000_003).wrapping_add(u64::from(k))))
}

/// Runs the filters with the noise of `laps` over `n_runs` logs; `log` gives the k-th.
///
/// # Errors
/// Returns an error if `n_runs` is 0, `log` fails, the robot never moves or a filter fails.
pub(crate) fn over_logs(
    laps: &CorridorLaps,
    n_runs: u32,
    log: impl Fn(u32) -> Result<Vec<Record>>,
) -> Result<ConsistencyMonteCarlo> {
    ensure!(n_runs >= 1, "an average needs a run");
    let mut runs: [Vec<Vec<ConsistencySample>>; 4] = Default::default();
    for k in 0..n_runs {
        let records = log(k)?;
        for (runs, kind) in runs.iter_mut().zip(ComparedFilter::ALL) {
            runs.push(drive(laps, &records, kind)?);
        }
    }
    let courses: Vec<FilterMonteCarloResults> = runs
        .iter()
        .zip(ComparedFilter::ALL)
        .map(|(runs, kind)| FilterMonteCarloResults { kind, samples: average(runs) })
        .collect();
    let n_samples = courses.iter().map(|course| course.samples.len()).min().unwrap_or(0);
    ensure!(n_samples > 0, "the robot never moved");
    let band = |probability| ChiSquaredBand::for_average(POSE, n_runs as usize, probability);
    Ok(ConsistencyMonteCarlo {
        courses,
        band: band(0.95)?,
        whole_run_band: band(1.0 - 0.05 / n_samples as f64)?, // Bonferroni
        n_runs,
    })
}

impl ConsistencyMonteCarlo {
    /// The figures of all filters, their names before them.
    ///
    /// `nees_outside_band_share` is of samples outside the pointwise band, `n_samples_nees_outside_whole_run_band` of samples outside the one for the whole run.
    pub fn metrics(&self) -> Vec<Metric> {
        let mut metrics = vec![
            Metric::new("n_runs", f64::from(self.n_runs), ""),
            Metric::new("heading_sigma_before_loop_closure_rad", self.heading_sigma_at_closure(), "rad"),
        ];
        for course in &self.courses {
            let name = |figure: &str| format!("{}_{figure}", course.kind.name());
            metrics.push(Metric::new(name("nees_mean"), course.mean(|sample| sample.nees), ""));
            metrics.push(Metric::new(name("nees_outside_band_share"), course.share_outside(&self.band), ""));
            let n_outside = course.share_outside(&self.whole_run_band) * course.samples.len() as f64;
            metrics.push(Metric::new(name("n_samples_nees_outside_whole_run_band"), n_outside.round(), ""));
            let rmse = course.mean(|sample| sample.position_error.powi(2)).sqrt();
            metrics.push(Metric::new(name("position_rmse_m"), rmse, "m"));
        }
        metrics
    }

    /// The heading σ is largest just before the first loop closure; this is the average that the filter states there.
    fn heading_sigma_at_closure(&self) -> f64 {
        let invariant = self.courses.iter().filter(|course| course.kind == ComparedFilter::Invariant);
        invariant.flat_map(|course| &course.samples).map(|sample| sample.heading_sigma).fold(0.0, f64::max)
    }
}

impl FilterMonteCarloResults {
    fn mean(&self, value: impl Fn(&ConsistencySample) -> f64) -> f64 {
        self.samples.iter().map(value).sum::<f64>() / self.samples.len() as f64
    }

    /// Share of the samples at which the average NEES is outside a band.
    pub fn share_outside(&self, band: &ChiSquaredBand) -> f64 {
        self.mean(|sample| f64::from(u8::from(!band.contains(sample.nees))))
    }
}

/// Averages over runs, scan by scan, up to the shortest run.
fn average(runs: &[Vec<ConsistencySample>]) -> Vec<ConsistencySample> {
    let n_samples = runs.iter().map(Vec::len).min().unwrap_or(0);
    let at = |k: usize| {
        let mean = |value: fn(&ConsistencySample) -> f64| {
            runs.iter().map(|samples| value(&samples[k])).sum::<f64>() / runs.len() as f64
        };
        ConsistencySample {
            seconds: mean(|sample| sample.seconds),
            nees: mean(|sample| sample.nees),
            position_error: mean(|sample| sample.position_error.powi(2)).sqrt(),
            heading_sigma: mean(|sample| sample.heading_sigma),
        }
    };
    (0..n_samples).map(at).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn averages_are_per_scan_and_end_with_the_shortest_run() {
        let sample = |nees, position_error| ConsistencySample {
            seconds: 1.0,
            nees,
            position_error,
            heading_sigma: 0.1,
        };
        let runs = [vec![sample(1.0, 3.0), sample(5.0, 1.0)], vec![sample(3.0, 4.0)]];
        let averages = average(&runs);
        assert_eq!(averages.len(), 1);
        assert_eq!((averages[0].nees, averages[0].position_error), (2.0, 12.5_f64.sqrt()));
        let course = FilterMonteCarloResults {
            kind: ComparedFilter::Standard,
            samples: vec![sample(1.0, 0.0), sample(f64::NAN, 0.0)],
        };
        assert_eq!(course.share_outside(&ChiSquaredBand { low: 0.0, high: 2.0 }), 0.5);
    }
}
