use super::planes::Spectrum;
use super::recognizer::{Evidence, Sight};
use super::response::Peak;
use super::settle::SETTLING;
use super::tracker::CorrelationTracker;
use super::window::{Pose, SIDE};
use crate::Picture;

impl CorrelationTracker {
    /// Where the trusted filter recognizes the target, if it does: in sight or, when it has not for a while, in another place in turn.
    pub(super) fn recognized_elsewhere(
        &self,
        picture: &Picture,
        around: &Sight,
    ) -> Option<(Pose, Sight, Evidence)> {
        self.recognized_by(&self.trusted, picture, self.pose, around).or_else(|| {
            let turn = self.n_untrusted.checked_sub(self.params.patience)?;
            let center = self.place(turn);
            let from = Pose { center, ..self.pose };
            self.recognized_by(&self.trusted, picture, from, &self.recognizer.look(picture, from))
        })
    }

    /// Looks for a lost target around where it was, in a few other places of the picture in turn, and turned; the quality.
    pub(super) fn search(&mut self, picture: &Picture) -> f64 {
        let first = self.n_lost * self.params.n_searches;
        let others = (first..first + self.params.n_searches).map(|turn| self.place(turn));
        let centers: Vec<[f64; 2]> = std::iter::once(self.pose.center).chain(others).collect();
        self.n_lost += 1;
        for center in centers {
            let from = Pose { center, ..self.pose };
            let around = self.recognizer.look(picture, from);
            let found = [&self.trusted, &self.current].into_iter().find_map(|filter| {
                let (pose, _, evidence) = self.recognized_by(filter, picture, from, &around)?;
                Some((filter.clone(), pose, evidence.value / self.usual))
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
        (self.n_lost, self.n_doubts, self.n_settling) = (0, 0, SETTLING);
    }

    /// Where in what is seen `around` a pose a filter recognizes the target, if it does.
    fn recognized_by(
        &self,
        filter: &Spectrum,
        picture: &Picture,
        pose: Pose,
        around: &Sight,
    ) -> Option<(Pose, Sight, Evidence)> {
        let response = self.recognizer.response(filter, around);
        if Peak::of(&response, SIDE).standing_out < self.params.doubt_below {
            return None;
        }
        let pose = self.shifted(picture, pose, &response);
        let sight = self.recognizer.look(picture, pose);
        let evidence = self.recognizer.evidence(filter, &sight);
        (self.recognized(evidence) && self.is_alike(&sight)).then_some((pose, sight, evidence))
    }

    /// One place after the other, so that the whole picture is looked at again and again.
    fn place(&self, turn: usize) -> [f64; 2] {
        let tiles = self.recognizer.window.tiles(self.picture_size, self.pose.scale);
        tiles[turn % tiles.len()]
    }
}
