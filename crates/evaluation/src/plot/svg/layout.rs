use super::super::{PlotError, SvgPlot};
use super::axis::Axis;
use super::canvas::{Anchor, paint};
use super::ink::Ink;
use super::legend::Legend;
use super::panel::{Panel, Rect};

/// Width of every picture, px: two fit side by side on a desktop screen, and one is readable on a phone.
pub(in crate::plot) const WIDTH: f64 = 520.0;
/// Room for numbers at the left edge, and for half a number at the right one.
pub(in crate::plot) const LEFT: f64 = 52.0;
pub(in crate::plot) const RIGHT: f64 = 16.0;
/// The line of text above a panel.
pub(in crate::plot) const HEADING: f64 = 22.0;
/// Numbers and label below a panel.
pub(in crate::plot) const FOOTING: f64 = 42.0;
/// Width of every panel.
pub(in crate::plot) const PANEL_WIDTH: f64 = WIDTH - LEFT - RIGHT;

/// Title, labels and legend around the panels of a picture.
pub(in crate::plot) struct Frame<'a> {
    pub(in crate::plot) title: &'a str,
    pub(in crate::plot) alt: String,
    pub(in crate::plot) legend: Legend,
    pub(in crate::plot) x_label: &'a str,
}

/// One panel of a picture: its heading, axes and height.
pub(in crate::plot) struct Plate {
    pub(in crate::plot) heading: String,
    pub(in crate::plot) x: Axis,
    pub(in crate::plot) y: Axis,
    pub(in crate::plot) height: f64,
}

impl Frame<'_> {
    /// Draws the plates one below the other; `fill` draws into panel number k.
    pub(in crate::plot) fn draw(
        self,
        plates: &[Plate],
        fill: impl Fn(usize, &Panel) -> Result<(), PlotError>,
    ) -> Result<SvgPlot, PlotError> {
        let legend_height = self.legend.height(WIDTH - LEFT);
        let height = legend_height + plates.iter().map(|plate| HEADING + plate.height + FOOTING).sum::<f64>()
            - (plates.len().max(1) - 1) as f64 * (FOOTING - BETWEEN);
        paint(self.title, self.alt, (WIDTH, height), |brush| {
            self.legend.draw(brush, (LEFT, 0.0), WIDTH - LEFT)?;
            let mut top = legend_height;
            for (k, plate) in plates.iter().enumerate() {
                brush.text(&plate.heading, (LEFT, top + 0.5 * HEADING), Anchor::Left, Ink::Muted)?;
                let rect = Rect { left: LEFT, top: top + HEADING, width: PANEL_WIDTH, height: plate.height };
                fill(k, &Panel::open(brush, rect, plate.x, plate.y)?)?;
                top += HEADING + plate.height + BETWEEN;
            }
            let center = LEFT + 0.5 * PANEL_WIDTH;
            brush.text(self.x_label, (center, height - 10.0), Anchor::Middle, Ink::Muted)
        })
    }
}

/// Numbers below a panel that is not the last.
const BETWEEN: f64 = 24.0;

/// A picture with the text "no data".
pub(in crate::plot) fn no_data(title: &str) -> Result<SvgPlot, PlotError> {
    const HEIGHT: f64 = 120.0;
    paint(title, format!("{title}: no data"), (WIDTH, HEIGHT), |brush| {
        let (left, top, right, bottom) = (0.5, 0.5, WIDTH - 0.5, HEIGHT - 0.5);
        brush.line(
            &[(left, top), (right, top), (right, bottom), (left, bottom), (left, top)],
            Ink::Grid,
            1.0,
        )?;
        brush.text("no data", (0.5 * WIDTH, 0.5 * HEIGHT), Anchor::Middle, Ink::Muted)
    })
}
