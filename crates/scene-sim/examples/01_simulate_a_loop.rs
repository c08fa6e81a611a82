//! Simulates a named scenario and prints the first rows of its log: `cargo run --example 01_simulate_a_loop [NAME]`.

use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_scene_sim::{Scenario, SimulationError};
use wayfix_sensor_log::{Record, RecordData};

fn main() -> Result<(), SimulationError> {
    let name = std::env::args().nth(1).unwrap_or_else(|| "loop_known".to_owned());
    let scenario = Scenario::named(&name)?;
    let records = scenario.simulate(ChaCha8Rng::seed_from_u64(scenario.seed))?;
    println!("{name}: {} records", records.len());
    let is_landmark = |record: &&Record| matches!(record.data, RecordData::TrueLandmark(_));
    for record in records.iter().skip_while(is_landmark).take(12) {
        println!("{}  {:?}", record.stamp, record.data);
    }
    Ok(())
}
