//! An image as sums: any horizontal run of pixels in one subtraction.

mod bit_set;
mod prefix;
mod region;
mod sums;
mod tiles;
mod unmapped;

pub use prefix::PrefixSumImage;
pub(crate) use region::RegionStatistics;
pub use sums::PixelSums;
pub(crate) use sums::rounded;
pub use tiles::{TileRegion, TileSums, TiledImage};
