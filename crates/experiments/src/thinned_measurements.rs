use nalgebra::{Matrix3, Vector2, Vector3};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use serde::Deserialize;
use wayfix_estimation_traits::Pose2;
use wayfix_sensor_log::{MeasuredQuantity, PoseMeasurement, Record, RecordData, Stamp, topics};
use wayfix_slam_ekf::ExternalParams;

/// Poses of a log as measurements of an external sensor: positions, headings or, with both sigmas, poses. [Andrade-Cetto 2005, Eqs. 26–27]
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ThinnedMeasurements {
    /// Standard deviation of a position along each axis, m.
    pub(crate) sigma_m: Option<f64>,
    /// Standard deviation of a heading, degrees. Fixes of a receiver have none.
    pub(crate) heading_sigma_deg: Option<f64>,
    /// Seconds between two measurements; without it none is used, and the noise is only that of the truth.
    pub(crate) every_s: Option<f64>,
}

impl ThinnedMeasurements {
    /// Parameters of a filter that takes the measurements.
    pub(crate) fn params(&self) -> ExternalParams {
        ExternalParams {
            map_frame_ids: self.every_s.iter().map(|_| topics::WORLD_FRAME.to_owned()).collect(),
            position_sigma: self.sigma_m,
            heading_sigma: self.heading_sigma_deg.map(f64::to_radians),
            ..ExternalParams::default()
        }
    }

    /// The records with measurements. A fix of a receiver becomes one and is no truth any more; a true pose stays, and its measurement gets an error.
    pub(crate) fn in_log(&self, records: Vec<Record>, seed: u64) -> Vec<Record> {
        let Some(every) = self.every_s else { return records };
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut last = records.first().map_or(Stamp::default(), |record| record.stamp);
        let mut with_measurements = Vec::with_capacity(records.len());
        for record in records {
            let stamp = record.stamp;
            let is_due = stamp.seconds_since(last) >= every;
            match &record.data {
                RecordData::TruePosition(fix) if is_due && self.sigma_m.is_some() => {
                    last = stamp;
                    let position = MeasuredQuantity::Position(Vector2::new(fix.x, fix.y));
                    with_measurements.push(self.measurement(stamp, position));
                }
                RecordData::TruePose(pose) if is_due => {
                    last = stamp;
                    let measured = self.measured(pose, &mut rng);
                    with_measurements.push(record);
                    with_measurements.extend(measured.map(|quantity| self.measurement(stamp, quantity)));
                }
                _ => with_measurements.push(record),
            }
        }
        with_measurements
    }

    /// A true pose with an error in what has a sigma.
    fn measured(&self, pose: &Pose2<f64>, rng: &mut ChaCha8Rng) -> Option<MeasuredQuantity> {
        let mut error = |sigma: f64| {
            let unit: f64 = StandardNormal.sample(rng);
            sigma * unit
        };
        let position = self.sigma_m.map(|sigma| pose.translation + Vector2::from_fn(|_, _| error(sigma)));
        let heading = self.heading_sigma_deg.map(|sigma| pose.heading() + error(sigma.to_radians()));
        match (position, heading) {
            (Some(at), Some(heading)) => Some(MeasuredQuantity::Pose(Pose2::new(at.x, at.y, heading))),
            (Some(at), None) => Some(MeasuredQuantity::Position(at)),
            (None, Some(heading)) => Some(MeasuredQuantity::Heading(heading)),
            (None, None) => None,
        }
    }

    fn measurement(&self, stamp: Stamp, quantity: MeasuredQuantity) -> Record {
        let variance = |sigma: Option<f64>| sigma.map_or(0.0, |sigma| sigma * sigma);
        let (position, heading) =
            (variance(self.sigma_m), variance(self.heading_sigma_deg.map(f64::to_radians)));
        let data = RecordData::PoseMeasurement(PoseMeasurement {
            frame: topics::WORLD_FRAME.to_owned(),
            quantity,
            covariance: Some(Matrix3::from_diagonal(&Vector3::new(position, position, heading))),
        });
        Record { stamp, data }
    }
}

#[cfg(test)]
mod tests {
    use approx::abs_diff_eq;
    use wayfix_estimation_traits::LieGroup;
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
        let positions =
            ThinnedMeasurements { sigma_m: Some(2.0), heading_sigma_deg: None, every_s: Some(60.0) };
        let records = positions.in_log(fixes.clone(), 1);
        let measured = |record: &&Record| matches!(record.data, RecordData::PoseMeasurement(_));
        let seconds: Vec<f64> =
            records.iter().filter(measured).map(|record| record.stamp.seconds().round()).collect();
        assert_eq!((seconds, records.len()), (vec![60.0, 120.0, 180.0], 201));
        let off = ThinnedMeasurements { every_s: None, ..positions };
        assert_eq!(off.in_log(fixes.clone(), 1), fixes);
        assert!(positions.params().is_on() && !off.params().is_on());
    }

    #[test]
    fn simulated_truth_stays_and_its_measurement_errs() {
        let truth: Vec<Record> =
            (0..2000).map(|second| at(second, RecordData::TruePose(Pose2::new(0.0, 0.0, 0.0)))).collect();
        let positions =
            ThinnedMeasurements { sigma_m: Some(2.0), heading_sigma_deg: None, every_s: Some(1.0) };
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

    #[test]
    fn what_has_a_sigma_is_measured() {
        let truth = vec![
            at(0, RecordData::TruePose(Pose2::identity())),
            at(1, RecordData::TruePose(Pose2::new(1.0, 2.0, 0.5))),
        ];
        let measured = |sigma_m, heading_sigma_deg| {
            let measurements = ThinnedMeasurements { sigma_m, heading_sigma_deg, every_s: Some(1.0) };
            let records = measurements.in_log(truth.clone(), 1);
            records.into_iter().find_map(|record| match record.data {
                RecordData::PoseMeasurement(measured) => Some(measured),
                _ => None,
            })
        };
        let quantity = |sigma_m, heading_sigma_deg| Some(measured(sigma_m, heading_sigma_deg)?.quantity);
        let covariance = measured(Some(0.1), Some(180.0)).and_then(|measured| measured.covariance).unwrap();
        let expected = Vector3::new(0.1 * 0.1, 0.1 * 0.1, std::f64::consts::PI.powi(2));
        assert!(abs_diff_eq!(covariance, Matrix3::from_diagonal(&expected), epsilon = 1e-12), "{covariance}");
        assert!(matches!(quantity(Some(0.1), None), Some(MeasuredQuantity::Position(_))));
        assert!(matches!(quantity(None, Some(1.0)), Some(MeasuredQuantity::Heading(_))));
        assert!(matches!(quantity(Some(0.1), Some(1.0)), Some(MeasuredQuantity::Pose(_))));
        assert_eq!(quantity(None, None), None);
    }
}
