use std::sync::Arc;

use wayfix_color_map::MapRenderer;

use super::{acquisition::Effort, candidate::Candidate, hidden::or_hidden, search::Search};
use crate::{
    PixelSums, PrefixSumImage,
    likelihood::{JointLikelihood, log_within},
};

/// What one thread works with.
pub(super) struct Scratch {
    pub(super) projector: MapRenderer,
    joint: JointLikelihood,
    totals: Vec<PixelSums>,
    is_hidden: Vec<bool>,
}

impl Scratch {
    pub(super) fn new(search: &Search) -> Self {
        Self {
            projector: MapRenderer::new(Arc::clone(search.map), search.camera),
            joint: JointLikelihood::new(),
            totals: vec![PixelSums::default(); search.map.colors().len()],
            is_hidden: vec![false; search.shots.len()],
        }
    }
}

/// What the frames say for a candidate, each of which may be hidden.
impl Search<'_> {
    /// What frame `at` says alone, which in a light that is known is all that it says.
    pub(super) fn weigh_frame(
        &self,
        scratch: &mut Scratch,
        candidate: &mut Candidate,
        at: usize,
        effort: Effort,
    ) {
        if !self.is_light_known {
            return;
        }
        let (n_colors, n_members) = (self.map.colors().len(), self.light.bank.n_members());
        let sums = &candidate.sums[at * n_colors..][..n_colors];
        let hidden = self.params.hidden_views.usual();
        let within = self.log_within(sums);
        for member in 0..n_members {
            let value = self.log_likelihood(&mut scratch.joint, sums, within, member);
            // From afar nothing fits, so that all would be hidden: there it counts how badly.
            let value = if effort == Effort::Full { or_hidden(value, hidden) } else { value };
            candidate.by_frame[at * n_members + member] = value;
        }
    }

    /// Under a light that is not known yet, what all frames say together; under a known one they are independent.
    pub(super) fn score(&self, scratch: &mut Scratch, candidate: &mut Candidate, effort: Effort) {
        let n_members = self.light.bank.n_members();
        let mut best = f64::NEG_INFINITY;
        for member in 0..n_members {
            let value = if self.is_light_known {
                self.singly(scratch, candidate, member, effort)
            } else {
                self.jointly(scratch, candidate, member, effort)
            };
            candidate.log_likelihoods[member] = value;
            if value > best {
                best = value;
                candidate.is_hidden.copy_from_slice(&scratch.is_hidden);
            }
        }
        candidate.score = best + candidate.log_prior;
    }

    /// $`\sum_k \ln [(1 - h)\, p(z_k | x_k) + h]`$.
    fn singly(&self, scratch: &mut Scratch, candidate: &Candidate, member: usize, effort: Effort) -> f64 {
        let by_frame = candidate.by_frame[member..].iter().step_by(self.light.bank.n_members());
        // More likely hidden than not: h is more than half of the sum.
        let least = (2.0 * self.params.hidden_views.usual()).ln();
        scratch.is_hidden.clear();
        scratch.is_hidden.extend(by_frame.clone().map(|value| effort == Effort::Full && *value < least));
        by_frame.sum()
    }

    /// $`\ln \int \prod_{k ∉ H} p(z_k | x_k, θ)\, p(θ)\, dθ + |H| \ln h + (n - |H|) \ln (1 - h)`$, with those frames $`H`$ taken for hidden, one after
    /// the other, without which it is greater.
    fn jointly(&self, scratch: &mut Scratch, candidate: &Candidate, member: usize, effort: Effort) -> f64 {
        let Scratch { joint, totals, is_hidden, .. } = scratch;
        let hidden = self.params.hidden_views.usual();
        let (free, odds) = ((-hidden).ln_1p(), hidden.ln() - (-hidden).ln_1p());
        is_hidden.clear();
        is_hidden.resize(self.shots.len(), false);
        candidate.total(is_hidden, totals);
        let mut constant = self.shots.len() as f64 * free;
        let says = |joint: &mut JointLikelihood, totals: &[PixelSums]| {
            self.log_likelihood(joint, totals, self.log_within(totals), member)
        };
        let mut best = says(joint, totals) + constant;
        if effort == Effort::Coarse {
            return best;
        }
        loop {
            constant += odds;
            let mut hide = None;
            for (at, frame) in candidate.frames(totals.len()).enumerate().filter(|(at, _)| !is_hidden[*at]) {
                totals.iter_mut().zip(frame).for_each(|(total, sums)| total.remove(sums));
                let value = says(joint, totals) + constant;
                totals.iter_mut().zip(frame).for_each(|(total, sums)| total.add(sums));
                if value > best {
                    (best, hide) = (value, Some(at));
                }
            }
            let Some(at) = hide else { return best };
            is_hidden[at] = true;
            candidate.total(is_hidden, totals);
        }
    }

    /// What sums say of one member of the light, of which `within` is what they say whatever the light is.
    fn log_likelihood(
        &self,
        joint: &mut JointLikelihood,
        sums: &[PixelSums],
        within: f64,
        member: usize,
    ) -> f64 {
        let filter = self.light.bank.member(member);
        let value =
            within + joint.log_innovation(sums, filter, &self.params.pixels, &self.noise, self.n_pixels());
        if value.is_nan() { f64::NEG_INFINITY } else { value }
    }

    fn log_within(&self, sums: &[PixelSums]) -> f64 {
        log_within(sums, &self.params.pixels, &self.noise, self.n_pixels())
    }

    fn n_pixels(&self) -> usize {
        self.frames.first().map_or(1, PrefixSumImage::n_pixels)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector, Vector3};
    use wayfix_color_map::{ColorId, ColorMap, ColoredShape, PinholeCamera};
    use wayfix_estimation_traits::{LieGroup, Pose2, Pose3};
    use wayfix_gaussian_core::Gaussian;
    use wayfix_kalman::MarkovChain;

    use super::*;
    use crate::{
        LightingBank, LightingFilter, LightingFilterParams, LocalizerParams, Start, YuvImage,
        localizer::{
            light::Light,
            search::Premise,
            shots::{Shot, Walked},
            start::Area,
        },
    };

    /// Which of four frames are taken for hidden that show the carpet in these brightnesses, two of them on half of the pixels each, under a light of which
    /// little is known.
    fn hidden(frames: [[u8; 2]; 4]) -> Vec<bool> {
        let square = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
        let vertices = square.map(|(x, y)| Vector3::new(x, y, 0.0)).to_vec();
        let carpet = ColoredShape::Polygon { color: ColorId(0), vertices };
        let map = Arc::new(ColorMap::new(vec!["green".into()], vec![carpet]).unwrap());
        let prior = DVector::from_vec(vec![100.0, 128.0, 128.0]);
        let filter = LightingFilter::new(
            Gaussian::new(prior, DMatrix::from_diagonal_element(3, 3, 900.0)).unwrap(),
            LightingFilterParams::default(),
        );
        let bank = LightingBank::new(vec![filter.unwrap()], MarkovChain::sticky(1, 0.9).unwrap()).unwrap();
        let params = LocalizerParams::default();
        let light = Arc::new(Light::new(bank, &params.pixels).unwrap());
        let camera = PinholeCamera::from_field_of_view(16, 16, 1.0, 1.0).unwrap();
        let shot = |_| {
            let image = YuvImage::new(16, 16, vec![[100, 128, 128]; 256]).unwrap();
            Shot { image, mount: Pose3::identity(), walked: Walked::default() }
        };
        let shots = (0..4).map(shot).collect();
        let premise = Premise { start: &Start::Anywhere, light: &light, is_light_known: false };
        let area = Area::of(&map).unwrap();
        let search = Search::new(&map, camera, &area, &params, premise, shots, None).unwrap();

        let mut candidate = search.candidate(&Pose2::identity(), 0);
        for (sums, shades) in candidate.sums.iter_mut().zip(frames) {
            let pixels = (0..256).map(|at| [shades[at % 2], 128, 128]).collect();
            // The background says that a pixel may be one of e¹² colours.
            let frame =
                PrefixSumImage::with_background(&YuvImage::new(256, 1, pixels).unwrap(), |_| Some(12.0))
                    .unwrap();
            frame.add_run(0, 0, 256, sums);
        }
        search.score(&mut Scratch::new(&search), &mut candidate, Effort::Full);
        candidate.is_hidden
    }

    #[test]
    fn a_frame_that_no_light_explains_with_the_others_is_taken_for_hidden() {
        assert_eq!(hidden([[80, 82], [81, 79], [20, 220], [80, 81]]), [false, false, true, false]);
        // Whatever the light is, it is the same for all of them.
        assert_eq!(hidden([[80, 82], [81, 79], [79, 82], [80, 81]]), [false; 4]);
        assert_eq!(hidden([[150, 152], [151, 149], [149, 152], [150, 151]]), [false; 4]);
    }
}
