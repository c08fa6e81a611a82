use std::sync::Arc;

use wayfix_color_map::MapRenderer;
use wayfix_estimation_traits::LogWeight;

use super::{
    StartPosePrior,
    candidate::{Candidate, FittedLight},
    place_evidence::PlaceEvidence,
    pyramid::Level,
};
use crate::{
    ColorModelError, LightingTracker, PixelLikelihoodFrame, PixelSums, TileSums,
    likelihood::{LightOfTiles, TileLight, TileLikelihood, gather_tiles, or_hidden},
    localizer::{LocalizerParams, buffer::BufferedFrame, camera::CameraLocation, frame::Scene},
};

/// How well trajectories explain the frames.
pub(super) struct Evidence<'a, T> {
    pub(super) scene: Scene<'a, ()>,
    pub(super) start: &'a StartPosePrior,
    pub(super) params: &'a LocalizerParams,
    /// The light before the first frame of all, and the one before the buffered frames: the latter is the better one if the place was right.
    pub(super) lights: [&'a Arc<T>; 2],
    pub(super) frames: Vec<BufferedFrame>,
    /// Share of the evidence of each frame that is independent of the frame before.
    pub(super) independent_shares: Vec<f64>,
    /// The coarsest first.
    pub(super) levels: [Level; 2],
}

/// Frames and resolution that weigh a candidate.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    pub(super) level: usize,
    /// At most, evenly spaced, with the newest.
    pub(super) n_frames: usize,
}

/// Working memory of a thread.
pub(super) struct Scratch {
    /// Of each level.
    views: [(MapRenderer, TileSums); 2],
    tiles: TileLikelihood,
    gathered: Vec<GatheredFrame>,
    /// Log-likelihood of each frame by what it adds to the frame before, nats.
    values: Vec<LogWeight>,
}

/// A frame as a candidate sees it.
struct GatheredFrame {
    index: usize,
    /// End of its tiles.
    end: usize,
    /// Share of its evidence that is independent of the gathered frame before.
    independent_share: f64,
}

impl Scratch {
    /// Of each frame its index and its log-likelihood.
    fn of_frames(&self) -> Vec<(usize, LogWeight)> {
        self.gathered.iter().map(|frame| frame.index).zip(self.values.iter().copied()).collect()
    }
}

/// The first of some lights, with the second one as its shade.
fn fitted_light(lights: &[TileLight]) -> LightOfTiles {
    LightOfTiles { light: 0, shade: (lights.len() > 1).then_some(1), n_lights: lights.len() }
}

impl<T: LightingTracker> Evidence<'_, T> {
    pub(super) fn scratch(&self) -> Scratch {
        let map = self.scene.map;
        let view = |level: &Level| {
            (
                MapRenderer::new(Arc::clone(map), level.camera),
                TileSums::new(&level.tiles[0], map.colors().len()),
            )
        };
        let [coarse, fine] = &self.levels;
        Scratch {
            views: [view(coarse), view(fine)],
            tiles: TileLikelihood::default(),
            gathered: Vec::new(),
            values: Vec::new(),
        }
    }

    /// Weighs a candidate in its light.
    pub(super) fn weigh(&self, scratch: &mut Scratch, candidate: &mut Candidate, effort: Effort) {
        self.gather(scratch, candidate, effort);
        scratch.tiles.weigh(&candidate.light.lights);
        candidate.log_evidence =
            self.of_gathered(scratch, &candidate.light, effort.level) + self.log_prior(candidate);
        candidate.log_likelihoods = scratch.of_frames();
    }

    /// Fits each light of each tracker with its shade to a candidate, or alone too, and weighs it in the most probable one.
    pub(super) fn fit(&self, scratch: &mut Scratch, candidate: &mut Candidate, effort: Effort, alone: bool) {
        self.gather(scratch, candidate, effort);
        candidate.log_evidence = f64::NEG_INFINITY;
        for lights in self.lights(alone) {
            let Ok(fitted) = self.fitted(scratch, lights) else { continue };
            let log = self.of_gathered(scratch, &fitted, effort.level);
            if log > candidate.log_evidence {
                candidate.log_evidence = log;
                candidate.log_likelihoods = scratch.of_frames();
                candidate.light = fitted;
            }
        }
        candidate.log_evidence += self.log_prior(candidate);
    }

    /// Trackers with each of the lights that may shine and its shade, if there is one, and with the light alone.
    fn lights(&self, alone: bool) -> Vec<(usize, usize, Option<usize>)> {
        let mut lights = Vec::new();
        for (tracker, light) in self.trackers().iter().enumerate() {
            for at in (0..light.n_lights()).filter(|at| light.light_probability(*at) > 0.0) {
                let shade = light.shade_of(at);
                lights.push((tracker, at, shade));
                lights.extend((alone && shade.is_some()).then_some((tracker, at, None)));
            }
        }
        lights
    }

    /// A light of a tracker, and its shade if any, as the gathered frames show them; weighs the frames in it.
    fn fitted(
        &self,
        scratch: &mut Scratch,
        (tracker, light, shade): (usize, usize, Option<usize>),
    ) -> Result<FittedLight, ColorModelError> {
        let (belief, noise) = (self.trackers()[tracker], self.noise());
        let lights = std::iter::once(light).chain(shade);
        let beliefs: Option<Vec<_>> = lights.clone().map(|at| belief.joint_belief(at)).collect();
        let (lights, log_density) = match beliefs {
            Some(beliefs) => scratch.tiles.fit(&beliefs, self.scene.pixels, &noise),
            None => {
                let new = |at| TileLight::new(&**belief, at, self.scene.pixels, &noise.pixel_color_variance);
                let lights: Vec<_> = lights.map(new).collect::<Result<_, _>>()?;
                scratch.tiles.weigh(&lights);
                (lights, 0.0)
            }
        };
        Ok(FittedLight { tracker, light, lights, log_density })
    }

    /// The pixels of each colour of a candidate in each light of its tracker.
    pub(super) fn shown(&self, candidate: &Candidate, locations: &[CameraLocation]) -> Vec<PixelSums> {
        let FittedLight { tracker, light, ref lights, .. } = candidate.light;
        let n_colors = self.scene.map.colors().len();
        let mut seen = vec![PixelSums::default(); lights.len() * n_colors];
        let (mut scratch, finest) = (self.scratch(), self.levels.len() - 1);
        for (at, location) in locations.iter().enumerate() {
            scratch.tiles.clear();
            self.gather_frame(&mut scratch, finest, at, (location, 1.0));
            scratch.tiles.weigh(lights);
            scratch.tiles.show(
                scratch.views[finest].1.regions(),
                fitted_light(lights),
                self.scene.pixels,
                &mut seen,
            );
        }
        let tracker = self.trackers()[tracker];
        let mut shown = vec![PixelSums::default(); tracker.n_lights() * n_colors];
        for (to, seen) in
            std::iter::once(light).chain(tracker.shade_of(light)).zip(seen.chunks_exact(n_colors))
        {
            shown[to * n_colors..(to + 1) * n_colors].copy_from_slice(seen);
        }
        shown
    }

    /// The camera locations of a candidate at all frames.
    pub(super) fn locations(&self, candidate: &Candidate) -> Vec<CameraLocation> {
        candidate.trajectory.locations(&self.frames, &self.params.camera_pose_noise)
    }

    /// The evidence of the gathered frames, weighed in a light. Each frame may be hidden, with probability $`h`$, and counts the share $`γ_k`$ that it adds to the frame before:
    /// $`\ln π_j \prod_k [(1 - h)\, p(z_k | x_k, θ_j) + h]^{γ_k}`$.
    fn of_gathered(&self, scratch: &mut Scratch, fitted: &FittedLight, level: usize) -> LogWeight {
        let Scratch { tiles, gathered, values, .. } = scratch;
        let hidden = self.params.occlusion.share();
        values.clear();
        let mut start = 0;
        for GatheredFrame { index, end, independent_share } in &*gathered {
            let (image, lights) = (&self.levels[level].tiles[*index], fitted_light(&fitted.lights));
            let (log, _) = tiles.log_likelihood(image, lights, start..*end);
            values.push(independent_share * or_hidden(log, hidden));
            start = *end;
        }
        let prior = self.lights[fitted.tracker].light_probability(fitted.light).ln() + fitted.log_density;
        let log = prior + values.iter().sum::<f64>();
        if log.is_nan() { f64::NEG_INFINITY } else { log }
    }

    /// Takes what the map shows in the frames.
    fn gather(&self, scratch: &mut Scratch, candidate: &Candidate, Effort { level, n_frames }: Effort) {
        let locations = self.locations(candidate);
        let stride = self.frames.len().div_ceil(n_frames).max(1);
        scratch.tiles.clear();
        scratch.gathered.clear();
        for index in (0..self.frames.len()).rev().step_by(stride) {
            let since = |before: usize| self.independent_shares[before + 1..=index].iter().sum::<f64>();
            let independent_share = index.checked_sub(stride).map_or(1.0, |before| since(before).min(1.0));
            self.gather_frame(scratch, level, index, (&locations[index], independent_share));
            let end = scratch.tiles.n_tiles();
            scratch.gathered.push(GatheredFrame { index, end, independent_share });
        }
    }

    /// Takes what the map shows in a frame: nothing if there is no such camera pose.
    fn gather_frame(
        &self,
        scratch: &mut Scratch,
        level: usize,
        at: usize,
        (location, independent_share): (&CameraLocation, f64),
    ) {
        let (renderer, tiles) = &mut scratch.views[level];
        let Level { tiles: frames, edge_margin, .. } = &self.levels[level];
        let camera_pose = location.camera_pose(&self.frames[at].mount);
        if gather_tiles(renderer, &frames[at], &camera_pose, *edge_margin, tiles).is_ok() {
            scratch.tiles.add_tiles(&frames[at], tiles.regions(), independent_share);
        }
    }

    fn log_prior(&self, candidate: &Candidate) -> LogWeight {
        let first = self.locations(candidate).first().map_or(0.0, |first| self.start.log_prior(&first.body));
        first + candidate.trajectory.log_prior()
    }

    /// The evidence of a candidate, with its tiles.
    pub(super) fn of_tiles(&self, candidate: &Candidate) -> PlaceEvidence {
        let (mut scratch, finest) = (self.scratch(), self.levels.len() - 1);
        self.gather(&mut scratch, candidate, Effort { level: finest, n_frames: self.frames.len() });
        let Scratch { tiles, gathered, .. } = &mut scratch;
        tiles.weigh(&candidate.light.lights);
        let (mut evidence, mut start) = (PlaceEvidence::new(candidate.log_evidence), 0);
        for GatheredFrame { index, end, independent_share } in gathered {
            let (image, lights) = (&self.levels[finest].tiles[*index], fitted_light(&candidate.light.lights));
            evidence.add_tiles((*index, *independent_share), tiles.gains(image, lights, start..*end));
            start = *end;
        }
        evidence
    }

    /// The different trackers.
    fn trackers(&self) -> &[&Arc<T>] {
        &self.lights[..1 + usize::from(!Arc::ptr_eq(self.lights[0], self.lights[1]))]
    }

    fn noise(&self) -> PixelLikelihoodFrame {
        PixelLikelihoodFrame {
            pixel_color_variance: self.scene.noise.pixel_color_variance,
            mean_color_variance: self.scene.noise.mean_color_variance,
        }
    }
}
