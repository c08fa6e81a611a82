//! The appearance of a view, independent of the robot's heading: panoramas become averages per ring and sector, these a Fourier spectrum over the
//! azimuth. [Gross et al. 2005, Sec. 2.2]
//!
//! A turn of the robot shifts a panorama and multiplies harmonic $`k`$ of every ring by the same $`e^{-\mathrm i k φ}`$: magnitudes, and phases
//! between rings, do not depend on it, and the best rotation is the maximum of the cross-correlation.

mod correlation;
mod cosines;
mod descriptor;
mod features;
mod lanes;
mod low_harmonics;
mod lower_bound;
mod normalization;
mod omnidirectional_ring;
mod panorama;
mod params;
mod probe;
mod sectors;
mod table;

pub use descriptor::PanoramaDescriptor;
pub use features::PanoramaDescriptorExtractor;
pub use normalization::{BrightnessNormalization, IntensityScale};
pub use omnidirectional_ring::{OmnidirectionalRing, RingVerticalOrientation};
pub use panorama::{AzimuthDirection, Panorama};
pub use params::PanoramaDescriptorParams;
pub use probe::PanoramaQuery;
pub use table::PanoramaLowerBoundTable;
