use std::collections::BTreeMap;

use super::statistics::{median, quantile};
use super::svg::axis::{Axis, AxisScale};
use super::svg::ink::Ink;
use super::svg::layout::{Frame, Plate, no_data};
use super::svg::legend::{Legend, Mark};
use super::{PlotError, SvgPlot};

/// Cost of each step, over the step number or the size of the state, with the median.
/// ```
/// use wayfix_evaluation::plot::StepTimesPlot;
/// let plot = StepTimesPlot { points: (1..100).map(|n| (f64::from(n), f64::from(n * n))).collect(), ..StepTimesPlot::default() };
/// assert!(plot.draw()?.alt.contains("median 2500"));
/// # Ok::<(), wayfix_evaluation::plot::PlotError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StepTimesPlot {
    /// Caption.
    pub title: String,
    /// Label of the abscissa: "step", "state dimension".
    pub x_label: String,
    /// `(abscissa, microseconds)`.
    pub points: Vec<(f64, f64)>,
    /// Scale of the abscissa.
    pub x_scale: AxisScale,
    /// Scale of the time.
    pub y_scale: AxisScale,
}

impl Default for StepTimesPlot {
    fn default() -> Self {
        Self {
            title: "Step time".to_owned(),
            x_label: "step".to_owned(),
            points: Vec::new(),
            x_scale: AxisScale::Linear,
            y_scale: AxisScale::Log10,
        }
    }
}

const PANEL_HEIGHT: f64 = 170.0;
/// Stretches of the abscissa with a median each.
const N_BINS: usize = 32;
/// Number of cells in the width and height of the panel, with one dot each; fewer if that makes too many dots.
const CELLS: (f64, f64) = (150.0, 56.0);
/// Dots of a picture: about 45 kB of text.
const DOT_BUDGET: usize = 650;

impl StepTimesPlot {
    /// The picture.
    ///
    /// # Errors
    /// Returns an error if the drawing library refuses.
    pub fn draw(&self) -> Result<SvgPlot, PlotError> {
        let x = Axis::covering(self.points.iter().map(|point| point.0), self.x_scale, 0.02);
        let y = Axis::covering(self.points.iter().map(|point| point.1), self.y_scale, 0.05);
        let Some((x, y)) = x.zip(y) else { return no_data(&self.title) };
        let times = || self.points.iter().map(|point| point.1);
        let (middle, largest) =
            (median(times()).unwrap_or(f64::NAN), quantile(times(), 1.0).unwrap_or(f64::NAN));
        let heading = format!("µs (median {middle:.0}, largest {largest:.0})");
        let alt = format!("{}: time of a step against {}; {heading}", self.title, self.x_label);
        let legend = Legend::default()
            .with(Mark::Dot(Ink::ESTIMATE), "one step")
            .with(Mark::Line(Ink::Data(1)), "median");
        let plate = Plate { heading, x, y, height: PANEL_HEIGHT };
        Frame { title: &self.title, alt, legend, x_label: &self.x_label }.draw(&[plate], |_, panel| {
            for point in self.decimated(x, y) {
                panel.dot(point, 1.5, Ink::ESTIMATE, 0.55)?;
            }
            panel.path(&self.medians(x), Ink::Data(1), 1.8)
        })
    }

    /// The longest time in each small cell of the panel; sparse points and extremes remain.
    fn decimated(&self, x: Axis, y: Axis) -> Vec<(f64, f64)> {
        let mut cells = CELLS;
        loop {
            let mut longest: BTreeMap<(i64, i64), (f64, f64)> = BTreeMap::new();
            for point in &self.points {
                let Some((across, up)) = x.fraction(point.0).zip(y.fraction(point.1)) else { continue };
                let kept =
                    longest.entry(((across * cells.0) as i64, (up * cells.1) as i64)).or_insert(*point);
                if point.1 > kept.1 {
                    *kept = *point;
                }
            }
            if longest.len() <= DOT_BUDGET {
                return longest.into_values().collect();
            }
            cells = (0.8 * cells.0, 0.8 * cells.1);
        }
    }

    /// Median time of the points in each stretch of the abscissa, at their median abscissa.
    fn medians(&self, x: Axis) -> Vec<(f64, f64)> {
        let mut bins = vec![Vec::new(); N_BINS + 1];
        for point in &self.points {
            if let Some(fraction) = x.fraction(point.0) {
                bins[(fraction * N_BINS as f64) as usize].push(*point);
            }
        }
        let middle = |bin: &Vec<(f64, f64)>| {
            Some((median(bin.iter().map(|p| p.0))?, median(bin.iter().map(|p| p.1))?))
        };
        bins.iter().filter_map(middle).collect()
    }
}
