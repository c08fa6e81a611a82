use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::chip::Chip;
use super::plays::{self, Play};
use super::{Film, Frame, Silhouette, board};
use crate::random::Streams;
use crate::scenery::canvas::Window;

/// The pictures of a [`Film`], drawn one by one.
pub struct Frames {
    film: Film,
    play: Box<dyn Play>,
    chip: Chip,
    index: usize,
}

impl Frames {
    pub(super) fn new(film: Film) -> Self {
        let mut streams = Streams::new(ChaCha8Rng::seed_from_u64(film.seed));
        let play = plays::begin(&film, &mut streams);
        Self { film, play, chip: Chip::new(&mut streams), index: 0 }
    }
}

impl Iterator for Frames {
    type Item = Frame;

    fn next(&mut self) -> Option<Frame> {
        if self.index >= self.film.n_frames {
            return None;
        }
        let (seconds, share) =
            (self.index as f64 / Film::RATE_HZ, self.index as f64 / self.film.n_frames as f64);
        self.index += 1;
        let mut scene = self.play.show(seconds, self.film.incident.aside(share));
        let mut visible = scene.target.clone();
        if let Some((left, right)) = self.film.incident.board(share) {
            board::paint(&mut scene.canvas, (left, right), self.play.light(seconds));
            let size = (scene.canvas.width, scene.canvas.height);
            let hidden = Silhouette::of(size, &Window::of_size(size), |x, _| (x - left).min(right - x));
            visible = visible.without(&hidden);
        }
        let picture = self.chip.develop(scene.canvas, seconds);
        Some(Frame { picture, target: scene.target, visible, decoy: scene.decoy })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.film.n_frames.saturating_sub(self.index);
        (left, Some(left))
    }
}
