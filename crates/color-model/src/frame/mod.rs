//! An image as sums: any horizontal run of pixels in one subtraction.

mod prefix;
mod sums;

pub use prefix::PrefixSumImage;
pub use sums::PixelSums;
pub(crate) use sums::rounded;
