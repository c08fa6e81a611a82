use super::statistics::moving_mean;
use super::svg::axis::{Axis, AxisScale};
use super::svg::ink::Ink;
use super::svg::layout::{Frame, Plate, no_data};
use super::svg::legend::{Legend, Mark};
use super::{PlotError, SvgPlot};

/// NEES or NIS over time, with the 95 % band of a consistent filter and the moving mean.
/// ```
/// use wayfix_evaluation::plot::{ConsistencyPlot, AxisScale};
/// let plot = ConsistencyPlot {
///     title: "Consistency".to_owned(),
///     statistic: "NEES".to_owned(),
///     samples: vec![(0.0, 2.0), (1.0, 4.0), (2.0, 12.0), (3.0, 3.0)],
///     expected: 3.0,
///     band: (0.216, 9.348), // chi-squared with 3 degrees of freedom
///     window: 2,
///     scale: AxisScale::Linear,
/// };
/// assert!(plot.draw()?.svg.contains("75.0 % inside"));
/// # Ok::<(), wayfix_evaluation::plot::PlotError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConsistencyPlot {
    /// Caption.
    pub title: String,
    /// Name of the statistic.
    pub statistic: String,
    /// `(seconds, value)` in the order of time.
    pub samples: Vec<(f64, f64)>,
    /// Mean for a consistent filter: the degrees of freedom.
    pub expected: f64,
    /// The 2.5 % and 97.5 % quantiles of chi-squared with these degrees of freedom.
    pub band: (f64, f64),
    /// Samples in the moving mean.
    pub window: usize,
    /// Scale of the statistic; logarithmic shows an optimistic filter whole.
    pub scale: AxisScale,
}

const PANEL_HEIGHT: f64 = 170.0;

impl ConsistencyPlot {
    /// The picture.
    ///
    /// # Errors
    /// Returns an error if the drawing library refuses.
    pub fn draw(&self) -> Result<SvgPlot, PlotError> {
        let time = Axis::covering(self.samples.iter().map(|(t, _)| *t), AxisScale::Linear, 0.0);
        let has_values =
            Axis::covering(self.samples.iter().map(|(_, value)| *value), self.scale, 0.0).is_some();
        let Some((x, y)) = time.zip(self.value_axis()).filter(|_| has_values) else {
            return no_data(&self.title);
        };
        let (low, high) = self.band;
        let legend = Legend::default()
            .with(Mark::Line(Ink::ESTIMATE), self.statistic.as_str())
            .with(Mark::Line(Ink::Data(1)), format!("mean of {}", self.window.max(1)))
            .with(Mark::Band(Ink::Data(2)), format!("95 % band {low:.2} to {high:.2}"));
        let heading = format!("{} ({})", self.statistic, self.summary());
        let alt =
            format!("{}: {heading} against time with its 95 % band from {low:.2} to {high:.2}", self.title);
        let plate = Plate { heading, x, y, height: PANEL_HEIGHT };
        Frame { title: &self.title, alt, legend, x_label: "time, s" }.draw(&[plate], |_, panel| {
            let ends = x.ends();
            panel.series(&self.shown(), Ink::ESTIMATE, 0.8)?;
            panel.band(&[(ends.0, low, high), (ends.1, low, high)], Ink::Data(2))?;
            panel.series(&[(ends.0, self.expected), (ends.1, self.expected)], Ink::Data(2), 1.0)?;
            panel.series(&moving_mean(&self.samples, self.window), Ink::Data(1), 1.8)
        })
    }

    /// The samples as drawn. A logarithmic axis ends as far below the band as the band begins below the mean: an exact start has a NEES near 0, and
    /// would press the band to a line.
    fn shown(&self) -> Vec<(f64, f64)> {
        let lowest = match self.scale {
            AxisScale::Linear => f64::NEG_INFINITY,
            AxisScale::Log10 => self.band.0 * self.band.0 / self.expected,
        };
        let shown = |&(t, value): &(f64, f64)| (t, if value < lowest { lowest } else { value });
        self.samples.iter().map(shown).collect()
    }

    /// Shows every sample and the band; linear from zero.
    fn value_axis(&self) -> Option<Axis> {
        let origin = (self.scale == AxisScale::Linear).then_some(0.0);
        let values = self.shown().into_iter().map(|(_, value)| value);
        Axis::covering(
            values.chain([self.band.0, self.band.1, self.expected]).chain(origin),
            self.scale,
            0.03,
        )
    }

    fn summary(&self) -> String {
        let finite = || self.samples.iter().map(|(_, value)| *value).filter(|value| value.is_finite());
        let count = finite().count().max(1) as f64;
        let inside = finite().filter(|value| (self.band.0..=self.band.1).contains(value)).count() as f64;
        let mean = finite().sum::<f64>() / count;
        format!("mean {mean:.2}, expected {:.2}; {:.1} % inside", self.expected, 100.0 * inside / count)
    }
}
