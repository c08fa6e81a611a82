use crate::TrackingError;
use crate::{ColorHistogram, ColorQuantizer};

/// Share of a candidate below which a mode is not in sight, and does not adapt.
const IN_SIGHT: f64 = 0.05;
/// Share of its mode below which a bin is forgotten.
const FORGOTTEN: f64 = 1e-5;

/// The colours of a head in one or two modes, such as skin and hair, each a distribution over its own bins. The proportion of the modes
/// changes when the head turns and is not part of the model.
#[derive(Clone, Debug)]
pub(super) struct BimodalHistogram {
    /// The mode that a bin belongs to: that of the nearer mean colour.
    mode_of_bin: Vec<u8>,
    /// Share of each bin in its mode.
    shares: Vec<f64>,
    /// The bins with a share.
    known: Vec<usize>,
    bimodal: bool,
}

impl BimodalHistogram {
    /// Builds the model from the counts of a head's colours; `bimodal` splits them by 2-means.
    pub(super) fn new(
        quantizer: &ColorQuantizer,
        head: &[f64],
        bimodal: bool,
    ) -> Result<Self, TrackingError> {
        if head.iter().sum::<f64>() <= 0.0 {
            return Err(TrackingError::Empty { what: "pixels of the head" });
        }
        let mode_of_bin = if bimodal { two_means(quantizer, head) } else { vec![0; quantizer.n_bins()] };
        let shares = vec![0.0; quantizer.n_bins()];
        let mut model = Self { mode_of_bin, shares, known: Vec::new(), bimodal };
        let masses = model.masses(head);
        for ((share, &mode), count) in model.shares.iter_mut().zip(&model.mode_of_bin).zip(head) {
            let mass = masses[usize::from(mode)];
            *share = if mass > 0.0 { count / mass } else { 0.0 };
        }
        model.forget();
        Ok(model)
    }

    /// Histogram intersection of a candidate of `n_pixels` with the model whose modes have the candidate's proportion, from 0 to 1:
    ///
    /// ```math
    /// φ(C) = \frac{\sum_i \min(C(i), m_{k(i)} M(i))}{\sum_i C(i)}, \qquad m_k = \sum_{i \in k} C(i)
    /// ```
    ///
    /// over the bins of the model. With one mode, of all pixels, this is [Andrade-Cetto 2005, Eq. 28].
    pub(super) fn intersection(&self, candidate: &ColorHistogram, n_pixels: usize) -> f64 {
        let counts = candidate.counts();
        let mut masses = [n_pixels as f64, 0.0];
        if self.bimodal {
            masses = [0.0; 2];
            self.known.iter().for_each(|&bin| masses[usize::from(self.mode_of_bin[bin])] += counts[bin]);
        }
        let shared =
            |&bin: &usize| counts[bin].min(masses[usize::from(self.mode_of_bin[bin])] * self.shares[bin]);
        self.known.iter().map(shared).sum::<f64>() / n_pixels.max(1) as f64
    }

    /// $`M_k = (1 − a) M_{k−1} + a C_k`$ [Andrade-Cetto 2005, Eq. 29], for each mode that is in sight.
    pub(super) fn adapt(&mut self, candidate: &[f64], rate: f64) {
        let masses = self.masses(candidate);
        let total = masses[0] + masses[1];
        for ((share, &mode), count) in self.shares.iter_mut().zip(&self.mode_of_bin).zip(candidate) {
            let mass = masses[usize::from(mode)];
            if mass > IN_SIGHT * total {
                *share += rate * (count / mass - *share);
            }
        }
        self.forget();
    }

    fn forget(&mut self) {
        self.known = (0..self.shares.len()).filter(|&bin| self.shares[bin] > FORGOTTEN).collect();
    }

    fn masses(&self, counts: &[f64]) -> [f64; 2] {
        let mut masses = [0.0; 2];
        for (count, &mode) in counts.iter().zip(&self.mode_of_bin) {
            masses[usize::from(mode)] += count;
        }
        masses
    }
}

/// Assigns every bin to the nearer of two means, which start at the darkest and the brightest colours; at most ten iterations.
fn two_means(quantizer: &ColorQuantizer, counts: &[f64]) -> Vec<u8> {
    let centers: Vec<[f64; 3]> = (0..counts.len()).map(|bin| quantizer.center_of_bin(bin as u16)).collect();
    let occupied = || centers.iter().zip(counts).filter(|(_, count)| **count > 0.0);
    let darkest = occupied().min_by(|a, b| a.0[2].total_cmp(&b.0[2]));
    let brightest = occupied().max_by(|a, b| a.0[2].total_cmp(&b.0[2]));
    let (Some((&dark, _)), Some((&bright, _))) = (darkest, brightest) else { return vec![0; counts.len()] };
    let mut means = [dark, bright];
    for _ in 0..10 {
        let mut sums = [[0.0; 4]; 2];
        for (center, count) in occupied() {
            let sum = &mut sums[usize::from(nearer(&means, center))];
            (0..3).for_each(|axis| sum[axis] += count * center[axis]);
            sum[3] += count;
        }
        for (mean, sum) in means.iter_mut().zip(&sums) {
            if sum[3] > 0.0 {
                *mean = [sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]];
            }
        }
    }
    centers.iter().map(|center| nearer(&means, center)).collect()
}

fn nearer(means: &[[f64; 3]; 2], center: &[f64; 3]) -> u8 {
    let squared = |mean: &[f64; 3]| -> f64 { mean.iter().zip(center).map(|(a, b)| (a - b).powi(2)).sum() };
    u8::from(squared(&means[1]) < squared(&means[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::RgbImage;
    use crate::{ColorBinImage, ColorSpace};
    use approx::assert_abs_diff_eq;

    const SKIN: [u8; 3] = [220, 160, 130];
    const HAIR: [u8; 3] = [60, 40, 30];

    fn histogram(quantizer: &ColorQuantizer, colors: &[[u8; 3]]) -> ColorHistogram {
        let bytes = colors.iter().flatten().copied().collect();
        let picture = RgbImage::from_raw(colors.len() as u32, 1, bytes).expect("3 bytes a pixel");
        ColorHistogram::of_image(&ColorBinImage::new(quantizer, &picture).unwrap())
    }

    #[test]
    fn hair_alone_is_still_the_head_but_a_wall_is_not() {
        let quantizer = ColorQuantizer::new(ColorSpace::Opponent, [32, 32, 8]).unwrap();
        let front = histogram(&quantizer, &[SKIN, SKIN, SKIN, HAIR]);
        let back = histogram(&quantizer, &[HAIR; 4]);
        let wall = histogram(&quantizer, &[[90, 140, 200]; 4]);
        let two = BimodalHistogram::new(&quantizer, front.counts(), true).unwrap();
        assert_abs_diff_eq!(two.intersection(&back, 4), 1.0, epsilon = 1e-12);
        assert!(two.intersection(&wall, 4) < 1e-12);
        // one mode has a quarter hair: the minimum with all hair is a quarter
        let one = BimodalHistogram::new(&quantizer, front.counts(), false).unwrap();
        assert_abs_diff_eq!(one.intersection(&back, 4), 0.25, epsilon = 1e-12);
        assert_abs_diff_eq!(one.intersection(&front, 4), 1.0, epsilon = 1e-12);
    }

    #[test]
    fn adaptation_moves_the_visible_mode_and_keeps_the_other() {
        let quantizer = ColorQuantizer::new(ColorSpace::Opponent, [32, 32, 8]).unwrap();
        let mut model =
            BimodalHistogram::new(&quantizer, histogram(&quantizer, &[SKIN, HAIR]).counts(), true).unwrap();
        let paler = [250, 200, 170];
        model.adapt(histogram(&quantizer, &[paler; 2]).counts(), 0.25);
        assert_abs_diff_eq!(model.intersection(&histogram(&quantizer, &[paler]), 1), 0.25, epsilon = 1e-12);
        assert_abs_diff_eq!(model.intersection(&histogram(&quantizer, &[SKIN]), 1), 0.75, epsilon = 1e-12);
        assert_abs_diff_eq!(model.intersection(&histogram(&quantizer, &[HAIR]), 1), 1.0, epsilon = 1e-12);
    }
}
