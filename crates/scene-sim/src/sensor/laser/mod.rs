//! A planar laser range finder that turns a beam through its field of view.

mod params;
mod people;
mod scanner;

pub use params::LaserParams;
pub use people::People;
pub use scanner::Laser;
