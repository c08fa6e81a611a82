//! Colours as bins of a colour space: the bin of every pixel, sets of bins, counts of bins.

mod bin_image;
mod bin_set;
mod custom_space;
mod histogram;
mod quantizer;
mod row_spans;
mod segmentation;
mod sliding;
mod space;

pub use bin_image::ColorBinImage;
pub use bin_set::ColorBinSet;
pub use custom_space::CustomColorSpace;
pub use histogram::ColorHistogram;
pub use quantizer::ColorQuantizer;
pub use row_spans::RowSpans;
pub use sliding::SlidingHistogram;
pub use space::ColorSpace;
