//! Common parts of the plots: canvas, axes, panels, inks.

pub(super) mod axis;
pub(super) mod canvas;
pub(super) mod decimate;
pub(super) mod ellipse;
pub(super) mod ink;
pub(super) mod layout;
pub(super) mod legend;
pub(super) mod markup;
pub(super) mod named;
pub(super) mod panel;
