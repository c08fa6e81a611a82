use plotters::backend::SVGBackend;
use plotters::coord::Shift;
use plotters::drawing::{DrawingArea, IntoDrawingArea};
use plotters::element::{Circle, PathElement, Polygon, Text};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{Color, FontDesc, FontFamily, FontStyle, ShapeStyle, TextStyle};

use super::super::{PlotError, SvgPlot};
use super::decimate::Pixel;
use super::ink::Ink;
use super::markup::escape;

/// Backend units per pixel. The backend has whole units only; ten per pixel keep ellipses round and flat lines smooth.
const UNITS_PER_PIXEL: f64 = 10.0;
/// Pixels.
pub(in crate::plot) const FONT_SIZE: f64 = 13.5;

/// Paints in pixels, origin at the upper left.
pub(in crate::plot) struct Brush<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

/// Which end of a text is at its position.
#[derive(Clone, Copy)]
pub(in crate::plot) enum Anchor {
    Left,
    Middle,
    Right,
}

/// Paints a picture of the given width and height in pixels.
pub(in crate::plot) fn paint(
    title: &str,
    alt: String,
    (width, height): (f64, f64),
    painter: impl FnOnce(&Brush) -> Result<(), PlotError>,
) -> Result<SvgPlot, PlotError> {
    let mut svg = String::new();
    let size = ((width * UNITS_PER_PIXEL).round() as u32, (height * UNITS_PER_PIXEL).round() as u32);
    let brush = Brush { area: SVGBackend::with_string(&mut svg, size).into_drawing_area() };
    painter(&brush)?;
    brush.area.present()?;
    drop(brush);
    let (width, height) = (width.round() as u32, height.round() as u32);
    let svg = dress(&svg, (width, height), size, &alt);
    Ok(SvgPlot { title: title.to_owned(), alt, width, height, svg })
}

/// Replaces the root element and the colours of the backend's text, and removes repeated attributes.
fn dress(svg: &str, (width, height): (u32, u32), (units_x, units_y): (u32, u32), alt: &str) -> String {
    let body = svg.split_once('>').map_or("", |(_, body)| body);
    let body = [
        " opacity=\"1\"",
        " font-family=\"sans-serif\"",
        " font-size=\"100\"",
        " stroke-width=\"0\"",
        " stroke=\"none\"",
    ]
    .into_iter()
    .fold(Ink::replace_markers(body), |body, repeated| body.replace(repeated, ""))
    .replace(" \"/>", "\"/>");
    let font_size = FONT_SIZE * UNITS_PER_PIXEL;
    let alt = escape(alt);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {units_x} {units_y}\" \
         role=\"img\" aria-label=\"{alt}\" font-size=\"{font_size}\" stroke-linejoin=\"round\">{body}"
    )
}

impl Brush<'_> {
    /// An open line.
    pub(in crate::plot) fn line(&self, points: &[Pixel], ink: Ink, width: f64) -> Result<(), PlotError> {
        let style = ShapeStyle { color: ink.marker(1.0), filled: false, stroke_width: units(width) as u32 };
        Ok(self.area.draw(&PathElement::new(in_units(points), style))?)
    }

    /// A filled shape.
    pub(in crate::plot) fn fill(&self, points: &[Pixel], ink: Ink, opacity: f64) -> Result<(), PlotError> {
        Ok(self.area.draw(&Polygon::new(in_units(points), ink.marker(opacity).filled()))?)
    }

    /// A filled circle.
    pub(in crate::plot) fn dot(
        &self,
        center: Pixel,
        radius: f64,
        ink: Ink,
        opacity: f64,
    ) -> Result<(), PlotError> {
        let style = ShapeStyle { color: ink.marker(opacity), filled: true, stroke_width: 0 };
        Ok(self.area.draw(&Circle::new(in_unit(center), units(radius), style))?)
    }

    /// Two crossing strokes.
    pub(in crate::plot) fn cross(&self, (x, y): Pixel, arm: f64, ink: Ink) -> Result<(), PlotError> {
        self.line(&[(x - arm, y - arm), (x + arm, y + arm)], ink, 1.2)?;
        self.line(&[(x - arm, y + arm), (x + arm, y - arm)], ink, 1.2)
    }

    /// One line of text, centred on the height of `at`.
    pub(in crate::plot) fn text(
        &self,
        text: &str,
        at: Pixel,
        anchor: Anchor,
        ink: Ink,
    ) -> Result<(), PlotError> {
        let h_pos = match anchor {
            Anchor::Left => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::Right => HPos::Right,
        };
        // The backend writes 124 as 100, which `dress` removes: the root element has the true size.
        let font = FontDesc::new(FontFamily::SansSerif, 124.0, FontStyle::Normal);
        let colour = ink.marker(1.0);
        let style = TextStyle::from(font).color(&colour).pos(Pos::new(h_pos, VPos::Center));
        Ok(self.area.draw(&Text::new(text, in_unit(at), style))?)
    }
}

fn units(pixels: f64) -> i32 {
    (pixels * UNITS_PER_PIXEL).round() as i32
}

fn in_unit((x, y): Pixel) -> (i32, i32) {
    (units(x), units(y))
}

fn in_units(points: &[Pixel]) -> Vec<(i32, i32)> {
    points.iter().copied().map(in_unit).collect()
}
