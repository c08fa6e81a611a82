//! State condensation: localization in finitely many places by the appearance of the whole view.
//!
//! | part | what is in it |
//! | --- | --- |
//! | discrete filter | [`DiscreteFilter`] over any [`DiscreteStateSpace`]: [`PositionGrid`], [`HeadingGrid`], your own; [`TransitionModel`]s, [`DiffusionKernel`] |
//! | features | [`GlobalDescriptor`]: [`ColorMeanStdDescriptor`], [`Fft6Descriptor`], [`DominantGraysDescriptor`], [`IntensityRegionsDescriptor`], [`ConcatenatedDescriptor`], your own; all views of a scene at once |
//! | learning | [`AppearanceModel`]: features of every state and how they answer to shift and light; [`RouteAppearanceModel`]; [`LearnedMotion`]; p-values |
//! | normalization | from the whole scene: [`light_match`]; online: [`AppearanceLearningParams::online`] |
//! | navigation | [`ViewLocalizer`] (place and light together), [`Navigator`] (to a goal, with a stop rule) |
//!
//! Kasprzak & Szynkiewicz, *A method for discrete self-localization using image analysis*. Pictures are [`RgbImage`]s of the
//! crate `image`; no files are opened.

mod discrete;
mod error;
mod features;
mod learning;
mod navigation;
mod normalization;

pub use discrete::{
    DenseTransition, DiffusionKernel, DiscreteFilter, DiscreteStateSpace, GridMove, HeadingGrid, LatticeAxis,
    Maneuver, MeasurementEvidence, MeasurementOutcome, MostProbableState, PositionGrid, SlipProbabilities,
    SparseTransition, StateLattice, TransitionModel,
};
pub use error::CondensationError;
pub use features::{
    ColorMeanStdDescriptor, ConcatenatedDescriptor, DominantGrayCriterion, DominantGraysDescriptor,
    Fft6Descriptor, GlobalDescriptor, IntensityRegionsDescriptor, StateDescriptorTable, View, ViewGrid, grey,
    mapped, shifted,
};
pub use image::{GrayImage, RgbImage};
pub use learning::{
    AppearanceLearningParams, AppearanceModel, LearnedMotion, LikelihoodTail, LoggedMove, N_DISTURBANCES,
    NoiseCovarianceParams, OneViewPerPicture, PValueStatistics, RouteAppearanceModel, RouteAppearanceParams,
    SceneViews, TransitionCounts, UnknownShiftAndLight, ViewSource,
};
pub use navigation::{
    ActionSelection, NavigationEnvironment, NavigationOutcome, NavigationReport, Navigator, NavigatorParams,
    ShortestPathLengths, ViewLocalizer, ViewLocalizerParams,
};
pub use normalization::{LightChange, light_match};
