//! Appearance maps: a robot that learns what places look like, forgets what they look like no longer, and localizes in what it has learned.
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
    MapAndState, MapArchive, MapArchiveEnd, MapArchiveError, MapArchiveJournal, MapArchiveParams,
};
pub use error::AppearanceMapError;
pub(crate) use fusion::update_heading;
pub use fusion::{
    FusionParams, GaussianFusionRule, MixtureWeighting, PoseSource, PositionFix, combine, fuse,
};
pub use localizer::{
    AppearanceLocalizer, Event, Learning, LocalizerParams, Motion, Observation, Proof, RelocationParams,
    Start, UpdateOutcome, smooth,
};
pub(crate) use model::HeadingMeasurement;
pub use model::{
    AppearanceMap, AppearanceMapParams, ForgettingMode, ForgettingParams, ForgettingUncertainty, MapUpdate,
    PlaceComponent, PlaceMatch, PlaceUpdateRule, ReferenceView, ViewDifferenceSample, ViewDistanceScale,
    interpolate, similarity, superpose,
};
pub use search::{
    AppearanceIndex, BoundTable, Descriptor, LinearSearch, LowerBoundedDistance, NoBoundTable, ReferenceId,
    ReferenceMatch, ReferenceSearch, SearchStatistics, ViewDifference,
};
pub use state::{
    MixtureReductionParams, OdometryNoise, PoseHypothesis, UnimodalParams, propagate, separation_squared,
    simplify, unimodal,
};
pub use views::{
    AzimuthDirection, BrightnessNormalization, IntensityScale, OmnidirectionalRing, Panorama,
    PanoramaBoundTable, PanoramaDescriptor, PanoramaFeatures, PanoramaParams, PanoramaQuery, RingOrientation,
};
