use super::{ColorBinImage, ColorQuantizer};
use crate::mask::ones;

/// Which bins of a colour space are "on", one bit a bin.
///
/// ```
/// use wayfix_visual_tracking::{ColorBinSet, ColorQuantizer, ColorSpace};
/// let quantizer = ColorQuantizer::new(ColorSpace::Opponent, [16, 16, 16])?;
/// let set = ColorBinSet::from_points(&quantizer, [[0.5, 0.5, 0.1], [0.5, 0.5, 0.11], [f64::NAN, 0.5, 0.5]]);
/// assert_eq!(set.len(), 1);
/// assert_eq!(set.dilated(&quantizer).len(), 27);
/// # Ok::<(), wayfix_visual_tracking::TrackingError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColorBinSet {
    n_bins: usize,
    words: Vec<u64>,
}

impl ColorBinSet {
    /// No bin is on.
    pub fn empty(quantizer: &ColorQuantizer) -> Self {
        Self::of_size(quantizer.n_bins())
    }

    /// The bins that contain at least one point of the colour space; NaN points are ignored.
    pub fn from_points(quantizer: &ColorQuantizer, points: impl IntoIterator<Item = [f64; 3]>) -> Self {
        let mut set = Self::empty(quantizer);
        for bin in points.into_iter().filter_map(|point| quantizer.bin_of_point(point)) {
            set.insert(bin);
        }
        set
    }

    /// The bins that a picture has.
    pub fn of_image(image: &ColorBinImage) -> Self {
        let mut set = Self::of_size(image.n_bins());
        image.bins().iter().for_each(|&bin| set.insert(bin));
        set
    }

    /// The bins for which `on` is true, among those of a quantizer.
    pub fn from_fn(quantizer: &ColorQuantizer, on: impl FnMut(u16) -> bool) -> Self {
        Self::from_predicate(quantizer.n_bins(), on)
    }

    /// Number of bins, on or off.
    pub fn n_bins(&self) -> usize {
        self.n_bins
    }

    /// Number of bins that are on.
    pub fn len(&self) -> usize {
        self.words.iter().map(|word| word.count_ones() as usize).sum()
    }

    /// Whether none is on.
    pub fn is_empty(&self) -> bool {
        self.words.iter().all(|&word| word == 0)
    }

    /// Switches a bin on; ignores a bin that does not exist.
    pub fn insert(&mut self, bin: u16) {
        if usize::from(bin) < self.n_bins {
            self.words[usize::from(bin / 64)] |= 1 << (bin % 64);
        }
    }

    /// Switches a bin off.
    pub fn remove(&mut self, bin: u16) {
        if let Some(word) = self.words.get_mut(usize::from(bin / 64)) {
            *word &= !(1 << (bin % 64));
        }
    }

    /// Whether a bin is on.
    pub fn contains(&self, bin: u16) -> bool {
        self.words.get(usize::from(bin / 64)).is_some_and(|word| word >> (bin % 64) & 1 == 1)
    }

    /// The bins that are on, in order.
    pub fn iter(&self) -> impl Iterator<Item = u16> {
        self.words.iter().enumerate().flat_map(|(i, &word)| ones(word).map(move |bit| (64 * i + bit) as u16))
    }

    /// The set and all bins adjacent to it, also at edges and corners; hues wrap around. `quantizer` must be the one of the bins.
    pub fn dilated(&self, quantizer: &ColorQuantizer) -> Self {
        let mut set = self.clone();
        for axis in 0..3 {
            let n = quantizer.bins()[axis];
            let stride: usize = quantizer.bins()[axis + 1..].iter().product();
            let circular = quantizer.space().is_circular(axis);
            for bin in set.clone().iter().map(usize::from) {
                let at = bin / stride % n;
                for (moved, inside) in [(at + 1, at + 1 < n), ((at + n - 1) % n, at > 0)] {
                    if inside || circular {
                        set.insert((bin - at * stride + moved % n * stride) as u16);
                    }
                }
            }
        }
        set
    }

    pub(super) fn from_predicate(n_bins: usize, mut on: impl FnMut(u16) -> bool) -> Self {
        let mut set = Self::of_size(n_bins);
        (0..n_bins).map(|bin| bin as u16).filter(|&bin| on(bin)).for_each(|bin| set.insert(bin));
        set
    }

    fn of_size(n_bins: usize) -> Self {
        Self { n_bins, words: vec![0; n_bins.div_ceil(64)] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ColorSpace;

    #[test]
    fn dilation_reaches_the_neighbours_on_every_axis_and_no_other() {
        for space in [ColorSpace::Opponent, ColorSpace::Hsi] {
            let quantizer = ColorQuantizer::new(space, [5, 1, 7]).unwrap();
            for center in 0..quantizer.n_bins() as u16 {
                let mut set = ColorBinSet::empty(&quantizer);
                set.insert(center);
                let at = quantizer.axes_of_bin(center);
                let near = |bin| {
                    let apart = |axis: usize| at[axis].abs_diff(quantizer.axes_of_bin(bin)[axis]);
                    (apart(0) <= 1 || space == ColorSpace::Hsi && apart(0) == 4) && apart(2) <= 1
                };
                assert_eq!(
                    set.dilated(&quantizer),
                    ColorBinSet::from_fn(&quantizer, near),
                    "{space:?} {at:?}"
                );
            }
        }
    }

    #[test]
    fn bins_go_in_and_out_and_those_beyond_the_last_never_in() {
        let quantizer = ColorQuantizer::new(ColorSpace::Rgb, [3, 5, 7]).unwrap();
        let mut set = ColorBinSet::empty(&quantizer);
        for bin in [0, 63, 64, 104, 105, 127, 128, u16::MAX] {
            set.insert(bin);
        }
        assert_eq!(set.iter().collect::<Vec<_>>(), [0, 63, 64, 104]);
        set.remove(63);
        set.remove(u16::MAX);
        assert!(set.contains(64) && !set.contains(63) && !set.contains(u16::MAX) && set.len() == 3);
    }
}
