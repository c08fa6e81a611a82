use anyhow::Result;
use rand::Rng;
use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
use wayfix_scene_sim::drive::WheeledRobotParams;
use wayfix_scene_sim::indoors::{Building, IndoorDriveParams, calibrated_robot};
use wayfix_scene_sim::random::RandomStreams;

use super::SimulatedDrive;

/// Purpose of a random draw; each has its own generator, so that more draws of one do not change the others.
#[derive(Clone, Copy, Debug)]
pub(super) enum Draw {
    /// The building.
    World,
    /// The rearrangement before each visit.
    Rearranged(u64),
    /// The wheels of the robot.
    Robot,
    /// A visit: its route, the people, the light.
    Visit(u64),
}

impl Draw {
    /// The generator of one seed.
    pub(super) fn rng(self, seed: u64) -> ChaCha8Rng {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(match self {
            Self::World => 1 << 40,
            Self::Robot => 2 << 40,
            Self::Rearranged(visit) => (3 << 40) + visit,
            Self::Visit(visit) => (4 << 40) + visit,
        });
        rng
    }

    /// The streams of a visit, beside the generator of its route.
    pub(super) fn streams(self, seed: u64) -> RandomStreams {
        RandomStreams::new(ChaCha8Rng::seed_from_u64(self.rng(seed).next_u64()))
    }
}

/// The robot of a seed.
pub(super) fn robot(seed: u64) -> WheeledRobotParams {
    calibrated_robot(&mut Draw::Robot.rng(seed))
}

/// A random tour on one visit, from where the robot is charged.
pub(super) fn tour(
    building: &Building,
    length_m: f64,
    params: IndoorDriveParams,
    (seed, visit): (u64, u64),
) -> Result<SimulatedDrive> {
    let route = building.aisles().tour(length_m, &mut Draw::Visit(visit).rng(seed))?;
    SimulatedDrive::drive(building, route, params, Draw::Visit(visit).streams(seed))
}
