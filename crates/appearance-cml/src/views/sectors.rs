use super::{IntensityScale, Panorama};

/// The mean grey value, weighed by a tone, of `n_rings` × `n_sectors` cells of a panorama, ring by ring from the top.
///
/// Where rows or columns do not divide evenly, those on a border count in part to both sides.
pub(super) fn cell_means(
    panorama: &Panorama,
    n_rings: usize,
    n_sectors: usize,
    tone: IntensityScale,
) -> Vec<f64> {
    let weigh: Vec<f64> = (0..=255).map(|grey| tone.of(f64::from(grey))).collect();
    let sectors = Shares::new(panorama.n_columns(), n_sectors);
    let rings = Shares::new(panorama.n_rows(), n_rings);
    let mut cells = vec![0.0; n_rings * n_sectors];
    let mut row_means = vec![0.0; n_sectors];
    for (row, pixels) in panorama.pixels().chunks_exact(panorama.n_columns()).enumerate() {
        row_means.fill(0.0);
        for (column, pixel) in pixels.iter().enumerate() {
            sectors.spread(column, weigh[grey(*pixel)], |sector, value| row_means[sector] += value);
        }
        rings.spread(row, 1.0, |ring, share| {
            let cells = &mut cells[ring * n_sectors..][..n_sectors];
            cells.iter_mut().zip(&row_means).for_each(|(cell, mean)| *cell += share * mean);
        });
    }
    cells
}

/// [ITU-R BT.601], rounded: a table over 256 values then does for the tone.
fn grey([red, green, blue]: [u8; 3]) -> usize {
    let sum = 19_595 * u32::from(red) + 38_470 * u32::from(green) + 7_471 * u32::from(blue);
    ((sum + 32_768) >> 16) as usize
}

/// Which of `n_parts` equal parts each of `n` pixels belongs to, and with what share of the part's mean.
struct Shares {
    n: usize,
    n_parts: usize,
}

impl Shares {
    fn new(n: usize, n_parts: usize) -> Self {
        Self { n, n_parts }
    }

    /// In units in which a pixel is `n_parts` long and a part `n`: everything stays whole.
    fn spread(&self, pixel: usize, value: f64, mut add: impl FnMut(usize, f64)) {
        let (mut from, to) = (pixel * self.n_parts, (pixel + 1) * self.n_parts);
        while from < to {
            let part = from / self.n;
            let until = to.min((part + 1) * self.n);
            add(part, value * (until - from) as f64 / self.n as f64);
            from = until;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn greys(values: &[u8], n_columns: usize) -> Panorama {
        let bytes = values.iter().flat_map(|&value| [value; 3]).collect();
        Panorama::from_rgb(n_columns, values.len() / n_columns, bytes).unwrap()
    }

    #[test]
    fn cells_are_means_of_what_they_cover() {
        let panorama = greys(&[10, 20, 30, 40, 50, 60, 70, 80], 4);
        assert_eq!(
            cell_means(&panorama, 1, 2, IntensityScale::Linear),
            [(10.0 + 20.0 + 50.0 + 60.0) / 4.0, 55.0]
        );
        assert_eq!(
            cell_means(&panorama, 2, 4, IntensityScale::Linear),
            [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0]
        );
    }

    #[test]
    fn a_pixel_on_a_border_counts_on_both_sides() {
        let cells = cell_means(&greys(&[30, 60, 90], 3), 1, 2, IntensityScale::Linear);
        assert_eq!(cells, [(30.0 + 60.0 / 2.0) / 1.5, (60.0 / 2.0 + 90.0) / 1.5]);
    }
}
