use super::channels::planes::Spectrum;
use super::recenter::N_RECENTERING_FRAMES;
use super::recognizer::{FilterResponse, WindowSample};
use super::response::Peak;
use super::tracker::CorrelationTracker;
use super::window::{SIDE, WindowPlace};
use crate::RgbImage;

impl CorrelationTracker {
    /// Where the trusted filter recognizes the target, if any: in the window or, after some images without it, at the next place of a scan.
    pub(super) fn recognized_elsewhere(
        &self,
        picture: &RgbImage,
        around: &WindowSample,
    ) -> Option<(WindowPlace, WindowSample, FilterResponse)> {
        self.recognized_by(&self.trusted, picture, self.pose, around).or_else(|| {
            let turn = self.n_untrusted.checked_sub(self.params.lost_after_n_frames)?;
            let center = self.place(turn);
            let from = WindowPlace { center, ..self.pose };
            self.recognized_by(&self.trusted, picture, from, &self.recognizer.sample_at(picture, from))
        })
    }

    /// Looks for a lost target around where it was, in a few other places of the picture in turn, and turned; the quality.
    pub(super) fn search(&mut self, picture: &RgbImage) -> f64 {
        let first = self.n_lost * self.params.n_search_places;
        let others = (first..first + self.params.n_search_places).map(|turn| self.place(turn));
        let centers: Vec<[f64; 2]> = std::iter::once(self.pose.center).chain(others).collect();
        self.n_lost += 1;
        for center in centers {
            let from = WindowPlace { center, ..self.pose };
            let around = self.recognizer.sample_at(picture, from);
            let found = [&self.trusted, &self.current].into_iter().find_map(|filter| {
                let (pose, _, evidence) = self.recognized_by(filter, picture, from, &around)?;
                Some((filter.clone(), pose, evidence.value / self.typical_response))
            });
            if let Some((filter, pose, quality)) = found {
                (self.current, self.pose) = (filter, pose);
                self.found();
                return quality;
            }
        }
        self.search_turned(picture)
    }

    /// A lost target is found.
    pub(super) fn found(&mut self) {
        (self.n_lost, self.n_without_evidence, self.n_recentering) = (0, 0, N_RECENTERING_FRAMES);
    }

    /// Where a filter recognizes the target in the window `around` a pose, if any.
    fn recognized_by(
        &self,
        filter: &Spectrum,
        picture: &RgbImage,
        pose: WindowPlace,
        around: &WindowSample,
    ) -> Option<(WindowPlace, WindowSample, FilterResponse)> {
        let response = self.recognizer.response(filter, around);
        if Peak::of(&response, SIDE).peak_to_sidelobe < self.params.no_evidence_below_psr {
            return None;
        }
        let pose = self.shifted(picture, pose, &response);
        let sample = self.recognizer.sample_at(picture, pose);
        let evidence = self.recognizer.evidence(filter, &sample);
        (self.recognized(evidence) && self.has_target_colors(&sample)).then_some((pose, sample, evidence))
    }

    /// Places in turn, so that the whole image is searched repeatedly.
    fn place(&self, turn: usize) -> [f64; 2] {
        let tiles = self.recognizer.window.tiles(self.picture_size, self.pose.scale);
        tiles[turn % tiles.len()]
    }
}
