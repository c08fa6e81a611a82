//! The field of the four-legged league: each sin of its light, camera and robot against what was asked for.

mod bad_params;
mod camera;
mod drive;
mod light;
mod noise;
mod robot;
mod support;
mod truth;
