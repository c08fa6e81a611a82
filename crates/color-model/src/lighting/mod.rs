//! Estimation of the colours under the current light: filters over all colour means, and banks of them for different lights.

mod bank;
mod density;
mod drift;
mod filter;
mod means;
mod params;
mod tracker;

pub use bank::{LightingFilterBank, SelectedLightingFilter};
pub use density::ColorDensity;
pub use filter::LightingFilter;
pub use means::ColorMeans;
pub use params::{LightingDrift, LightingFilterParams, UnseenColorRule};
pub use tracker::{
    Gpb2LightingTracker, ImmLightingTracker, JumpMarkovLightingTracker, LightingTracker, SunAndShade,
};
