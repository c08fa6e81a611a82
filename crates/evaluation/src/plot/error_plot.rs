use super::statistics::quantile;
use super::svg::axis::{Axis, AxisScale};
use super::svg::ink::Ink;
use super::svg::layout::{Frame, Plate, no_data};
use super::svg::legend::{Legend, Mark};
use super::{PlotError, SvgPlot};

/// Error of a planar pose against time, inside the ±3σ band of the filter: x, y and heading.
///
/// ```
/// use wayfix_evaluation::plot::{PoseErrorPlot, PoseErrorSample};
/// let sample = |k: u32| PoseErrorSample { t: f64::from(k), error: [0.01, -0.02, 0.003], sigma: [0.02, 0.02, 0.01] };
/// let picture = PoseErrorPlot { title: "Error".to_owned(), samples: (0..10).map(sample).collect() }.draw()?;
/// assert!(picture.svg.contains("100.0 % inside"));
/// # Ok::<(), wayfix_evaluation::plot::PlotError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseErrorPlot {
    /// Caption.
    pub title: String,
    /// Errors in the order of time.
    pub samples: Vec<PoseErrorSample>,
}

/// Error of the estimated pose at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseErrorSample {
    /// Seconds since the start.
    pub t: f64,
    /// Estimate minus truth: x and y in metres, heading in radians.
    pub error: [f64; 3],
    /// Standard deviations of them by the filter.
    pub sigma: [f64; 3],
}

const PANEL_HEIGHT: f64 = 92.0;
/// Name of each component, its display unit, and the factor from the stored unit.
const COMPONENTS: [(&str, f64); 3] =
    [("x error, m", 1.0), ("y error, m", 1.0), ("heading error, °", 180.0 / std::f64::consts::PI)];

impl PoseErrorPlot {
    /// The picture.
    ///
    /// # Errors
    /// Returns an error if the drawing library refuses.
    pub fn draw(&self) -> Result<SvgPlot, PlotError> {
        let time = Axis::covering(self.samples.iter().map(|sample| sample.t), AxisScale::Linear, 0.0);
        let plate = |k| Some((k, self.plate(time?, k)?));
        let (components, plates): (Vec<usize>, Vec<Plate>) = (0..COMPONENTS.len()).filter_map(plate).unzip();
        if plates.is_empty() {
            return no_data(&self.title);
        }
        let headings: Vec<&str> = plates.iter().map(|plate| plate.heading.as_str()).collect();
        let alt = format!("{}: error against time with its ±3σ band. {}", self.title, headings.join("; "));
        let legend = Legend::default()
            .with(Mark::Line(Ink::ESTIMATE), "error")
            .with(Mark::Band(Ink::ESTIMATE), "±3σ of the filter");
        Frame { title: &self.title, alt, legend, x_label: "time, s" }.draw(&plates, |n, panel| {
            let k = components[n];
            let unit = COMPONENTS[k].1;
            let band = |sample: &PoseErrorSample| {
                (sample.t, -3.0 * unit * sample.sigma[k], 3.0 * unit * sample.sigma[k])
            };
            panel.band(&self.samples.iter().map(band).collect::<Vec<_>>(), Ink::ESTIMATE)?;
            let error = |sample: &PoseErrorSample| (sample.t, unit * sample.error[k]);
            panel.series(&self.samples.iter().map(error).collect::<Vec<_>>(), Ink::ESTIMATE, 1.2)
        })
    }

    /// Panel of component `k`; `None` if none of its errors can be drawn.
    fn plate(&self, x: Axis, k: usize) -> Option<Plate> {
        let (name, unit) = COMPONENTS[k];
        let errors = || self.samples.iter().map(|sample| (unit * sample.error[k]).abs());
        // The axis covers every error; a temporarily wide band, as before the first detection, may be cut off.
        let largest_error = quantile(errors(), 1.0)?;
        let usual_band =
            quantile(self.samples.iter().map(|sample| 3.0 * unit * sample.sigma[k]), 0.95).unwrap_or(0.0);
        let reach = largest_error.max(usual_band);
        let y = Axis::covering([-reach, reach], AxisScale::Linear, 0.06)?;
        Some(Plate { heading: format!("{name} ({})", self.share_inside(k)), x, y, height: PANEL_HEIGHT })
    }

    fn share_inside(&self, k: usize) -> String {
        let judged = || {
            self.samples
                .iter()
                .map(|sample| (sample.error[k].abs(), sample.sigma[k]))
                .filter(|(e, s)| (e + s).is_finite())
        };
        let inside = judged().filter(|(error, sigma)| *error <= 3.0 * sigma).count();
        match judged().count() {
            0 => "no band".to_owned(),
            count => format!("{:.1} % inside", 100.0 * inside as f64 / count as f64),
        }
    }
}
