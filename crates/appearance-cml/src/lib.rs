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
    ArchivedDescriptorFormat, MapAndState, MapArchive, MapArchiveAppender, MapArchiveCompleteness,
    MapArchiveError,
};
pub use error::AppearanceMapError;
pub use fusion::{
    GaussianFusionRule, GaussianMixtureLikelihood, MixtureFusionParams, MixtureWeighting,
    PoseHypothesisSource, PositionFix, UniformComponent, combine, fuse,
};
pub use localizer::{
    AppearanceLocalizer, LocalizerEvent, LocalizerParams, MapLearning, PoseHypothesisRule, StartPosePrior,
    ViewUpdateOutcome,
};
pub use model::{
    AppearanceMap, AppearanceMapParams, ForgettingMode, ForgettingUncertainty, MapUpdate, PlaceComponent,
    PlaceMatch, PlaceUpdateRule, ReferenceView, ViewDifferenceModel, ViewDifferenceSample, interpolate,
    similarity, superpose,
};
pub use search::{
    AppearanceIndex, LinearSearch, LowerBoundTable, LowerBoundedDistance, ReferenceId, ReferenceMatch,
    ReferenceSearch, SearchStatistics, ViewDescriptor, ViewDifference, WithoutLowerBounds,
};
pub use state::{
    MixtureReductionParams, OdometryNoise, PoseHypothesis, propagate, separation_squared, simplify, unimodal,
};
pub use views::{
    AzimuthDirection, BrightnessNormalization, IntensityScale, OmnidirectionalRing, Panorama,
    PanoramaDescriptor, PanoramaDescriptorExtractor, PanoramaDescriptorParams, PanoramaLowerBoundTable,
    PanoramaQuery, RingVerticalOrientation,
};
pub use wayfix_integrity::RelocalizationParams;
