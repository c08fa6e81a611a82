//! The map: validated shapes, and the same sorted for casting and projecting.

mod cast;
mod check;
mod color_map;
mod extent;
#[cfg(feature = "serde")]
mod file;
mod layer;
mod plane;
mod prism;

pub use cast::RayHit;
pub use color_map::ColorMap;
pub use extent::MapExtent;
pub(crate) use layer::{Decal, Layer};
pub(crate) use plane::{PLANE_TOLERANCE_M, Plane};
pub(crate) use prism::{Prism, SIDES};
