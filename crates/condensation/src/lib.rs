//! State condensation: a robot that finds out in which of finitely many places it is from what the whole view looks like.
//!
//! | part | what is in it |
//! | --- | --- |
//! | discrete filter | [`DiscreteFilter`] over any [`StateSpace`]: [`Grid`], [`HeadingGrid`], [`Graph`]; [`Transition`]s, [`DiffusionKernel`] |
//! | features | [`ViewFeature`]: [`MeanVar`], [`Fft6`], [`Hist6`], [`JoinedFeature`], your own; all views of a scene at once |
//! | learning | [`Appearance`]: features of every state and how they answer to shift and light; [`Traverse`]; [`MoveLog`]; p-values |
//! | normalization | from the whole scene: [`affine_match`], [`histogram_match`], [`light_match`]; online: [`AppearanceParams::online`] |
//! | navigation | [`Localizer`] (place and light together), [`Navigator`] (to a goal, with a stop rule) |
//! | boxes and heads | [`CorrelationTracker`]: anything, from its first box, lost and found; [`HeadTracker`]: an ellipse, skin and hair |
//! | colours and masks | bins of a [`ColorSpace`], [`ColorHistogram`], [`BitMask`] with 64 pixels a word, [`MeanShift`] |
//! | contours | [`Outline`], [`AffineSnake`]; [`ColorCloud`], [`ColorDynamics`]; [`ContourTracker`] |
//!
//! Kasprzak & Szynkiewicz, *A method for discrete self-localization using image analysis*. The crate opens no files: pictures are
//! buffers of red, green and blue.

mod discrete;
mod error;
mod features;
mod learning;
mod navigation;
mod normalization;
mod tracking;

pub use discrete::{
    Axis, BestState, DenseTransition, DiffusionKernel, DiscreteFilter, Graph, GraphAction, Grid, HeadingGrid,
    KidnapMonitor, Lattice, Maneuver, MeasurementEvidence, Move, Outcome, Slip, SparseTransition, StateSpace,
    Transition,
};
pub use error::CondensationError;
pub use features::{
    Dominance, FeatureTable, Fft6, Hist6, JoinedFeature, MeanVar, Picture, View, ViewFeature, ViewGrid,
};
pub use learning::{
    Appearance, AppearanceParams, Disturbance, MoveLog, N_DISTURBANCES, NoiseParams, PValues, PictureViews,
    SceneViews, Tail, Traverse, TraverseParams, ViewSource,
};
pub use navigation::{
    ActionChoice, Arrival, Localizer, LocalizerParams, Navigator, NavigatorParams, Routes, RunReport, World,
};
pub use normalization::{Light, affine_match, histogram_match, light_match};
pub use tracking::{
    AffineMap, AffineSnake, Agreement, BackProjection, BinImage, BinSet, BitMask, Blob, Blobs, BoundingBox,
    COLOR_DIM, ColorCloud, ColorDynamics, ColorEdges, ColorHistogram, ColorQuantizer, ColorSpace, ColorState,
    ColorVector, ColorWarp, Connectivity, ContourTracker, ContourTrackerParams, CorrelationTracker,
    CorrelationTrackerParams, EdgeSearch, Element, HeadTracker, HeadTrackerParams, LearnedDynamics,
    LocalScale, MaskEdges, MeanShift, MeanShiftParams, Moments, Outline, PixelRect, PrincipalColors,
    RowSpans, ScaleSource, SlidingHistogram, SnakeFit, SnakeParams, Target, TrackStatus, Tracker,
    TrackingCues,
};
