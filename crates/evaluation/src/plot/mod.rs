//! Pictures of a run, as SVG that follows the reader's light or dark page.
//!
//! Each plot is a struct of plain numbers with a `draw` method that gives a [`Picture`]:
//!
//! | plot | shows |
//! | --- | --- |
//! | [`MapPlot`] | paths and landmarks with 2σ ellipses, one scale on both axes |
//! | [`ErrorPlot`] | x, y and heading error against time inside their ±3σ bands |
//! | [`ConsistencyPlot`] | NEES or NIS against time, its band and its moving mean |
//! | [`TimesPlot`] | what each step cost, with the median |
//! | [`LinesPlot`] | any named series, linear or logarithmic |
//! | [`EllipsesPlot`] | covariance ellipses in the plane, a panel for each group |
//! | [`FilmStrip`] | camera frames in rows |
//!
//! Numbers that are not finite leave a gap; a plot without a single drawable number says "no data". Long series are thinned to what the
//! picture can show: the lowest and highest value of every pixel column stay.

mod axis;
mod canvas;
mod consistency;
mod decimate;
mod ellipse;
mod ellipses;
mod error;
mod error_plot;
mod film_strip;
mod ink;
mod layout;
mod legend;
mod lines;
mod map;
mod markup;
mod panel;
mod picture;
pub mod statistics;
mod times;

pub use axis::Scale;
pub use consistency::ConsistencyPlot;
pub use ellipses::{EllipsesPlot, NamedEllipse};
pub use error::PlotError;
pub use error_plot::{ErrorPlot, ErrorSample};
pub use film_strip::{FilmFrame, FilmStrip};
pub(crate) use ink::{DARK_PALETTE, LIGHT_PALETTE};
pub use lines::{LinesPlot, NamedBand, Series};
pub use map::{EstimatedLandmark, MapPlot};
pub(crate) use markup::escape;
pub use picture::Picture;
pub use times::TimesPlot;
