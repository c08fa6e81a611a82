use super::svg::axis::{Axis, AxisScale};
use super::svg::ellipse::ellipse;
use super::svg::ink::Ink;
use super::svg::layout::{Frame, Plate, no_data};
use super::svg::legend::{Legend, Mark};
use super::{PlotError, SvgPlot};

/// Covariance ellipses in the plane, one panel a group, all panels with the same axes.
///
/// ```
/// use wayfix_evaluation::plot::{CovarianceEllipsesPlot, NamedEllipse};
/// let pink = NamedEllipse { name: "pink".to_owned(), center: (120.0, 160.0), covariance: [[90.0, 20.0], [20.0, 60.0]] };
/// let plot = CovarianceEllipsesPlot {
///     title: "Colours".to_owned(),
///     x_label: "U".to_owned(),
///     sigmas: 1.0,
///     groups: vec![("prior".to_owned(), vec![pink])],
/// };
/// assert!(plot.draw()?.svg.contains("prior"));
/// # Ok::<(), wayfix_evaluation::plot::PlotError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CovarianceEllipsesPlot {
    /// Caption.
    pub title: String,
    /// Label of the abscissa.
    pub x_label: String,
    /// Size of the ellipses, in standard deviations.
    pub sigmas: f64,
    /// Heading and ellipses of each panel; a name has the same ink in every panel, and the name of a colour that colour.
    pub groups: Vec<(String, Vec<NamedEllipse>)>,
}

/// A Gaussian in the plane.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct NamedEllipse {
    /// Its name in the legend.
    pub name: String,
    /// Its mean.
    pub center: (f64, f64),
    /// Its covariance; skipped if not positive definite.
    pub covariance: [[f64; 2]; 2],
}

const PANEL_HEIGHT: f64 = 170.0;

impl CovarianceEllipsesPlot {
    /// The picture.
    ///
    /// # Errors
    /// Returns an error if the drawing library refuses.
    pub fn draw(&self) -> Result<SvgPlot, PlotError> {
        let outline = |e: &NamedEllipse| ellipse(e.center, e.covariance, self.sigmas);
        let all: Vec<(f64, f64)> =
            self.groups.iter().flat_map(|(_, ellipses)| ellipses).flat_map(outline).collect();
        let x = Axis::covering(all.iter().map(|point| point.0), AxisScale::Linear, 0.04);
        let y = Axis::covering(all.iter().map(|point| point.1), AxisScale::Linear, 0.04);
        let Some((x, y)) = x.zip(y) else { return no_data(&self.title) };
        let names = self.names();
        let legend = names.iter().enumerate().fold(Legend::default(), |legend, (k, name)| {
            legend.with(Mark::Line(Ink::of_name(name, k)), *name)
        });
        let headings: Vec<&str> = self.groups.iter().map(|(heading, _)| heading.as_str()).collect();
        let alt = format!("{}: ellipses of {} for {}", self.title, names.join(", "), headings.join("; "));
        let plate = |heading: &&str| Plate { heading: (*heading).to_owned(), x, y, height: PANEL_HEIGHT };
        let plates: Vec<Plate> = headings.iter().map(plate).collect();
        Frame { title: &self.title, alt, legend, x_label: &self.x_label }.draw(&plates, |k, panel| {
            self.groups[k].1.iter().try_for_each(|ellipse| {
                let ink = names.iter().position(|name| *name == ellipse.name).unwrap_or(0);
                panel.outline(&outline(ellipse), Ink::of_name(&ellipse.name, ink))
            })
        })
    }

    /// Every name once, in the order of appearance.
    fn names(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for ellipse in self.groups.iter().flat_map(|(_, ellipses)| ellipses) {
            if !names.contains(&ellipse.name.as_str()) {
                names.push(&ellipse.name);
            }
        }
        names
    }
}
