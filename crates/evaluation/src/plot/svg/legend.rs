use super::super::PlotError;
use super::canvas::{Anchor, Brush, FONT_SIZE};
use super::decimate::Pixel;
use super::ink::Ink;

/// Symbol before the text of a legend entry.
#[derive(Clone, Copy)]
pub(in crate::plot) enum Mark {
    Line(Ink),
    Band(Ink),
    Dot(Ink),
    Cross(Ink),
}

/// Names of the marks, in rows above the plot.
#[derive(Default)]
pub(in crate::plot) struct Legend {
    entries: Vec<(Mark, String)>,
}

const ROW_HEIGHT: f64 = 19.0;
const MARK_WIDTH: f64 = 20.0;
const GAP: f64 = 16.0;

impl Legend {
    /// The legend with one more entry.
    pub(in crate::plot) fn with(mut self, mark: Mark, name: impl Into<String>) -> Self {
        self.entries.push((mark, name.into()));
        self
    }

    /// Adds the entry only if `shown`.
    pub(in crate::plot) fn with_if(self, shown: bool, mark: Mark, name: &str) -> Self {
        if shown { self.with(mark, name) } else { self }
    }

    /// Height in pixels at a width of `width`.
    pub(in crate::plot) fn height(&self, width: f64) -> f64 {
        self.positions(width).last().map_or(0.0, |(_, y)| y + ROW_HEIGHT)
    }

    pub(in crate::plot) fn draw(
        &self,
        brush: &Brush,
        (left, top): Pixel,
        width: f64,
    ) -> Result<(), PlotError> {
        for ((mark, name), (x, y)) in self.entries.iter().zip(self.positions(width)) {
            let (x, y) = (left + x, top + y + 0.5 * ROW_HEIGHT);
            mark.draw(brush, (x, y))?;
            brush.text(name, (x + MARK_WIDTH + 5.0, y), Anchor::Left, Ink::Text)?;
        }
        Ok(())
    }

    /// Upper left corner of each entry, filling rows from the left.
    fn positions(&self, width: f64) -> Vec<Pixel> {
        let (mut x, mut y) = (0.0, 0.0);
        let mut positions = Vec::with_capacity(self.entries.len());
        for (_, name) in &self.entries {
            let entry_width = MARK_WIDTH + 5.0 + text_width(name);
            if x > 0.0 && x + entry_width > width {
                (x, y) = (0.0, y + ROW_HEIGHT);
            }
            positions.push((x, y));
            x += entry_width + GAP;
        }
        positions
    }
}

impl Mark {
    /// Draws the mark with its left end at `(x, y)`.
    fn draw(self, brush: &Brush, (x, y): Pixel) -> Result<(), PlotError> {
        let center = (x + 0.5 * MARK_WIDTH, y);
        match self {
            Self::Line(ink) => brush.line(&[(x, y), (x + MARK_WIDTH, y)], ink, 1.8),
            Self::Band(ink) => {
                let (right, top, bottom) = (x + MARK_WIDTH, y - 5.0, y + 5.0);
                brush.fill(&[(x, top), (right, top), (right, bottom), (x, bottom)], ink, 0.22)
            }
            Self::Dot(ink) => brush.dot(center, 3.0, ink, 1.0),
            Self::Cross(ink) => brush.cross(center, 3.5, ink),
        }
    }
}

/// An upper estimate of the text width; the browser's font is unknown.
fn text_width(text: &str) -> f64 {
    0.56 * FONT_SIZE * text.chars().count() as f64
}
