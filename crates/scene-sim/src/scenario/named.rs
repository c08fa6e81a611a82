use rand_chacha::ChaCha8Rng;
use wayfix_sensor_log::{Record, Stamp};

#[cfg(feature = "league")]
use super::league;
#[cfg(feature = "indoors")]
use super::store::{self, RetailStoreLapsParams};
use super::{LaserDriveParams, PlanarDriveParams, catalogue};
use crate::SimulationError;
#[cfg(feature = "league")]
use crate::league::LeagueParams;
use crate::monobot::MonobotParams;
use crate::random::RandomStreams;

/// A set-up with a name and a seed.
/// ```
/// use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
/// use wayfix_scene_sim::Scenario;
/// let scenario = Scenario::named("monobot")?;
/// let records = scenario.simulate(ChaCha8Rng::seed_from_u64(scenario.seed))?;
/// assert!(records.is_sorted_by_key(|record| record.stamp));
/// # Ok::<(), wayfix_scene_sim::SimulationError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Its name, also of its fixture.
    pub name: &'static str,
    /// Seed of the generator.
    pub seed: u64,
    /// Parameters of the set-up.
    pub params: ScenarioParams,
}

/// Parameters by kind of scene.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ScenarioParams {
    /// A robot in the plane.
    Planar(Box<PlanarDriveParams>),
    /// A robot in the plane with a laser.
    Laser(Box<LaserDriveParams>),
    /// A robot on a line, one step every 100 ms.
    Monobot(MonobotParams),
    /// A robot with a camera on the field of the four-legged league.
    #[cfg(feature = "league")]
    League(Box<LeagueParams>),
    /// A robot with an omnidirectional camera in a store.
    #[cfg(feature = "indoors")]
    StoreLaps(Box<RetailStoreLapsParams>),
}

impl Scenario {
    /// All of them, in the order in which reports list them.
    pub fn all() -> Vec<Self> {
        catalogue::all()
    }

    /// Those with a camera on the field of the four-legged league: `color_dark` (D1), `color_bright` (D2), `color_switching` (S),
    /// `color_kidnapped` (K) and `color_sun`. All are in one hall, which is none of the training venues.
    #[cfg(feature = "league")]
    pub fn in_color() -> Vec<Self> {
        league::all()
    }

    /// Those with views of a store: `store_area`, two laps in an area of 25 m × 10 m.
    #[cfg(feature = "indoors")]
    pub fn in_store() -> Vec<Self> {
        store::all()
    }

    /// The one called `name`.
    ///
    /// # Errors
    /// Returns an error if there is none.
    pub fn named(name: &str) -> Result<Self, SimulationError> {
        let all = [
            Self::all(),
            #[cfg(feature = "league")]
            Self::in_color(),
            #[cfg(feature = "indoors")]
            Self::in_store(),
        ];
        let found = all.into_iter().flatten().find(|scenario| scenario.name == name);
        found.ok_or_else(|| SimulationError::UnknownScenario { name: name.to_owned() })
    }

    /// The same with other random draws. A store or a hall of the four-legged league is then drawn too, with unseen light.
    /// ```
    /// use wayfix_scene_sim::Scenario;
    /// let scenario = Scenario::named("office_velocity")?.with_seed(100);
    /// assert_eq!(scenario.seed, 100);
    /// # Ok::<(), wayfix_scene_sim::SimulationError>(())
    /// ```
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        #[cfg(feature = "league")]
        if let ScenarioParams::League(params) = &mut self.params {
            params.venue_seed = None;
        }
        #[cfg(feature = "indoors")]
        if let ScenarioParams::StoreLaps(params) = &mut self.params {
            params.store_seed = seed;
        }
        self
    }

    /// The log, in time order. A generator seeded with [`seed`](Self::seed) gives the log of this name.
    /// # Errors
    /// Returns an error if a parameter is out of range.
    pub fn simulate(&self, rng: ChaCha8Rng) -> Result<Vec<Record>, SimulationError> {
        let mut streams = RandomStreams::new(rng);
        match &self.params {
            ScenarioParams::Planar(params) => params.simulate(&mut streams),
            ScenarioParams::Laser(params) => params.simulate(&mut streams),
            #[cfg(feature = "league")]
            ScenarioParams::League(params) => params.simulate(streams),
            #[cfg(feature = "indoors")]
            ScenarioParams::StoreLaps(params) => params.simulate(streams),
            ScenarioParams::Monobot(params) => {
                let run = params.simulate(&mut streams)?;
                Ok(run.records(Stamp::from_nanoseconds(1_600_000_000_000_000_000), 100))
            }
        }
    }
}
