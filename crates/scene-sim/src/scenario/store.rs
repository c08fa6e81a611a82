use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use wayfix_sensor_log::{EncodedImage, Record, RecordData, Stamp};

use super::{Scenario, ScenarioParams};
use crate::SimulationError;
use crate::indoors::{
    IndoorDrive, IndoorDriveParams, IndoorDriveStep, RetailStore, RetailStoreParams, calibrated_robot,
};
use crate::random::RandomStreams;

/// Stamp of the start, nanoseconds, as in [`Simulation`](crate::Simulation).
const START_NS: u64 = 1_600_000_000_000_000_000;

/// Laps around the shelves of a store with an omnidirectional camera.
#[derive(Clone, Debug, PartialEq)]
pub struct RetailStoreLapsParams {
    /// The store.
    pub store: RetailStoreParams,
    /// Seed of the store and of its robot's errors.
    pub store_seed: u64,
    /// Laps around everything.
    pub n_laps: usize,
    /// The drive; its robot is drawn from the seed.
    pub drive: IndoorDriveParams,
    /// Quality of the pictures in the log, 1 to 100.
    pub jpeg_quality: u8,
}

/// Those with views of a store.
pub(super) fn all() -> Vec<Scenario> {
    let params = RetailStoreLapsParams {
        store: RetailStoreParams::area(),
        store_seed: 31,
        n_laps: 2,
        drive: IndoorDriveParams { n_people: 1, ..IndoorDriveParams::default() },
        jpeg_quality: 92,
    };
    vec![Scenario { name: "store_area", seed: 31, params: ScenarioParams::StoreLaps(Box::new(params)) }]
}

impl RetailStoreLapsParams {
    /// The log in time order: before each view but the first an odometry increment, then true pose and view at its stamp.
    ///
    /// # Errors
    /// Returns [`SimulationError::Parameter`] or [`SimulationError::TooMany`] if a parameter is out of range.
    pub fn simulate(&self, streams: RandomStreams) -> Result<Vec<Record>, SimulationError> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.store_seed);
        let building = RetailStore::draw(self.store, &mut rng)?.building();
        let params = IndoorDriveParams { robot: calibrated_robot(&mut rng), ..self.drive };
        let route = building.aisles().laps(self.n_laps, &mut rng)?;
        let mut records = Vec::new();
        for step in IndoorDrive::new(&building, route, params, streams)? {
            records.extend(self.records(&step)?);
        }
        Ok(records)
    }

    fn records(&self, step: &IndoorDriveStep) -> Result<Vec<Record>, SimulationError> {
        let (width, height) = (step.view.width as u32, step.view.height as u32);
        let image = EncodedImage::jpeg(width, height, &step.view.rgb, self.jpeg_quality)?;
        let odometry = step.odometry.map(RecordData::OdometryIncrement);
        let stamp = Stamp::from_nanoseconds(START_NS + step.milliseconds * 1_000_000);
        let at_once = [RecordData::TruePose(step.pose), RecordData::Image(image)];
        Ok(odometry.into_iter().chain(at_once).map(|data| Record { stamp, data }).collect())
    }
}
