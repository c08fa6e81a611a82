//! A robot that stands still at the origin and looks, time after time.

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_estimation_traits::Pose2;
use wayfix_scene_sim::Scenario;
use wayfix_scene_sim::random::RandomStreams;
use wayfix_scene_sim::sensor::{RangeBearingDetector, RangeBearingParams, SimulatedSensor, TrueState};
use wayfix_scene_sim::world::{FloorPlan, PlanarWorld};
use wayfix_sensor_log::{Detection, Record, RecordData, TrueLandmark};

pub(crate) fn streams(seed: u64) -> RandomStreams {
    RandomStreams::new(ChaCha8Rng::seed_from_u64(seed))
}

pub(crate) fn run(name: &str, seed: u64) -> Vec<Record> {
    let scenario = Scenario::named(name).expect("a known name");
    scenario.simulate(ChaCha8Rng::seed_from_u64(seed)).expect("valid parameters")
}

pub(crate) fn world(landmarks: &[(f64, f64)]) -> PlanarWorld {
    let numbered = landmarks.iter().zip(0..).map(|(&(x, y), id)| TrueLandmark { id, x, y });
    PlanarWorld::new(FloorPlan { landmarks: numbered.collect(), walls: vec![] })
}

/// What the log gets from each of `n_looks` looks; `None` for a look that was lost.
pub(crate) fn looks(
    params: RangeBearingParams,
    world: &PlanarWorld,
    n_looks: u64,
    streams: &mut RandomStreams,
) -> Vec<Option<Vec<Detection>>> {
    let mut sensor = RangeBearingDetector::new(params).expect("valid parameters");
    (0..n_looks)
        .map(|k| {
            let moment = TrueState {
                milliseconds: k * u64::from(params.period_ms),
                pose: Pose2::new(0.0, 0.0, 0.0),
                wheel_angles: [0.0; 2],
                world,
            };
            let reading = sensor.sense(&moment, streams)?;
            let RecordData::Detections(detections) = reading.data else {
                unreachable!("the sensor only makes detections")
            };
            Some(detections)
        })
        .collect()
}

/// All detections of all looks.
pub(crate) fn detections(
    params: RangeBearingParams,
    world: &PlanarWorld,
    n_looks: u64,
    seed: u64,
) -> Vec<Detection> {
    looks(params, world, n_looks, &mut streams(seed)).into_iter().flatten().flatten().collect()
}

pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

pub(crate) fn deviation(values: &[f64]) -> f64 {
    let centre = mean(values);
    mean(&values.iter().map(|v| (v - centre) * (v - centre)).collect::<Vec<_>>()).sqrt()
}

/// `got` within `n_sigma` standard errors of `wanted`.
#[track_caller]
pub(crate) fn assert_near(what: &str, got: f64, wanted: f64, standard_error: f64) {
    const N_SIGMA: f64 = 4.0;
    let off = (got - wanted).abs();
    assert!(
        off <= N_SIGMA * standard_error,
        "{what}: {got}, wanted {wanted}, off by {:.1} standard errors",
        off / standard_error
    );
}

/// A share measured on `n` trials against the one asked for (binomial standard error).
#[track_caller]
pub(crate) fn assert_share(what: &str, hits: usize, n: usize, share: f64) {
    assert_near(what, hits as f64 / n as f64, share, (share * (1.0 - share) / n as f64).sqrt());
}
