use super::fourier::Fourier;
use super::lane::{ComplexLane, LANES, Lane};

/// Feature channels over a square grid of cells, in groups of eight: row by row, group after group.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::correlation) struct Planes {
    pub(in crate::correlation) side: usize,
    pub(in crate::correlation) cells: Vec<Lane>,
}

/// Spectrum of [`Planes`]: the columns $`k_x ≤ n/2`$ in order; the rest are their conjugates.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::correlation) struct Spectrum {
    pub(in crate::correlation) bins: Vec<ComplexLane>,
    n_per_group: usize,
}

/// Two-dimensional real transforms over a square grid.
#[derive(Clone, Debug)]
pub(in crate::correlation) struct PlaneFourier {
    side: usize,
    fourier: Fourier,
}

impl Planes {
    /// Zero everywhere, in `n_groups` groups of eight channels.
    pub(in crate::correlation) fn zeros(side: usize, n_groups: usize) -> Self {
        Self { side, cells: vec![[0.0; LANES]; n_groups * side * side] }
    }

    /// The groups, one plane each.
    pub(in crate::correlation) fn groups_mut(&mut self) -> impl Iterator<Item = &mut [Lane]> {
        self.cells.chunks_exact_mut(self.side * self.side)
    }
}

impl Spectrum {
    /// The groups, one half-plane each.
    pub(in crate::correlation) fn groups(&self) -> impl Iterator<Item = &[ComplexLane]> {
        self.bins.chunks_exact(self.n_per_group)
    }

    /// The groups, one half-plane each.
    pub(in crate::correlation) fn groups_mut(&mut self) -> impl Iterator<Item = &mut [ComplexLane]> {
        self.bins.chunks_exact_mut(self.n_per_group)
    }
}

impl PlaneFourier {
    /// For grids of an even `side` without prime factors but 2 and 3.
    pub(in crate::correlation) fn new(side: usize) -> Self {
        Self { side, fourier: Fourier::new(side) }
    }

    /// Frequencies that are stored.
    pub(in crate::correlation) fn n_bins(&self) -> usize {
        (self.side / 2 + 1) * self.side
    }

    /// `bins` as a spectrum.
    pub(in crate::correlation) fn spectrum(&self, bins: Vec<ComplexLane>) -> Spectrum {
        Spectrum { bins, n_per_group: self.n_bins() }
    }

    /// From cells to frequencies.
    pub(in crate::correlation) fn forward(&self, planes: &Planes) -> Spectrum {
        let n_groups = planes.cells.len() / (self.side * self.side);
        let mut bins = vec![ComplexLane::default(); n_groups * self.n_bins()];
        let mut scratch = vec![ComplexLane::default(); 2 * self.side];
        let groups = planes.cells.chunks_exact(self.side * self.side);
        for (cells, bins) in groups.zip(bins.chunks_exact_mut(self.n_bins())) {
            self.forward_group(cells, bins, &mut scratch);
        }
        self.spectrum(bins)
    }

    /// From frequencies to cells.
    pub(in crate::correlation) fn backward(&self, spectrum: &Spectrum) -> Planes {
        let n_groups = spectrum.bins.len() / self.n_bins();
        let mut planes = Planes::zeros(self.side, n_groups);
        let mut columns = vec![ComplexLane::default(); self.n_bins()];
        let mut scratch = vec![ComplexLane::default(); 2 * self.side];
        for (bins, cells) in spectrum.groups().zip(planes.groups_mut()) {
            self.backward_group(bins, cells, &mut columns, &mut scratch);
        }
        planes
    }

    /// Two rows at a time, as real and imaginary part of one transform; then the columns.
    pub(in crate::correlation) fn forward_group(
        &self,
        cells: &[Lane],
        bins: &mut [ComplexLane],
        scratch: &mut [ComplexLane],
    ) {
        let n = self.side;
        let (line, scratch) = scratch.split_at_mut(n);
        for y in (0..n).step_by(2) {
            for (x, value) in line.iter_mut().enumerate() {
                *value = ComplexLane { re: cells[y * n + x], im: cells[(y + 1) * n + x] };
            }
            self.fourier.forward(line, scratch);
            for k in 0..=n / 2 {
                let (a, b) = (line[k], line[(n - k) % n]);
                let mirrored = ComplexLane { re: b.re, im: b.im.map(|v| -v) };
                bins[k * n + y] = (a + mirrored).scaled(0.5);
                bins[k * n + y + 1] = (a - mirrored).over_i().scaled(0.5);
            }
        }
        for column in bins.chunks_exact_mut(n) {
            self.fourier.forward(column, scratch);
        }
    }

    /// The inverse of [`forward_group`](Self::forward_group).
    pub(in crate::correlation) fn backward_group(
        &self,
        bins: &[ComplexLane],
        cells: &mut [Lane],
        columns: &mut [ComplexLane],
        scratch: &mut [ComplexLane],
    ) {
        let n = self.side;
        let (line, scratch) = scratch.split_at_mut(n);
        for (bins, column) in bins.chunks_exact(n).zip(columns.chunks_exact_mut(n)) {
            for (value, bin) in column.iter_mut().zip(bins) {
                *value = bin.swapped();
            }
            self.fourier.forward(column, scratch);
        }
        let scale = 1.0 / (n * n) as f32;
        for y in (0..n).step_by(2) {
            for (k, value) in line.iter_mut().enumerate() {
                // columns hold the swapped values: (im, re) of a row's frequency
                let mirror = if k <= n / 2 { k } else { n - k };
                let (a, b) = (columns[mirror * n + y], columns[mirror * n + y + 1]);
                let sign = if k <= n / 2 { 1.0 } else { -1.0 };
                for c in 0..LANES {
                    value.im[c] = a.im[c] - sign * b.re[c];
                    value.re[c] = sign * a.re[c] + b.im[c];
                }
            }
            self.fourier.forward(line, scratch);
            for (x, value) in line.iter().enumerate() {
                cells[y * n + x] = value.im.map(|v| v * scale);
                cells[(y + 1) * n + x] = value.re.map(|v| v * scale);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{abs_diff_eq, assert_abs_diff_eq};

    fn planes(side: usize) -> Planes {
        let mut planes = Planes::zeros(side, 2);
        for (i, cell) in planes.cells.iter_mut().enumerate() {
            *cell = std::array::from_fn(|c| ((i * 31 + c * 7) % 19) as f32 - 8.0);
        }
        planes
    }

    #[test]
    fn there_and_back_is_the_same() {
        for side in [2, 6, 12, 48] {
            let fourier = PlaneFourier::new(side);
            let planes = planes(side);
            let back = fourier.backward(&fourier.forward(&planes));
            for (a, b) in planes.cells.iter().flatten().zip(back.cells.iter().flatten()) {
                assert_abs_diff_eq!(a, b, epsilon = 1e-4); // f32 rounding of numbers below 10
            }
        }
    }

    #[test]
    fn a_wave_is_one_frequency() {
        let (side, kx, ky) = (12, 2, 5);
        let mut planes = Planes::zeros(side, 1);
        for y in 0..side {
            for x in 0..side {
                let angle = std::f64::consts::TAU * ((kx * x + ky * y) % side) as f64 / side as f64;
                planes.cells[y * side + x][3] = angle.cos() as f32;
            }
        }
        let spectrum = PlaneFourier::new(side).forward(&planes);
        for (i, bin) in spectrum.bins.iter().enumerate() {
            let expected = if i == kx * side + ky { (side * side) as f32 / 2.0 } else { 0.0 };
            assert!(abs_diff_eq!(bin.re[3], expected, epsilon = 1e-3) && bin.im[3].abs() < 1e-3, "{i}");
        }
    }
}
