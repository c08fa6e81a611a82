//! Feature channels of a window, and their spectra.

pub(super) mod color_channels;
pub(super) mod color_ratio;
pub(super) mod features;
pub(super) mod fourier;
pub(super) mod gradient_channels;
pub(super) mod lane;
pub(super) mod patch;
pub(super) mod planes;
