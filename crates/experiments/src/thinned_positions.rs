use nalgebra::{Matrix3, Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::Deserialize;
use wayfix_sensor_log::{MeasuredQuantity, PoseMeasurement, Record, RecordData, Stamp, topics};
use wayfix_slam_ekf::ExternalParams;

/// Positions of a log as measurements of an external sensor. [Andrade-Cetto 2005, Eqs. 26–27]
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ThinnedPositions {
    /// Standard deviation of a position along each axis, m.
    pub(crate) sigma_m: f64,
    /// Seconds between two measurements; without it none is used, and the noise is only that of the truth.
    pub(crate) every_s: Option<f64>,
}

impl ThinnedPositions {
    /// Parameters of a filter that takes the measurements.
    pub(crate) fn params(&self) -> ExternalParams {
        ExternalParams {
            frames: self.every_s.iter().map(|_| topics::WORLD_FRAME.to_owned()).collect(),
            position_sigma: Some(self.sigma_m),
            ..ExternalParams::default()
        }
    }

    /// The records with measurements. A fix of a receiver becomes one and is no truth any more; a true pose stays, and the measurement of its position
    /// gets an error.
    pub(crate) fn in_log(&self, records: Vec<Record>, seed: u64) -> Vec<Record> {
        let Some(every) = self.every_s else { return records };
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut last = records.first().map_or(Stamp::default(), |record| record.stamp);
        let mut with_measurements = Vec::with_capacity(records.len());
        for record in records {
            let stamp = record.stamp;
            let is_due = stamp.seconds_since(last) >= every;
            match &record.data {
                RecordData::TruePosition(fix) if is_due => {
                    last = stamp;
                    with_measurements.push(self.measurement(stamp, Vector2::new(fix.x, fix.y)));
                }
                RecordData::TruePose(pose) if is_due => {
                    last = stamp;
                    let error = Vector2::from_fn(|_, _| {
                        let unit: f64 = StandardNormal.sample(&mut rng);
                        self.sigma_m * unit
                    });
                    let measured = self.measurement(stamp, pose.translation + error);
                    with_measurements.extend([record, measured]);
                }
                _ => with_measurements.push(record),
            }
        }
        with_measurements
    }

    fn measurement(&self, stamp: Stamp, position: Vector2<f64>) -> Record {
        let variance = self.sigma_m * self.sigma_m;
        let data = RecordData::PoseMeasurement(PoseMeasurement {
            frame: topics::WORLD_FRAME.to_owned(),
            quantity: MeasuredQuantity::Position(position),
            covariance: Some(Matrix3::from_diagonal(&Vector3::new(variance, variance, 0.0))),
        });
        Record { stamp, data }
    }
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use wayfix_estimation_traits::Pose2;
    use wayfix_sensor_log::TruePosition;

    use super::*;

    fn at(seconds: u64, data: RecordData) -> Record {
        Record { stamp: Stamp::from_nanoseconds(seconds * 1_000_000_000), data }
    }

    #[test]
    fn one_fix_in_a_minute_is_measured_and_the_rest_is_truth() {
        let fixes: Vec<Record> = (0..=200)
            .map(|second| at(second, RecordData::TruePosition(TruePosition { x: second as f64, y: 0.0 })))
            .collect();
        let positions = ThinnedPositions { sigma_m: 2.0, every_s: Some(60.0) };
        let records = positions.in_log(fixes.clone(), 1);
        let measured = |record: &&Record| matches!(record.data, RecordData::PoseMeasurement(_));
        let seconds: Vec<f64> =
            records.iter().filter(measured).map(|record| record.stamp.seconds().round()).collect();
        assert_eq!((seconds, records.len()), (vec![60.0, 120.0, 180.0], 201));
        let off = ThinnedPositions { every_s: None, ..positions };
        assert_eq!(off.in_log(fixes.clone(), 1), fixes);
        assert!(positions.params().is_on() && !off.params().is_on());
    }

    #[test]
    fn simulated_truth_stays_and_its_measurement_errs() {
        let truth: Vec<Record> =
            (0..2000).map(|second| at(second, RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0)))).collect();
        let positions = ThinnedPositions { sigma_m: 2.0, every_s: Some(1.0) };
        let records = positions.in_log(truth.clone(), 1);
        let errors: Vec<f64> = records
            .iter()
            .filter_map(|record| match &record.data {
                RecordData::PoseMeasurement(PoseMeasurement {
                    quantity: MeasuredQuantity::Position(position),
                    ..
                }) => Some(position.x),
                _ => None,
            })
            .collect();
        assert_eq!((errors.len(), records.len()), (1999, 3999));
        let variance = errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64;
        // Six standard deviations of the variance of 1999 samples.
        assert!(abs_diff_eq!(variance / 4.0, 1.0, epsilon = 6.0 * (2.0 / 1999.0_f64).sqrt()), "{variance}");
    }
}
