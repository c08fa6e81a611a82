use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::camera_sensor::CameraSensor;
use super::scene_models::{self, SceneModel};
use super::{Film, Frame, Silhouette, board};
use crate::random::Streams;
use crate::scenery::canvas::Window;

/// The pictures of a [`Film`], drawn one by one.
pub struct Frames {
    film: Film,
    model: Box<dyn SceneModel>,
    camera_sensor: CameraSensor,
    index: usize,
}

impl Frames {
    pub(super) fn new(film: Film) -> Self {
        let mut streams = Streams::new(ChaCha8Rng::seed_from_u64(film.seed));
        let model = scene_models::scene_model(&film, &mut streams);
        Self { film, model, camera_sensor: CameraSensor::new(&mut streams), index: 0 }
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
        let mut scene = self.model.render(seconds, self.film.incident.aside(share));
        let mut visible = scene.target.clone();
        if let Some((left, right)) = self.film.incident.board(share) {
            board::paint(&mut scene.canvas, (left, right), self.model.light(seconds));
            let size = (scene.canvas.width, scene.canvas.height);
            let hidden = Silhouette::of(size, &Window::of_size(size), |x, _| (x - left).min(right - x));
            visible = visible.without(&hidden);
        }
        let picture = self.camera_sensor.process(scene.canvas, seconds);
        Some(Frame { picture, target: scene.target, visible, distractor: scene.distractor })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.film.n_frames.saturating_sub(self.index);
        (left, Some(left))
    }
}
