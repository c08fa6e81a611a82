use super::patch::Patch;

/// Bins along each of red, green and blue.
const BINS: usize = 16;
/// Prior mass of a bin, in pixels of either region; bins with less are not informative.
const UNSEEN: f32 = 1e-3;
/// The two regions of a patch.
const TARGET: usize = 0;
const AROUND: usize = 1;
/// Light intensities in which colours are compared: number of steps up and down, of this factor.
const N_GAINS: i32 = 3;
const GAIN_STEP: f32 = 1.2;

/// Ratio of a colour's frequency in the target to that in its surroundings. [Bertinetto et al. 2016]
/// ```math
/// p(c) = \frac{h_f(c)}{h_f(c) + h_b(c)}
/// ```
///
/// with the histograms of target and surroundings, each of sum 1 and blended over time as in [Andrade-Cetto 2005, Eq. 29].
#[derive(Clone, Debug)]
pub(in crate::correlation) struct ColorRatio {
    target: Vec<f32>,
    around: Vec<f32>,
}

impl ColorRatio {
    pub(in crate::correlation) fn new() -> Self {
        Self { target: vec![0.0; BINS.pow(3)], around: vec![0.0; BINS.pow(3)] }
    }

    /// Learns a patch with the target of `size` pixels in the middle; rate 1 replaces the previous histograms.
    pub(in crate::correlation) fn learn(&mut self, patch: &Patch, size: [f64; 2], rate: f32) {
        let mut counts = [vec![0.0_f32; BINS.pow(3)], vec![0.0_f32; BINS.pow(3)]];
        let mut totals = [0.0_f32; 2];
        for (region, pixel) in regions(patch, size) {
            counts[region][bin(pixel)] += 1.0;
            totals[region] += 1.0;
        }
        for (model, (counts, total)) in
            [&mut self.target, &mut self.around].into_iter().zip(counts.iter().zip(totals))
        {
            if total > 0.0 {
                for (value, count) in model.iter_mut().zip(counts) {
                    *value += rate * (count / total - *value);
                }
            }
        }
    }

    /// Agreement of the colours in the middle of a patch with those of the target of `size` pixels: the intersection of the histograms
    /// [Swain & Ballard 1991], at the light intensity that maximizes it.
    pub(in crate::correlation) fn agreement(&self, patch: &Patch, size: [f64; 2]) -> f64 {
        let inside: Vec<&[f32; 3]> =
            regions(patch, size).filter(|(region, _)| *region == TARGET).map(|(_, pixel)| pixel).collect();
        let in_light = |step: i32| {
            let gain = libm::powf(GAIN_STEP, step as f32);
            let mut counts = vec![0.0_f32; BINS.pow(3)];
            inside.iter().for_each(|pixel| counts[bin(&pixel.map(|value| gain * value))] += 1.0);
            let n = inside.len().max(1) as f32;
            counts.iter().zip(&self.target).map(|(count, share)| (count / n).min(*share)).sum::<f32>()
        };
        f64::from((-N_GAINS..=N_GAINS).map(in_light).fold(0.0, f32::max))
    }

    /// The ratio of every pixel; 1/2 for colours never seen.
    pub(in crate::correlation) fn of(&self, patch: &Patch) -> Vec<f32> {
        let floor = UNSEEN / patch.pixels.len() as f32;
        let ratio: Vec<f32> =
            self.target.iter().zip(&self.around).map(|(f, b)| (f + 0.5 * floor) / (f + b + floor)).collect();
        patch.pixels.iter().map(|pixel| ratio[bin(pixel)]).collect()
    }
}

/// The pixels of the target of `size` pixels in the middle of a patch, and of its surroundings. The corners of a box rarely belong to the
/// target, and its rim is ambiguous.
fn regions(patch: &Patch, size: [f64; 2]) -> impl Iterator<Item = (usize, &[f32; 3])> {
    let off = |i: usize, n: usize, side: f64| (i as f64 + 0.5 - n as f64 / 2.0).abs() / side * 2.0;
    patch.pixels.iter().enumerate().filter_map(move |(i, pixel)| {
        let (u, v) =
            (off(i % patch.width, patch.width, size[0]), off(i / patch.width, patch.height, size[1]));
        match (u.max(v), u * u + v * v) {
            (_, within) if within < 0.81 => Some((TARGET, pixel)),
            (outside, _) if outside > 1.1 && outside < 2.0 => Some((AROUND, pixel)),
            _ => None,
        }
    })
}

fn bin(pixel: &[f32; 3]) -> usize {
    pixel.iter().fold(0, |bin, &value| bin * BINS + (value as usize * BINS / 256).min(BINS - 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn colours_of_the_target_stand_out_from_those_around() {
        let color = |i: usize| {
            let off = |at: usize| (at as f64 + 0.5 - 20.0).abs();
            if off(i % 40) < 8.0 && off(i / 40) < 8.0 { [200.0, 40.0, 40.0] } else { [40.0, 90.0, 200.0] }
        };
        let patch = Patch { width: 40, height: 40, pixels: (0..1600).map(color).collect() };
        let mut colors = ColorRatio::new();
        colors.learn(&patch, [16.0, 16.0], 1.0);
        let ratio = colors.of(&patch);
        assert!(ratio[20 * 40 + 20] > 0.99 && ratio[0] < 0.01);
        let unseen = Patch { width: 1, height: 1, pixels: vec![[40.0, 200.0, 40.0]] };
        assert_eq!(colors.of(&unseen), [0.5]);
    }
    #[test]
    fn colours_agree_in_dimmer_light_and_those_around_do_not() {
        let patch = |target: [f32; 3]| {
            let off = |at: usize| (at as f64 + 0.5 - 20.0).abs();
            let color =
                |i: usize| if off(i % 40) < 8.0 && off(i / 40) < 8.0 { target } else { [40.0, 90.0, 200.0] };
            Patch { width: 40, height: 40, pixels: (0..1600).map(color).collect() }
        };
        let mut colors = ColorRatio::new();
        colors.learn(&patch([200.0, 40.0, 40.0]), [16.0, 16.0], 1.0);
        assert_abs_diff_eq!(colors.agreement(&patch([200.0, 40.0, 40.0]), [16.0, 16.0]), 1.0, epsilon = 1e-6);
        // 200 and 40 divided by 1.2 twice are 139 and 28, in other bins of 16 values.
        assert!(colors.agreement(&patch([139.0, 28.0, 28.0]), [16.0, 16.0]) > 0.99);
        assert_eq!(colors.agreement(&patch([40.0, 90.0, 200.0]), [16.0, 16.0]), 0.0);
    }
}
