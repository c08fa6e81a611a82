use anyhow::{Context, Result, bail};

/// The class of balls.
const BALL: u32 = 0;
/// Scale of the inner ellipse of a ball that is used for its pixels.
const CORE: f64 = 0.75;
/// Balls with less than this many pixels across are all rim.
const MIN_DIAMETER: f64 = 12.0;
/// A box that ends this close to the border is cut by it, pixels.
const BORDER: f64 = 3.0;

/// An annotated object, pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ObjectBox {
    class: u32,
    left: f64,
    right: f64,
    top: f64,
    bottom: f64,
}

/// The inner ellipse of a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct BallCore {
    center: (f64, f64),
    radii: (f64, f64),
}

/// Reads `class cx cy w h` a line, in fractions of an image of `width` x `height` pixels.
pub(super) fn read_boxes(text: &str, width: u32, height: u32) -> Result<Vec<ObjectBox>> {
    let lines = text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty());
    lines.map(|(n, line)| read_box(line, width, height).with_context(|| format!("line {}", n + 1))).collect()
}

fn read_box(line: &str, width: u32, height: u32) -> Result<ObjectBox> {
    let mut words = line.split_whitespace();
    let class = words.next().context("empty")?.parse()?;
    let numbers = words.map(str::parse).collect::<Result<Vec<f64>, _>>()?;
    let [cx, cy, w, h] = numbers[..] else { bail!("{} numbers follow the class, expected 4", numbers.len()) };
    if !(numbers.iter().all(|x| x.is_finite()) && w > 0.0 && h > 0.0) {
        bail!("a box at ({cx}, {cy}) of size {w} x {h}");
    }
    let (width, height) = (f64::from(width), f64::from(height));
    Ok(ObjectBox {
        class,
        left: (cx - w / 2.0) * width,
        right: (cx + w / 2.0) * width,
        top: (cy - h / 2.0) * height,
        bottom: (cy + h / 2.0) * height,
    })
}

impl ObjectBox {
    pub(super) fn contains(&self, x: f64, y: f64) -> bool {
        self.left < x && x < self.right && self.top < y && y < self.bottom
    }

    /// The core of the ball in this box, if it is a ball and large enough, in an image of `width` x `height` pixels.
    pub(super) fn ball_core(&self, width: u32, height: u32) -> Option<BallCore> {
        let Self { class, mut left, mut right, top, mut bottom } = *self;
        if class != BALL {
            return None;
        }
        // No ball in these images is cut by the upper border.
        let (w, h) = (right - left, bottom - top);
        if bottom > f64::from(height) - BORDER {
            bottom = bottom.max(top + w);
        }
        if right > f64::from(width) - BORDER {
            right = right.max(left + h);
        } else if left < BORDER {
            left = left.min(right - h);
        }
        let (w, h) = (right - left, bottom - top);
        (w.min(h) >= MIN_DIAMETER).then_some(BallCore {
            center: (0.5 * (left + right), 0.5 * (top + bottom)),
            radii: (0.5 * CORE * w, 0.5 * CORE * h),
        })
    }
}

impl BallCore {
    pub(super) fn contains(&self, x: f64, y: f64) -> bool {
        let (dx, dy) = ((x - self.center.0) / self.radii.0, (y - self.center.1) / self.radii.1);
        dx * dx + dy * dy < 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn core(line: &str) -> Option<BallCore> {
        read_boxes(line, 600, 800).unwrap()[0].ball_core(600, 800)
    }

    #[test]
    fn a_whole_ball_is_its_shrunk_ellipse() {
        let ball = core("0 0.5 0.5 0.1 0.05").unwrap();
        assert_eq!((ball.center, ball.radii), ((300.0, 400.0), (22.5, 15.0)));
        assert!(ball.contains(322.0, 400.0) && !ball.contains(323.0, 400.0) && !ball.contains(318.0, 412.0));
    }

    #[test]
    fn a_ball_cut_by_the_border_is_continued_to_a_circle() {
        let ball = core("0 0.5 0.975 0.2 0.05").unwrap();
        assert_abs_diff_eq!(ball.center.1, 820.0, epsilon = 1e-9);
        assert_abs_diff_eq!(ball.radii.1, 45.0, epsilon = 1e-9);
        let ball = core("0 0.99 0.5 0.02 0.05").unwrap();
        assert_abs_diff_eq!(ball.center.0, 608.0, epsilon = 1e-9);
    }

    #[test]
    fn small_balls_and_other_things_have_no_core() {
        assert_eq!(core("0 0.5 0.5 0.1 0.01"), None);
        assert_eq!(core("1 0.5 0.5 0.1 0.1"), None);
    }

    #[test]
    fn lines_that_are_no_boxes_are_refused() {
        for bad in [
            "0 0.5 0.5 0.1",
            "0 0.5 0.5 0.1 -0.1",
            "ball 0.5 0.5 0.1 0.1",
            "0 nan 0.5 0.1 0.1",
            "0 1 1 1 1 1",
        ] {
            assert!(read_boxes(bad, 600, 800).is_err(), "{bad}");
        }
        assert_eq!(read_boxes("\n \n", 600, 800).unwrap(), []);
    }
}
