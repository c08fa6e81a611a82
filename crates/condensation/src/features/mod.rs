//! The appearance of a whole view, in a few numbers.

mod columns;
mod dominance;
mod fft6;
mod hist6;
mod histogram;
mod joined_feature;
mod mean_var;
pub(crate) mod picture;
mod regions;
mod table;
mod view;
mod view_grid;

pub use dominance::DominantGrayCriterion;
pub use fft6::Fft6Descriptor;
pub use hist6::DominantGraysDescriptor;
pub use joined_feature::ConcatenatedDescriptor;
pub use mean_var::ColorMeanStdDescriptor;
pub use picture::{grey, mapped, shifted};
pub use regions::IntensityRegionsDescriptor;
pub use table::{GlobalDescriptor, StateDescriptorTable};
pub use view::View;
pub use view_grid::ViewGrid;
