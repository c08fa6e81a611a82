//! An image as sums: any horizontal run of pixels in one subtraction.

mod prefix;
mod sums;
mod tiles;
mod unmapped;

pub use prefix::PrefixSumImage;
pub use sums::PixelSums;
pub(crate) use sums::rounded;
pub use tiles::{TileRegion, TileSums, TiledImage};
