//! State condensation: a robot that finds out in which of finitely many places it is from what the whole view looks like.
//!
//! | part | what is in it |
//! | --- | --- |
//! | discrete filter | [`DiscreteFilter`] over any [`StateSpace`]: [`Grid`], [`HeadingGrid`], [`Graph`]; [`Transition`]s, [`DiffusionKernel`] |
//! | features | [`ViewFeature`]: [`MeanVar`], [`Fft6`], [`Hist6`], [`JoinedFeature`], your own; all views of a scene at once |
//! | learning | [`Appearance`]: features of every state and how they answer to shift and light; [`Traverse`]; [`MoveLog`]; p-values |
//! | normalization | from the whole scene: [`affine_match`], [`histogram_match`], [`light_match`]; online: [`AppearanceParams::online`] |
//! | navigation | [`Localizer`] (place and light together), [`Navigator`] (to a goal, with a stop rule) |
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
    Axis, BestState, DenseTransition, DiffusionKernel, DiscreteFilter, Graph, GraphAction, Grid, HeadingGrid,
    Lattice, Maneuver, MeasurementEvidence, Move, Outcome, Slip, SparseTransition, StateSpace, Transition,
};
pub use error::CondensationError;
pub use features::{
    Dominance, FeatureTable, Fft6, Hist6, JoinedFeature, MeanVar, View, ViewFeature, ViewGrid, grey, mapped,
    shifted,
};
pub use image::{GrayImage, RgbImage};
pub use learning::{
    Appearance, AppearanceParams, Disturbance, MoveLog, N_DISTURBANCES, NoiseParams, PValues, PictureViews,
    SceneViews, Tail, Traverse, TraverseParams, ViewSource,
};
pub use navigation::{
    ActionChoice, Arrival, Localizer, LocalizerParams, Navigator, NavigatorParams, Routes, RunReport, World,
};
pub use normalization::{Light, affine_match, histogram_match, light_match};
