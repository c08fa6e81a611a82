use super::svg::axis::{Axis, AxisScale};
use super::svg::ink::Ink;
use super::svg::layout::{Frame, Plate, no_data};
use super::svg::legend::{Legend, Mark};
use super::{PlotError, SvgPlot};

/// Several named series against one abscissa.
///
/// ```
/// use wayfix_evaluation::plot::{LinePlot, PlotBand, AxisScale, PlotSeries};
/// let powers = |exponent: i32| (1..50).map(|n| (f64::from(n), f64::from(n).powi(exponent))).collect();
/// let plot = LinePlot {
///     title: "Cost".to_owned(),
///     x_label: "landmarks".to_owned(),
///     y_label: "multiplications".to_owned(),
///     series: vec![PlotSeries::new("dense", powers(3)), PlotSeries::new("sparse", powers(2))],
///     x_scale: AxisScale::Log10,
///     y_scale: AxisScale::Log10,
///     band: Some(PlotBand { name: "a millisecond".to_owned(), low: 1e5, high: 1e6 }),
/// };
/// let svg = plot.draw()?.svg;
/// assert!(svg.contains("sparse") && svg.contains("a millisecond"));
/// # Ok::<(), wayfix_evaluation::plot::PlotError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LinePlot {
    /// Caption.
    pub title: String,
    /// Label of the abscissa, with its unit.
    pub x_label: String,
    /// Label of the ordinate, with its unit.
    pub y_label: String,
    /// The lines.
    pub series: Vec<PlotSeries>,
    /// Scale of the abscissa.
    pub x_scale: AxisScale,
    /// Scale of the ordinate.
    pub y_scale: AxisScale,
    /// Expected range of the ordinates.
    pub band: Option<PlotBand>,
}

/// A named line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotSeries {
    /// Its name in the legend.
    pub name: String,
    /// `(x, y)` with growing x.
    pub points: Vec<(f64, f64)>,
}

impl PlotSeries {
    /// The line `points` called `name`.
    pub fn new(name: impl Into<String>, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), points }
    }
}

/// A range of ordinates, over all abscissas.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlotBand {
    /// Its name in the legend.
    pub name: String,
    /// Its lower edge.
    pub low: f64,
    /// Its upper edge.
    pub high: f64,
}

const PANEL_HEIGHT: f64 = 220.0;

impl LinePlot {
    /// The picture.
    ///
    /// # Errors
    /// Returns an error if the drawing library refuses.
    pub fn draw(&self) -> Result<SvgPlot, PlotError> {
        let points = || self.series.iter().flat_map(|series| &series.points);
        let x = Axis::covering(points().map(|point| point.0), self.x_scale, 0.0);
        let edges = self.band.iter().flat_map(|band| [band.low, band.high]);
        let y = Axis::covering(points().map(|point| point.1).chain(edges), self.y_scale, 0.05);
        let Some((x, y)) = x.zip(y) else { return no_data(&self.title) };
        let legend = self.series.iter().enumerate().fold(Legend::default(), |legend, (k, series)| {
            legend.with(Mark::Line(Ink::of_series(k)), series.name.as_str())
        });
        let band_ink = Ink::of_series(self.series.len());
        let legend = self
            .band
            .iter()
            .fold(legend, |legend, band| legend.with(Mark::Band(band_ink), band.name.as_str()));
        let names: Vec<&str> = self.series.iter().map(|series| series.name.as_str()).collect();
        let alt =
            format!("{}: {} against {} for {}", self.title, self.y_label, self.x_label, names.join(", "));
        let plate = Plate { heading: self.y_label.clone(), x, y, height: PANEL_HEIGHT };
        Frame { title: &self.title, alt, legend, x_label: &self.x_label }.draw(&[plate], |_, panel| {
            let (left, right) = x.ends();
            self.band.iter().try_for_each(|band| {
                panel.band(&[(left, band.low, band.high), (right, band.low, band.high)], band_ink)
            })?;
            self.series
                .iter()
                .enumerate()
                .try_for_each(|(k, series)| panel.series(&series.points, Ink::of_series(k), 1.6))
        })
    }
}
