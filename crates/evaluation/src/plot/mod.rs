//! Plots of a run, as SVG in the colours of the reader's light or dark page.
//!
//! Each plot is a struct of plain numbers with a `draw` method that returns a [`SvgPlot`]:
//! | plot | shows |
//! | --- | --- |
//! | [`MapPlot`] | paths and landmarks with 2σ ellipses, one scale on both axes |
//! | [`PoseErrorPlot`] | x, y and heading error against time inside their ±3σ bands |
//! | [`ConsistencyPlot`] | NEES or NIS against time, its band and its moving mean |
//! | [`StepTimesPlot`] | what each step cost, with the median |
//! | [`LinePlot`] | any named series, linear or logarithmic |
//! | [`CovarianceEllipsesPlot`] | covariance ellipses in the plane, a panel for each group |
//! | [`FilmStrip`] | camera frames in rows |
//!
//! Numbers that are not finite leave a gap; a plot without a drawable number shows "no data". Long series are thinned to the resolution of the
//! picture: the lowest and highest value of every pixel column remain.

mod consistency;
mod decimated;
mod ellipses;
mod error;
mod error_plot;
mod film;
mod histogram;
mod lines;
mod map;
mod picture;
mod scan_sample;
pub mod statistics;
mod svg;
mod times;
mod wall_band;

pub use consistency::ConsistencyPlot;
pub use decimated::Decimated;
pub use ellipses::{CovarianceEllipsesPlot, NamedEllipse};
pub use error::PlotError;
pub use error_plot::{PoseErrorPlot, PoseErrorSample};
pub use film::{FilmStrip, FilmStripFrame, RasterMap};
pub use histogram::histogram;
pub use lines::{LinePlot, PlotBand, PlotSeries};
pub use map::{EstimatedLandmark, MapPlot};
pub use picture::SvgPlot;
pub use scan_sample::ScanSample;
pub use svg::axis::AxisScale;
pub(crate) use svg::ink::{DARK_PALETTE, LIGHT_PALETTE};
pub(crate) use svg::markup::escape;
pub use svg::named::named_color;
pub(crate) use svg::named::named_palette;
pub use times::StepTimesPlot;
pub use wall_band::wall_band;
