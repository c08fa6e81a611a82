use std::f32::consts::PI;

use super::patch::Patch;

/// Signed orientations.
const N_SIGNED: usize = 18;
const N_UNSIGNED: usize = N_SIGNED / 2;
/// Channels of a cell: signed and unsigned orientations, and the energy against each of the four blocks around it.
pub(in crate::correlation) const N_GRADIENT: usize = N_SIGNED + N_UNSIGNED + 4;
/// Upper bound of an orientation's share of a block's energy; higher contrast carries no information about shape.
const CLIP: f32 = 0.2;

/// Histograms of gradient orientations over cells of `cell × cell` pixels, contrast-normalized against four blocks of 2 × 2 cells.
/// [Felzenszwalb et al. 2010, sec. 6]
///
/// Row by row. Of the three colours, the one with the steepest gradient counts; a gradient is shared between the two nearest orientations
/// and the four nearest cells.
pub(in crate::correlation) fn gradient_channels(patch: &Patch, cell: usize) -> Vec<[f32; N_GRADIENT]> {
    let (columns, rows) = (patch.width / cell, patch.height / cell);
    let histograms = orientation_histograms(patch, cell, columns, rows);
    let energy: Vec<f32> = histograms
        .iter()
        .map(|h| (0..N_UNSIGNED).map(|o| (h[o] + h[o + N_UNSIGNED]).powi(2)).sum())
        .collect();
    let energy_at = |x: usize, y: usize| energy[y.min(rows - 1) * columns + x.min(columns - 1)];
    // the block whose cells are (x−1, y−1) … (x, y)
    let block = |x: usize, y: usize| {
        let (left, up) = (x.saturating_sub(1), y.saturating_sub(1));
        let sum = energy_at(left, up) + energy_at(x, up) + energy_at(left, y) + energy_at(x, y);
        1.0 / (sum + NOISE).sqrt()
    };
    let mut channels = vec![[0.0; N_GRADIENT]; columns * rows];
    for y in 0..rows {
        for x in 0..columns {
            let blocks = [block(x, y), block(x + 1, y), block(x, y + 1), block(x + 1, y + 1)];
            normalize(&histograms[y * columns + x], blocks, &mut channels[y * columns + x]);
        }
    }
    channels
}

/// Energy of a block below which its orientations are noise: gradients of about two grey levels.
const NOISE: f32 = 400.0;

fn normalize(histogram: &[f32; N_SIGNED], blocks: [f32; 4], channels: &mut [f32; N_GRADIENT]) {
    for o in 0..N_SIGNED {
        for (b, scale) in blocks.iter().enumerate() {
            let value = (histogram[o] * scale).min(CLIP);
            channels[o] += 0.5 * value;
            channels[N_SIGNED + N_UNSIGNED + b] += 0.2357 * value;
        }
    }
    for o in 0..N_UNSIGNED {
        let sum = histogram[o] + histogram[o + N_UNSIGNED];
        channels[N_SIGNED + o] = blocks.iter().map(|scale| 0.5 * (sum * scale).min(CLIP)).sum();
    }
}

fn orientation_histograms(patch: &Patch, cell: usize, columns: usize, rows: usize) -> Vec<[f32; N_SIGNED]> {
    let mut histograms = vec![[0.0; N_SIGNED]; columns * rows];
    let (width, height) = (columns * cell, rows * cell);
    let sides: Vec<_> = (0..width).map(|x| neighbours(x, cell, columns)).collect();
    for y in 0..height {
        let (up, down) = (y.saturating_sub(1), (y + 1).min(patch.height - 1));
        let (top, bottom) = neighbours(y, cell, rows);
        for (x, &(west, east)) in sides.iter().enumerate() {
            let (left, right) = (x.saturating_sub(1), (x + 1).min(patch.width - 1));
            let at = |x: usize, y: usize| &patch.pixels[y * patch.width + x];
            let (gx, gy) = steepest(at(left, y), at(right, y), at(x, up), at(x, down));
            let magnitude = (gx * gx + gy * gy).sqrt();
            if magnitude <= 0.0 {
                continue;
            }
            let turn = angle(gx, gy) * (N_SIGNED as f32 / (2.0 * PI));
            let whole = turn as usize;
            let share = turn - whole as f32;
            let (low, high) = (whole % N_SIGNED, (whole + 1) % N_SIGNED);
            for (row, row_share) in [top, bottom] {
                for (column, column_share) in [west, east] {
                    let histogram = &mut histograms[row * columns + column];
                    let weight = magnitude * row_share * column_share;
                    histogram[low] += weight * (1.0 - share);
                    histogram[high] += weight * share;
                }
            }
        }
    }
    histograms
}

/// The two cells nearest to a pixel and their shares; at the border the only cell gets both.
#[inline(always)]
fn neighbours(pixel: usize, cell: usize, n_cells: usize) -> ((usize, f32), (usize, f32)) {
    let at = (pixel as f32 + 0.5) / cell as f32 + 0.5; // in cells, one too many so that it is positive
    let whole = at as usize;
    let share = at - whole as f32;
    ((whole.max(1) - 1, 1.0 - share), (whole.min(n_cells - 1), share))
}

#[inline(always)]
fn steepest(left: &[f32; 3], right: &[f32; 3], up: &[f32; 3], down: &[f32; 3]) -> (f32, f32) {
    let gradient = |c: usize| (right[c] - left[c], down[c] - up[c]);
    let energy = |(gx, gy): (f32, f32)| gx * gx + gy * gy;
    let (mut best, mut most) = (gradient(1), energy(gradient(1)));
    for c in [0, 2] {
        if energy(gradient(c)) > most {
            (best, most) = (gradient(c), energy(gradient(c)));
        }
    }
    best
}

/// The direction of a vector from 0 to 2π, accurate to 0.004 rad, far below the width of an orientation bin.
#[inline(always)]
fn angle(x: f32, y: f32) -> f32 {
    let (small, large) = (x.abs().min(y.abs()), x.abs().max(y.abs()));
    let t = small / large;
    let octant = t * (0.25 * PI + 0.273 * (1.0 - t));
    let quadrant = if y.abs() > x.abs() { 0.5 * PI - octant } else { octant };
    let half = if x < 0.0 { PI - quadrant } else { quadrant };
    let full = if y < 0.0 { 2.0 * PI - half } else { half };
    full.clamp(0.0, 2.0 * PI)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn angles_are_those_of_the_arc_tangent() {
        for degree in 0..360 {
            let expected = (degree as f32).to_radians();
            let difference = (angle(expected.cos(), expected.sin()) - expected).abs();
            assert!(difference.min((difference - 2.0 * PI).abs()) < 0.005, "{degree}");
        }
    }

    #[test]
    fn an_edge_fills_its_own_orientation() {
        // brighter to the right: orientation 0, signed and unsigned
        let pixels = (0..32 * 32).map(|i| [if i % 32 < 16 { 40.0 } else { 200.0 }; 3]).collect();
        let channels = gradient_channels(&Patch { width: 32, height: 32, pixels }, 4);
        let cell = channels[4 * 8 + 4];
        let strongest = (0..N_SIGNED).max_by(|&a, &b| cell[a].total_cmp(&cell[b]));
        assert_eq!(strongest, Some(0));
        assert!((0..N_UNSIGNED).all(|o| cell[N_SIGNED] >= cell[N_SIGNED + o]));
    }

    #[test]
    fn half_the_light_is_the_same_shape() {
        let pixel = |i: usize| ((i * 7919) % 211) as f32;
        let patch = |gain: f32| Patch {
            width: 24,
            height: 16,
            pixels: (0..24 * 16).map(|i| [gain * pixel(i); 3]).collect(),
        };
        let (bright, dim) = (gradient_channels(&patch(1.0), 4), gradient_channels(&patch(0.5), 4));
        for (a, b) in bright.iter().flatten().zip(dim.iter().flatten()) {
            assert_abs_diff_eq!(a, b, epsilon = 0.01); // only the noise floor distinguishes them
        }
    }
}
