//! A world and a sensor of one's own, driven by the simulation as it is: a beacon that walks, and a receiver that hears how far
//! away it is and knows no bearing better than left or right.
//! `cargo run -p wayfix-scene-sim --example 02_custom_sensor`

use std::f64::consts::{FRAC_PI_2, PI};

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_estimation_traits::nalgebra::Vector2;
use wayfix_scene_sim::random::{RandomStreamPurpose, RandomStreams, deviate};
use wayfix_scene_sim::route::CircleRoute;
use wayfix_scene_sim::sensor::{SensorReading, SimulatedSensor, TrueState};
use wayfix_scene_sim::world::SensorWorld;
use wayfix_scene_sim::{Simulation, SimulationError, plane};
use wayfix_sensor_log::{Detection, DetectionTarget, RecordData, TrueLandmark};

/// A beacon that circles the origin once a minute.
struct WalkingBeacon;

impl SensorWorld for WalkingBeacon {
    fn landmarks(&self) -> Vec<TrueLandmark> {
        Vec::new()
    }

    fn targets(&self, seconds: f64) -> Vec<(DetectionTarget, Vector2<f64>)> {
        vec![(DetectionTarget::UnknownCode(1), plane::direction(PI * seconds / 30.0) * 8.0)]
    }
}

/// Hears distance with 0.5 m of noise, once a second.
struct Receiver;

impl SimulatedSensor for Receiver {
    fn period_ms(&self) -> u32 {
        1000
    }

    fn sense(&mut self, moment: &TrueState<'_>, streams: &mut RandomStreams) -> Option<SensorReading> {
        let hear = |(target, point): (DetectionTarget, Vector2<f64>)| {
            let (range, bearing) = plane::range_and_bearing(&moment.pose, &point);
            let noise = 0.5 * deviate::normal(streams.of(RandomStreamPurpose::Other(0)));
            Detection { target, range: range + noise, bearing: FRAC_PI_2.copysign(bearing) }
        };
        let heard = moment.world.targets(moment.seconds()).into_iter().map(hear).collect();
        Some(SensorReading { data: RecordData::Detections(heard), stamp_offset_ms: 0 })
    }
}

fn main() -> Result<(), SimulationError> {
    let simulation = Simulation::new(&WalkingBeacon, CircleRoute { radius_m: 3.0 }.route()?);
    let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(1));
    let records = simulation.run(&mut [Box::new(Receiver)], &mut streams)?;
    let heard: Vec<&Detection> = records
        .iter()
        .filter_map(|record| match &record.data {
            RecordData::Detections(detections) => detections.first(),
            _ => None,
        })
        .collect();
    assert_eq!(heard.len(), 61, "one look a second, from the start to the end");
    assert!(
        heard.iter().all(|s| s.range > 2.0 && s.range < 14.0),
        "between 8 − 3 and 8 + 3 m, give or take 6σ"
    );
    println!("heard the beacon {} times, first at {:.2} m", heard.len(), heard[0].range);
    Ok(())
}
