//! Simulated worlds, robots and sensors with realistic errors; the crate does not depend on estimators.
//!
//! A [`Simulation`] drives a robot along a [`route`] through a [`world`] and returns the log of its [`sensor`]s as
//! [`Record`](wayfix_sensor_log::Record)s, truth included. Named, seeded set-ups are [`Scenario`]s; [`monobot`] is the
//! one-dimensional robot for the analysis of filters. Four worlds serve one system each and are features of their names:
//!
//! | feature | world |
//! | --- | --- |
//! | `league` | a field full of colours under changing light, with a camera |
//! | `scenery` | flat scenes, seen through a window |
//! | `film` | films of one target each under changing light, with its silhouette |
//! | `indoors` | stores and rooms, seen by an omnidirectional camera |
//!
//! * **The truth follows no estimator's model.** Two wheels with motor lag, time-correlated slip and radii that differ from nominal,
//!   integrated at 1 kHz; encoders that count ticks; errors with heavy tails, bias and drift. Only
//!   [`GaussianOdometry`](sensor::GaussianOdometry) and the default [`RangeBearingDetector`](sensor::RangeBearingDetector) match the assumptions
//!   of an extended Kalman filter, for tests of its consistency.
//! * **A laser** ([`sensor::Laser`]) casts its beams against the walls of a plan, such as [`world::OfficeFloor`]. It mixes ranges at edges, loses
//!   and invents echoes, hits people, and rounds.
//! * **One random stream per error source** ([`random::RandomStreams`]): enabling one does not affect the draws of the others.
//! * **Equal bits on every machine**: transcendental functions come from `libm` ([`plane`], [`space`], [`random`]).
//! * **Extensible**: implement [`world::SensorWorld`] or [`sensor::SimulatedSensor`] (`examples/02_custom_sensor.rs`).
//!
//! ```
//! use rand_chacha::{ChaCha8Rng, rand_core::SeedableRng};
//! use wayfix_scene_sim::Scenario;
//! use wayfix_sensor_log::RecordData;
//!
//! let scenario = Scenario::named("office_velocity")?;
//! let records = scenario.simulate(ChaCha8Rng::seed_from_u64(scenario.seed))?;
//! assert!(records.iter().any(|record| matches!(record.data, RecordData::Velocity(_))));
//! # Ok::<(), wayfix_scene_sim::SimulationError>(())
//! ```

mod check;
pub mod drive;
mod error;
#[cfg(feature = "film")]
pub mod film;
#[cfg(feature = "indoors")]
pub mod indoors;
#[cfg(feature = "league")]
pub mod league;
pub mod monobot;
pub mod plane;
pub mod random;
pub mod route;
mod scenario;
#[cfg(feature = "scenery")]
pub mod scenery;
pub mod sensor;
mod simulation;
pub mod space;
pub mod world;

pub use error::SimulationError;
#[cfg(feature = "indoors")]
pub use scenario::RetailStoreLapsParams;
pub use scenario::{
    LaserDriveParams, OdometryParams, OtherRobotParams, PlanarDriveParams, Scenario, ScenarioParams,
};
pub use simulation::Simulation;
