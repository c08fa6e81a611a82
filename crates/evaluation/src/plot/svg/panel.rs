use std::collections::BTreeSet;

use super::super::PlotError;
use super::axis::Axis;
use super::canvas::{Anchor, Brush};
use super::decimate::{Pixel, column_extremes, simplify_path};
use super::ink::Ink;

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug)]
pub(in crate::plot) struct Rect {
    pub(in crate::plot) left: f64,
    pub(in crate::plot) top: f64,
    pub(in crate::plot) width: f64,
    pub(in crate::plot) height: f64,
}

/// A pair of axes with its content.
pub(in crate::plot) struct Panel<'a, 'b> {
    brush: &'a Brush<'b>,
    rect: Rect,
    x: Axis,
    y: Axis,
}

/// Pixels between neighbouring numbers on an axis.
const TICK_SPACING: (f64, f64) = (56.0, 26.0);
/// A third of a pixel is not seen.
const TOLERANCE: f64 = 0.3;
/// Points of one drawn line: about 12 kB of text.
const LINE_BUDGET: usize = 1200;

impl<'a, 'b> Panel<'a, 'b> {
    /// Draws grid and numbers.
    pub(in crate::plot) fn open(
        brush: &'a Brush<'b>,
        rect: Rect,
        x: Axis,
        y: Axis,
    ) -> Result<Self, PlotError> {
        let panel = Self { brush, rect, x, y };
        panel.draw_grid()?;
        Ok(panel)
    }

    /// A path in the plane; a point that is not finite or outside the panel leaves a gap.
    pub(in crate::plot) fn path(&self, points: &[(f64, f64)], ink: Ink, width: f64) -> Result<(), PlotError> {
        for run in self.runs(points) {
            self.brush.line(&simplify_path(&run, TOLERANCE, LINE_BUDGET), ink, width)?;
        }
        Ok(())
    }

    /// Draws a series with increasing x; every peak stays visible.
    pub(in crate::plot) fn series(
        &self,
        points: &[(f64, f64)],
        ink: Ink,
        width: f64,
    ) -> Result<(), PlotError> {
        for run in self.runs(points) {
            self.brush.line(
                &simplify_path(&column_extremes(&run, 1.0), TOLERANCE, LINE_BUDGET),
                ink,
                width,
            )?;
        }
        Ok(())
    }

    /// The region `low ≤ y ≤ high` of samples `(x, low, high)`, cut off at the panel.
    pub(in crate::plot) fn band(&self, samples: &[(f64, f64, f64)], ink: Ink) -> Result<(), PlotError> {
        let edge = |side: fn(&(f64, f64, f64)) -> f64| {
            samples.iter().map(move |sample| self.to_pixel((sample.0, side(sample)))).collect::<Vec<_>>()
        };
        let (low, high) = (edge(|sample| sample.1), edge(|sample| sample.2));
        let mut start = 0;
        while start < samples.len() {
            let length =
                (start..samples.len()).take_while(|k| low[*k].is_some() && high[*k].is_some()).count();
            let thin = |edge: &[Option<Pixel>]| {
                let run: Vec<Pixel> =
                    edge[start..start + length].iter().flatten().map(|point| self.clamp(*point)).collect();
                simplify_path(&column_extremes(&run, 2.0), TOLERANCE, LINE_BUDGET / 2)
            };
            let mut outline = thin(&low);
            outline.extend(thin(&high).into_iter().rev());
            if !outline.is_empty() {
                self.brush.fill(&outline, ink, 0.16)?;
            }
            start += length + 1;
        }
        Ok(())
    }

    /// A closed outline around `center`, cut off at the panel.
    pub(in crate::plot) fn outline(&self, points: &[(f64, f64)], ink: Ink) -> Result<(), PlotError> {
        let pixels: Vec<Pixel> =
            points.iter().filter_map(|point| self.to_pixel(*point)).map(|p| self.clamp(p)).collect();
        // An outline has a start and an end in the same place, where no tolerance could cut a corner.
        let outline = simplify_path(&pixels, 0.1, LINE_BUDGET);
        if outline.len() < 4 {
            return Ok(());
        }
        self.brush.fill(&outline, ink, 0.15)?;
        self.brush.line(&outline, ink, 1.0)
    }

    /// A small disc.
    pub(in crate::plot) fn dot(
        &self,
        at: (f64, f64),
        radius: f64,
        ink: Ink,
        opacity: f64,
    ) -> Result<(), PlotError> {
        self.visible(at).map_or(Ok(()), |pixel| self.brush.dot(pixel, radius, ink, opacity))
    }

    /// Many small discs, one a pixel.
    pub(in crate::plot) fn dots(
        &self,
        points: &[(f64, f64)],
        radius: f64,
        ink: Ink,
        opacity: f64,
    ) -> Result<(), PlotError> {
        let pixels = points.iter().filter_map(|point| self.visible(*point));
        let pixels: BTreeSet<_> = pixels.map(|(x, y)| (x.round() as i64, y.round() as i64)).collect();
        pixels.iter().try_for_each(|(x, y)| self.brush.dot((*x as f64, *y as f64), radius, ink, opacity))
    }

    /// A small cross.
    pub(in crate::plot) fn cross(&self, at: (f64, f64), arm: f64, ink: Ink) -> Result<(), PlotError> {
        self.visible(at).map_or(Ok(()), |pixel| self.brush.cross(pixel, arm, ink))
    }

    /// Pixel position of a point; `None` if it cannot be drawn.
    pub(in crate::plot) fn to_pixel(&self, (x, y): (f64, f64)) -> Option<Pixel> {
        let (x, y) = (self.x.fraction(x)?, self.y.fraction(y)?);
        Some((self.rect.left + x * self.rect.width, self.rect.top + (1.0 - y) * self.rect.height))
    }

    fn visible(&self, point: (f64, f64)) -> Option<Pixel> {
        let pixel = self.to_pixel(point)?;
        let clamped = self.clamp(pixel);
        ((pixel.0 - clamped.0).abs() < 0.5 && (pixel.1 - clamped.1).abs() < 0.5).then_some(pixel)
    }

    fn clamp(&self, (x, y): Pixel) -> Pixel {
        let Rect { left, top, width, height } = self.rect;
        (x.clamp(left, left + width), y.clamp(top, top + height))
    }

    /// The drawable runs of a series; a single point becomes a run one pixel long, to stay visible.
    fn runs(&self, points: &[(f64, f64)]) -> Vec<Vec<Pixel>> {
        let pixels: Vec<Option<Pixel>> = points.iter().map(|point| self.visible(*point)).collect();
        pixels
            .split(Option::is_none)
            .map(|run| run.iter().flatten().copied().collect::<Vec<_>>())
            .filter(|run| !run.is_empty())
            .map(|run| if let [(x, y)] = run[..] { vec![(x - 0.5, y), (x + 0.5, y)] } else { run })
            .collect()
    }

    fn draw_grid(&self) -> Result<(), PlotError> {
        let Rect { left, top, width, height } = self.rect;
        let (right, bottom) = (left + width, top + height);
        for (value, label) in self.x.ticks((width / TICK_SPACING.0) as usize) {
            let Some(fraction) = self.x.fraction(value) else { continue };
            let x = left + fraction * width;
            self.brush.line(&[(x, top), (x, bottom)], Ink::Grid, 1.0)?;
            self.brush.text(&label, (x, bottom + 11.0), Anchor::Middle, Ink::Muted)?;
        }
        for (value, label) in self.y.ticks((height / TICK_SPACING.1).max(5.0) as usize) {
            let Some(fraction) = self.y.fraction(value) else { continue };
            let y = bottom - fraction * height;
            self.brush.line(&[(left, y), (right, y)], Ink::Grid, 1.0)?;
            self.brush.text(&label, (left - 6.0, y), Anchor::Right, Ink::Muted)?;
        }
        self.brush.line(&[(left, top), (left, bottom), (right, bottom)], Ink::Muted, 1.0)
    }
}
