//! Appearance maps: localization by omnidirectional views, in a map that learns new views and forgets old ones.
//!
//! Gross, Koenig & Müller, *Omniview-based Concurrent Map Building and Localization using Adaptive Appearance Maps*. The crate opens no
//! files: views are buffers of pixels, maps are bytes.

mod archive;
mod check;
mod error;
mod fusion;
mod localizer;
mod model;
mod search;
mod state;
mod views;

pub use archive::{ArchiveEnd, ArchiveError, ArchiveParams, Journal, MapAndState, MapArchive};
pub use error::AppearanceError;
pub use fusion::{
    Combination, FusionParams, PoseLikelihood, PoseSource, PositionFix, UniformComponent, Weighting, combine,
    fuse,
};
pub use localizer::{
    AppearanceLocalizer, Event, Learning, LocalizerParams, Observation, Recovery, Start, UpdateOutcome,
};
pub use model::{
    AppearanceMap, Forgetting, ForgettingUncertainty, LagSample, MapParams, MapUpdate, PlaceComponent,
    PlaceMatch, PlaceUpdate, Reference, ViewScale, interpolate, similarity, superpose,
};
pub use search::{
    AppearanceIndex, BoundTable, Bounded, Descriptor, LinearSearch, Match, NoTable, ReferenceId,
    ReferenceSearch, SearchCost, ViewDifference,
};
pub use state::{
    MixtureReductionParams, OdometryNoise, PoseHypothesis, propagate, separation_squared, simplify, unimodal,
};
pub use views::{
    Donut, Normalization, Panorama, PanoramaDescriptor, PanoramaFeatures, PanoramaParams, PanoramaProbe,
    PanoramaTable, RingOrder, Tone, TurnSense,
};
pub use wayfix_integrity::RelocalizationParams;
