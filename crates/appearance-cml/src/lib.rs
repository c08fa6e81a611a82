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

pub use archive::{
    ArchivedViewFormat, MapAndState, MapArchive, MapArchiveEnd, MapArchiveError, MapArchiveJournal,
};
pub use error::AppearanceMapError;
pub use fusion::{
    FusionParams, GaussianFusionRule, GaussianMixtureLikelihood, MixtureWeighting, PoseHypothesisSource,
    PositionFix, UniformComponent, combine, fuse,
};
pub use localizer::{
    AppearanceLocalizer, Event, Learning, LocalizerParams, PoseHypothesisRule, Recovery, Start, UpdateOutcome,
};
pub use model::{
    AppearanceMap, AppearanceMapParams, ForgettingMode, ForgettingUncertainty, MapUpdate, PlaceComponent,
    PlaceMatch, PlaceUpdateRule, ReferenceView, ViewDifferenceSample, ViewDistanceScale, interpolate,
    similarity, superpose,
};
pub use search::{
    AppearanceIndex, BoundTable, Descriptor, LinearSearch, LowerBoundedDistance, NoBoundTable, ReferenceId,
    ReferenceMatch, ReferenceSearch, SearchStatistics, ViewDifference,
};
pub use state::{
    MixtureReductionParams, OdometryNoise, PoseHypothesis, propagate, separation_squared, simplify, unimodal,
};
pub use views::{
    AzimuthDirection, BrightnessNormalization, IntensityScale, OmnidirectionalRing, Panorama,
    PanoramaBoundTable, PanoramaDescriptor, PanoramaFeatures, PanoramaParams, PanoramaQuery, RingOrientation,
};
pub use wayfix_integrity::RelocalizationParams;
