//! Pictures of a run at some moments.

mod film_strip;
mod raster_map;

pub use film_strip::{FilmStrip, FilmStripFrame};
pub use raster_map::RasterMap;
