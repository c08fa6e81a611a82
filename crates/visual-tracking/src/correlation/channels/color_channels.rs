use super::patch::Patch;

/// Soft colour classes: six hues, dark and bright without a hue.
pub(in crate::correlation) const N_COLOR: usize = 8;
const N_HUES: usize = 6;

/// The share of each colour class in cells of `cell × cell` pixels, and the mean grey value from 0 to 1, row by row.
pub(in crate::correlation) fn color_channels(patch: &Patch, cell: usize) -> Vec<([f32; N_COLOR], f32)> {
    let (columns, rows) = (patch.width / cell, patch.height / cell);
    let mut channels = vec![([0.0; N_COLOR], 0.0); columns * rows];
    let share = 1.0 / (cell * cell) as f32;
    for y in 0..rows * cell {
        let row = &patch.pixels[y * patch.width..][..columns * cell];
        for (x, pixel) in row.iter().enumerate() {
            let (classes, grey) = &mut channels[(y / cell) * columns + x / cell];
            *grey += share * (0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2]) / 255.0;
            add_classes(pixel, share, classes);
        }
    }
    channels
}

/// Adds `share` of a pixel to the classes: the coloured part to the two nearest hues, the rest to dark and bright.
#[inline(always)]
fn add_classes(&[r, g, b]: &[f32; 3], share: f32, classes: &mut [f32; N_COLOR]) {
    let (most, least) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = most - least;
    // adding a quarter of full scale suppresses the hue of dark pixels, which is noise
    let colored = (2.0 * chroma / (most + 64.0)).min(1.0);
    let bright = most / 255.0;
    classes[N_HUES] += share * (1.0 - colored) * (1.0 - bright);
    classes[N_HUES + 1] += share * (1.0 - colored) * bright;
    if chroma > 0.0 {
        let sector = if most == r {
            (g - b) / chroma + 6.0
        } else if most == g {
            (b - r) / chroma + 2.0
        } else {
            (r - g) / chroma + 4.0
        };
        let low = sector as usize;
        let towards = sector - low as f32;
        classes[low % N_HUES] += share * colored * (1.0 - towards);
        classes[(low + 1) % N_HUES] += share * colored * towards;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    #[test]
    fn every_pixel_is_shared_out_once() {
        let pixels: Vec<_> =
            (0..64).map(|i| [(i * 37 % 256) as f32, (i * 91 % 256) as f32, (i * 53 % 256) as f32]).collect();
        for (classes, grey) in color_channels(&Patch { width: 8, height: 8, pixels }, 4) {
            assert_abs_diff_eq!(classes.iter().sum::<f32>(), 1.0, epsilon = 1e-5);
            assert!((0.0..=1.0).contains(&grey));
        }
    }

    #[test]
    fn pure_colours_have_a_class_each() {
        let colors = [[255, 0, 0], [255, 255, 0], [0, 255, 0], [0, 255, 255], [0, 0, 255], [255, 0, 255]];
        for (class, color) in colors.into_iter().enumerate() {
            let pixels = vec![color.map(|v: u8| f32::from(v)); 16];
            let (classes, _) = color_channels(&Patch { width: 4, height: 4, pixels }, 4)[0];
            assert!(abs_diff_eq!(classes[class], 1.0, epsilon = 1e-5), "{class}: {classes:?}");
        }
    }
}
