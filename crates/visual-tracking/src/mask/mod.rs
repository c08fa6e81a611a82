//! Sets of pixels, 64 to a word: morphology, Euler number, blobs, contours.

mod bit_mask;
mod blobs;
mod connectivity;
mod contour;
mod euler;
mod measures;
mod morphology;
mod polygon;
mod runs;

pub use bit_mask::PixelMask;
pub(crate) use bit_mask::check_extent;
pub use blobs::{Blob, Blobs};
pub use connectivity::PixelConnectivity;
pub use morphology::StructuringElement;
pub(crate) use runs::ones;
