use super::RgbPicture;

/// Red, green and blue in [0, 1], as displayed.
pub(super) type Color = [f64; 3];

/// A picture that is being painted, with edges one pixel soft.
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    pixels: Vec<Color>,
}

impl Canvas {
    /// `shade` gives the colour at the centre of every pixel.
    pub(super) fn new(width: usize, height: usize, shade: impl Fn(f64, f64) -> Color) -> Self {
        let centre = |i: usize| ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        let pixels = (0..width * height).map(centre).map(|(x, y)| shade(x, y)).collect();
        Self { width, height, pixels }
    }

    /// Paints where `inside`, in pixels from the edge, is positive.
    pub(super) fn paint(&mut self, inside: impl Fn(f64, f64) -> f64, shade: impl Fn(f64, f64) -> Color) {
        for (i, pixel) in self.pixels.iter_mut().enumerate() {
            let (x, y) = ((i % self.width) as f64 + 0.5, (i / self.width) as f64 + 0.5);
            let cover = (inside(x, y) + 0.5).clamp(0.0, 1.0);
            if cover > 0.0 {
                *pixel = mix(*pixel, shade(x, y), cover);
            }
        }
    }

    /// An upright rectangle from one corner to the other.
    pub(super) fn rectangle(&mut self, from: (f64, f64), to: (f64, f64), shade: impl Fn(f64, f64) -> Color) {
        let inside = |x: f64, y: f64| (x - from.0).min(to.0 - x).min(y - from.1).min(to.1 - y);
        self.paint(inside, shade);
    }

    /// An upright ellipse.
    pub(super) fn ellipse(
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
    pub(super) fn line(&mut self, points: &[(f64, f64)], width: f64, shade: impl Fn(f64, f64) -> Color) {
        let inside = |x: f64, y: f64| {
            let nearest = points.windows(2).map(|ends| distance((x, y), ends[0], ends[1]));
            0.5 * width - nearest.fold(f64::INFINITY, f64::min)
        };
        self.paint(inside, shade);
    }

    /// Rounded to bytes.
    pub(super) fn finish(self) -> RgbPicture {
        let byte = |value: f64| (255.0 * value).round().clamp(0.0, 255.0) as u8;
        let rgb = self.pixels.into_iter().flatten().map(byte).collect();
        RgbPicture { width: self.width, height: self.height, rgb }
    }
}

/// From one colour to another.
pub(super) fn mix(from: Color, to: Color, share: f64) -> Color {
    [0, 1, 2].map(|c| from[c] + (to[c] - from[c]) * share)
}

/// A colour brightened or dimmed.
pub(super) fn scaled(color: Color, factor: f64) -> Color {
    color.map(|value| value * factor)
}

/// From a point to the piece of line between two others.
fn distance(point: (f64, f64), from: (f64, f64), to: (f64, f64)) -> f64 {
    let (along, off) = ((to.0 - from.0, to.1 - from.1), (point.0 - from.0, point.1 - from.1));
    let length = along.0 * along.0 + along.1 * along.1;
    let share = if length > 0.0 { (off.0 * along.0 + off.1 * along.1) / length } else { 0.0 };
    let share = share.clamp(0.0, 1.0);
    let (dx, dy) = (off.0 - share * along.0, off.1 - share * along.1);
    (dx * dx + dy * dy).sqrt()
}
