use std::ops::Range;

use super::RgbPicture;

/// Red, green and blue in [0, 1], as displayed.
pub(crate) type Color = [f64; 3];

/// The part of a picture in which something is to be painted.
#[derive(Clone, Debug)]
pub(crate) struct Window {
    pub(crate) columns: Range<usize>,
    pub(crate) rows: Range<usize>,
}

impl Window {
    /// All of it.
    pub(crate) fn of_size((width, height): (usize, usize)) -> Self {
        Self { columns: 0..width, rows: 0..height }
    }

    /// The square around a centre, clipped to the image.
    #[cfg(feature = "film")]
    pub(crate) fn around(centre: (f64, f64), radius: f64, size: (usize, usize)) -> Self {
        let clipped = |middle: f64, n: usize| {
            let end = |at: f64| at.clamp(0.0, n as f64) as usize;
            end((middle - radius).floor())..end((middle + radius).ceil())
        };
        Self { columns: clipped(centre.0, size.0), rows: clipped(centre.1, size.1) }
    }
}

/// A picture that is being painted, with edges one pixel soft.
pub(crate) struct Canvas {
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) pixels: Vec<Color>,
}

impl Canvas {
    /// `shade` gives the colour at the centre of every pixel.
    pub(crate) fn new(width: usize, height: usize, shade: impl Fn(f64, f64) -> Color) -> Self {
        let centre = |i: usize| ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let pixels = (0..width * height).map(centre).map(|(x, y)| shade(x, y)).collect();
        Self { width, height, pixels }
    }

    /// Paints where `inside`, in pixels from the edge, is positive.
    pub(crate) fn paint(&mut self, inside: impl Fn(f64, f64) -> f64, shade: impl Fn(f64, f64) -> Color) {
        self.paint_in(&Window::of_size((self.width, self.height)), inside, shade);
    }

    /// As [`paint`](Self::paint), restricted to a window.
    pub(crate) fn paint_in(
        &mut self,
        window: &Window,
        inside: impl Fn(f64, f64) -> f64,
        shade: impl Fn(f64, f64) -> Color,
    ) {
        for row in window.rows.clone() {
            for column in window.columns.clone() {
                let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                let cover = (inside(x, y) + 0.5).clamp(0.0, 1.0);
                if cover > 0.0 {
                    let pixel = &mut self.pixels[row * self.width + column];
                    *pixel = mix(*pixel, shade(x, y), cover);
                }
            }
        }
    }

    /// An upright rectangle from one corner to the other.
    pub(crate) fn rectangle(&mut self, from: (f64, f64), to: (f64, f64), shade: impl Fn(f64, f64) -> Color) {
        let inside = |x: f64, y: f64| (x - from.0).min(to.0 - x).min(y - from.1).min(to.1 - y);
        self.paint(inside, shade);
    }

    /// An upright ellipse.
    pub(crate) fn ellipse(
        &mut self,
        centre: (f64, f64),
        radii: (f64, f64),
        shade: impl Fn(f64, f64) -> Color,
    ) {
        let inside = |x: f64, y: f64| {
            let (u, v) = ((x - centre.0) / radii.0, (y - centre.1) / radii.1);
            (1.0 - (u * u + v * v).sqrt()) * radii.0.min(radii.1)
        };
        self.paint(inside, shade);
    }

    /// A line through points.
    pub(crate) fn line(&mut self, points: &[(f64, f64)], width: f64, shade: impl Fn(f64, f64) -> Color) {
        let inside = |x: f64, y: f64| {
            let nearest = points.windows(2).map(|ends| distance((x, y), ends[0], ends[1]));
            0.5 * width - nearest.fold(f64::INFINITY, f64::min)
        };
        self.paint(inside, shade);
    }

    /// Rounded to bytes.
    pub(crate) fn finish(self) -> RgbPicture {
        let byte = |value: f64| (255.0 * value).round().clamp(0.0, 255.0) as u8;
        let rgb = self.pixels.into_iter().flatten().map(byte).collect();
        RgbPicture { width: self.width, height: self.height, rgb }
    }
}

/// Interpolates between two colours.
pub(crate) fn mix(from: Color, to: Color, share: f64) -> Color {
    [0, 1, 2].map(|c| from[c] + (to[c] - from[c]) * share)
}

/// A colour brightened or dimmed.
pub(crate) fn scaled(color: Color, factor: f64) -> Color {
    color.map(|value| value * factor)
}

/// A surface of one colour under light of another.
#[cfg(feature = "film")]
pub(crate) fn times(albedo: Color, light: Color) -> Color {
    [0, 1, 2].map(|c| albedo[c] * light[c])
}

/// From a point to the piece of line between two others.
pub(crate) fn distance(point: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (along, off) = ((to.0 - from.0, to.1 - from.1), (point.0 - from.0, point.1 - from.1));
    let length = along.0 * along.0 + along.1 * along.1;
    let share = if length > 0.0 { (off.0 * along.0 + off.1 * along.1) / length } else { 0.0 };
    let share = share.clamp(0.0, 1.0);
    let (dx, dy) = (off.0 - share * along.0, off.1 - share * along.1);
    (dx * dx + dy * dy).sqrt()
}
