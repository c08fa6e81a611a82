use super::bimodal::BimodalHistogram;
use super::edge::{GradientField, Rim};
use super::likelihood::{CueRatios, RatioSums};
use crate::TrackingError;
use crate::{ColorBinImage, RowSpans, SlidingHistogram};

/// Steps along an axis of a search; between two of them is searched again, pixel by pixel.
const STEPS: i64 = 8;

/// An ellipse that may be the head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    pub(super) center: [i64; 2],
    pub(super) semi_axes: [f64; 2],
    /// Histogram intersection, or the sum of the ratios.
    color: f64,
    /// Mean gradient across the rim, or the sum of the ratios.
    gradient: f64,
}

impl Candidate {
    /// The log-likelihood ratio, if the cues count by their ratios.
    pub(super) fn log_ratio(&self) -> f64 {
        self.color + self.gradient
    }
}

/// How the cues count.
pub(super) enum Cues<'a> {
    /// By their ratios.
    Ratios(&'a CueRatios, RatioSums),
    /// Histogram intersection and mean gradient, each scaled to its range, with this weight of the gradient.
    Fixed(&'a BimodalHistogram, f64),
}

/// A picture in which the head is searched.
pub(super) struct Search<'a> {
    pub(super) bins: &'a ColorBinImage,
    pub(super) field: &'a GradientField,
    pub(super) cues: Cues<'a>,
}

impl Search<'_> {
    /// The best ellipse of one of the sizes, at most `reach` pixels from `around`: first in steps of at most half a semi-axis, then pixel by
    /// pixel.
    pub(super) fn best(
        &self,
        around: [i64; 2],
        reach: i64,
        sizes: &[[f64; 2]],
    ) -> Result<Option<Candidate>, TrackingError> {
        let narrowest = sizes.iter().flatten().copied().fold(f64::INFINITY, f64::min);
        let step = (reach / STEPS).min((narrowest / 2.0) as i64).max(1);
        let Some(coarse) = self.better(self.candidates(around, reach, step, sizes)?) else { return Ok(None) };
        if step == 1 {
            return Ok(Some(coarse));
        }
        Ok(self.better(self.candidates(coarse.center, step, 1, &[coarse.semi_axes])?))
    }

    /// Ellipses on a grid; each histogram is updated from its neighbour's.
    fn candidates(
        &self,
        around: [i64; 2],
        reach: i64,
        step: i64,
        sizes: &[[f64; 2]],
    ) -> Result<Vec<Candidate>, TrackingError> {
        let n = reach / step;
        let mut candidates = Vec::new();
        for &semi_axes in sizes {
            let (spans, rim) = (RowSpans::ellipse(semi_axes)?, Rim::ellipse(semi_axes));
            let mut sliding = SlidingHistogram::new(self.bins, spans.clone(), around);
            for j in -n..=n {
                for i in -n..=n {
                    // alternate the direction, so that successive ellipses overlap
                    let i = if (j + n) % 2 == 0 { i } else { -i };
                    let center = [around[0] + i * step, around[1] + j * step];
                    if !self.contains(center) {
                        continue;
                    }
                    let (color, gradient) = match &self.cues {
                        Cues::Ratios(ratios, sums) => {
                            (sums.inside(&spans, center), ratios.of_rim(self.field, &rim, center))
                        }
                        Cues::Fixed(model, _) => {
                            sliding.move_to(center);
                            let n_pixels = n_inside(self.bins, &spans, center);
                            let color = model.intersection(sliding.histogram(), n_pixels);
                            (color, self.field.across(&rim, center))
                        }
                    };
                    candidates.push(Candidate { center, semi_axes, color, gradient });
                }
            }
        }
        Ok(candidates)
    }

    /// The highest sum of the ratios, or of both modules, each scaled to the range it has among the candidates. [Birchfield 1998]
    fn better(&self, candidates: Vec<Candidate>) -> Option<Candidate> {
        let scaled = |module: fn(&Candidate) -> f64| {
            let low = candidates.iter().map(module).fold(f64::INFINITY, f64::min);
            let high = candidates.iter().map(module).fold(f64::NEG_INFINITY, f64::max);
            move |candidate: &Candidate| {
                if high > low { (module(candidate) - low) / (high - low) } else { 0.0 }
            }
        };
        let (color, gradient) = (scaled(|c| c.color), scaled(|c| c.gradient));
        let score = |c: &Candidate| match self.cues {
            Cues::Ratios(..) => c.log_ratio(),
            Cues::Fixed(_, weight) => (1.0 - weight) * color(c) + weight * gradient(c),
        };
        candidates.iter().copied().max_by(|a, b| score(a).total_cmp(&score(b)))
    }

    fn contains(&self, center: [i64; 2]) -> bool {
        (0..self.bins.width() as i64).contains(&center[0])
            && (0..self.bins.height() as i64).contains(&center[1])
    }
}

/// Pixels of the picture under a shape about `center`.
pub(super) fn n_inside(bins: &ColorBinImage, spans: &RowSpans, center: [i64; 2]) -> usize {
    let (width, height) = (bins.width() as i64, bins.height() as i64);
    let row = |v: i64| {
        let columns = spans.columns(v).filter(|_| (0..height).contains(&(v + center[1]))).unwrap_or(0..0);
        ((columns.end + center[0]).min(width) - (columns.start + center[0]).max(0)).max(0) as usize
    };
    spans.rows().map(row).sum()
}
