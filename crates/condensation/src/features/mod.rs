//! What a whole view looks like, in a handful of numbers.

mod columns;
mod dominance;
mod fft6;
mod hist6;
mod histogram;
mod joined_feature;
mod mean_var;
pub(crate) mod picture;
mod table;
mod view;
mod view_grid;

pub use dominance::Dominance;
pub use fft6::Fft6;
pub use hist6::Hist6;
pub use joined_feature::JoinedFeature;
pub use mean_var::MeanVar;
pub use picture::{grey, mapped, shifted};
pub use table::{FeatureTable, ViewFeature};
pub use view::View;
pub use view_grid::ViewGrid;
