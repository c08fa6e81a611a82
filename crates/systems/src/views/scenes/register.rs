use rayon::prelude::*;
use wayfix_condensation::{GrayImage, RgbImage, grey};

/// Step between compared pixels, in both directions.
const STRIDE: usize = 4;

/// Mean camera shift between two images of one size: `real` shows at `(x, y)` what `learned` shows at
/// `(x + dx, y + dy)`. The shift, in whole pixels up to `reach` in each direction, maximizes the correlation of the grey values.
///
/// ```
/// use wayfix_systems::views::mean_shift;
/// use wayfix_condensation::{LightChange, RgbImage, shifted};
/// let wave = |i: usize| (120.0 + 60.0 * ((i % 90) as f64 / 9.0).sin() + 40.0 * ((i / 90) as f64 / 7.0).cos()) as u8;
/// let learned = RgbImage::from_raw(90, 80, (0..90 * 80).flat_map(|i| [wave(i); 3]).collect()).expect("3 bytes a pixel");
/// let real = shifted(&LightChange { gain: 0.8, offset: 10.0, gamma: 1.0 }.apply(&learned)?, 5, -3);
/// assert_eq!(mean_shift(&learned, &real, 8), (5, -3));
/// # Ok::<(), wayfix_condensation::CondensationError>(())
/// ```
pub fn mean_shift(learned: &RgbImage, real: &RgbImage, reach: usize) -> (i32, i32) {
    let (learned, real) = (grey(learned), grey(real));
    let width = learned.width().min(real.width()) as usize;
    let height = learned.height().min(real.height()) as usize;
    // At least half of each image side must overlap.
    let reach = |length: usize| reach.min(length / 2) as i32;
    let best_of_row = |dy: i32| {
        let alike = |dx: i32| (correlation(&learned, &real, (width, height), (dx, dy)), (dx, dy));
        (-reach(width)..=reach(width)).map(alike).max_by(better)
    };
    let rows: Vec<i32> = (-reach(height)..=reach(height)).collect();
    let best = rows.into_par_iter().filter_map(best_of_row).collect::<Vec<_>>().into_iter().max_by(better);
    best.map_or((0, 0), |(_, shift)| shift)
}

type Scored = (f64, (i32, i32));

/// Orders by correlation; of equal ones the shorter shift wins.
fn better(a: &Scored, b: &Scored) -> std::cmp::Ordering {
    let length = |(dx, dy): (i32, i32)| dx * dx + dy * dy;
    a.0.total_cmp(&b.0).then(length(b.1).cmp(&length(a.1)))
}

/// Pearson's correlation over the overlap; −1 if an image has no contrast.
fn correlation(learned: &GrayImage, real: &GrayImage, size: (usize, usize), (dx, dy): (i32, i32)) -> f64 {
    let inside = |by: i32, length: usize| {
        let (start, end) = ((-by).max(0) as usize, length - by.max(0) as usize);
        (start..end).step_by(STRIDE)
    };
    let (learned_width, real_width) = (learned.width() as usize, real.width() as usize);
    let (mut n, mut a, mut b, mut aa, mut bb, mut ab) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
    for y in inside(dy, size.1) {
        let there = y.saturating_add_signed(dy as isize) * learned_width;
        for x in inside(dx, size.0) {
            let from = f64::from(learned.as_raw()[there + x.saturating_add_signed(dx as isize)]);
            let to = f64::from(real.as_raw()[y * real_width + x]);
            n += 1.0;
            a += from;
            b += to;
            aa += from * from;
            bb += to * to;
            ab += from * to;
        }
    }
    let variances = (n * aa - a * a) * (n * bb - b * b);
    if variances > 0.0 { (n * ab - a * b) / variances.sqrt() } else { -1.0 }
}
