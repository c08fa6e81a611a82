//! State condensation: a robot that finds out in which of finitely many places it is from what the whole view looks like.

mod discrete;
mod error;
mod features;
mod learning;
mod navigation;
mod normalization;

pub use discrete::{
    Axis, BestState, DenseTransition, DiffusionKernel, DiscreteFilter, Evidence, Follow, Graph, Grid,
    HeadingGrid, KidnapMonitor, Lattice, Maneuver, Move, Outcome, Slip, SparseTransition, StateSpace,
    Transition,
};
pub use error::CondensationError;
pub use features::{
    Dominance, FeatureTable, Fft6, Hist6, Joined, MeanVar, Picture, View, ViewFeature, ViewGrid,
};
pub use learning::{
    Appearance, AppearanceParams, Disturbance, MoveLog, N_DISTURBANCES, NoiseParams, PValues, PictureViews,
    SceneViews, Tail, ViewSource,
};
pub use navigation::{
    ActionChoice, Arrival, Localizer, LocalizerParams, Navigator, NavigatorParams, Routes, RunReport, World,
};
pub use normalization::{Light, affine_match, histogram_match, light_match};
