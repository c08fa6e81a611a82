//! What every plot is drawn with: canvas, axes, panels, ink.

pub(super) mod axis;
pub(super) mod canvas;
pub(super) mod decimate;
pub(super) mod ellipse;
pub(super) mod ink;
pub(super) mod layout;
pub(super) mod legend;
pub(super) mod markup;
pub(super) mod panel;
