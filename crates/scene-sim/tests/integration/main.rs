//! Tests of the public interface of `wayfix-scene-sim`, in one program: it is linked once.

mod bad_params;
#[cfg(feature = "film")]
mod film;
#[cfg(feature = "indoors")]
mod indoors;
mod laser;
#[cfg(feature = "league")]
mod league;
mod monobot;
mod scenarios;
#[cfg(feature = "scenery")]
mod scenery;
mod sensor_sins;
mod streams;
mod support;
mod truth;
mod worlds;
