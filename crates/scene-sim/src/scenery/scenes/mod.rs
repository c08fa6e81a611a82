//! The four scenes, a file each.

mod all;
mod lab;
mod lift;
mod map;
mod scenery;

pub use scenery::Scenery;
