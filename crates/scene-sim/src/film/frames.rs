use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::camera_sensor::CameraSensor;
use super::scene_models::{self, SceneModel};
use super::{FilmFrame, Silhouette, SyntheticFilm, board};
use crate::random::RandomStreams;
use crate::scenery::canvas::Window;

/// The pictures of a [`SyntheticFilm`], drawn one by one.
pub struct FilmFrames {
    film: SyntheticFilm,
    model: Box<dyn SceneModel>,
    camera_sensor: CameraSensor,
    index: usize,
}

impl FilmFrames {
    pub(super) fn new(film: SyntheticFilm) -> Self {
        let mut streams = RandomStreams::new(ChaCha8Rng::seed_from_u64(film.seed));
        let model = scene_models::scene_model(&film, &mut streams);
        Self { film, model, camera_sensor: CameraSensor::new(&mut streams), index: 0 }
    }
}

impl Iterator for FilmFrames {
    type Item = FilmFrame;

    fn next(&mut self) -> Option<FilmFrame> {
        if self.index >= self.film.n_frames {
            return None;
        }
        let (seconds, share) =
            (self.index as f64 / SyntheticFilm::RATE_HZ, self.index as f64 / self.film.n_frames as f64);
        self.index += 1;
        let mut scene = self.model.render(seconds, self.film.occlusion.aside(share));
        let mut visible = scene.target.clone();
        if let Some((left, right)) = self.film.occlusion.board(share) {
            board::paint(&mut scene.canvas, (left, right), self.model.light(seconds));
            let size = (scene.canvas.width, scene.canvas.height);
            let hidden = Silhouette::of(size, &Window::of_size(size), |x, _| (x - left).min(right - x));
            visible = visible.without(&hidden);
        }
        let picture = self.camera_sensor.process(scene.canvas, seconds);
        Some(FilmFrame { picture, target: scene.target, visible, distractor: scene.distractor })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.film.n_frames.saturating_sub(self.index);
        (left, Some(left))
    }
}
