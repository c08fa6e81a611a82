//! Appearance maps: a robot that learns what places look like, forgets what they look like no longer, and localizes in what it has learned.
//!
//! Gross, Koenig & Müller, *Omniview-based Concurrent Map Building and Localization using Adaptive Appearance Maps*. The crate opens no
//! files: views are buffers of pixels, maps are bytes.

mod error;
mod search;
mod views;

pub use error::AppearanceError;
pub use search::{
    AppearanceIndex, Bounded, Comparison, Descriptor, LinearSearch, Match, ReferenceId, ReferenceSearch,
    SearchCost,
};
pub use views::{
    Donut, Normalization, Panorama, PanoramaDescriptor, PanoramaFeatures, PanoramaParams, RingOrder, Tone,
    TurnSense,
};
