use std::sync::Arc;

use nalgebra::{Vector2, Vector3};
use rand::{Rng, RngExt};
use wayfix_color_map::PinholeCamera;
use wayfix_estimation_traits::Pose2;
use wayfix_particle::{ParticleChunkRng, ParticleSet};

use super::{
    Area, StartPosePrior,
    axes::{ground_in_view, pose_axes},
    candidate::{Candidate, Steps, retain_distant},
    detections::Detections,
    evidence::{Effort, Evidence, Scratch},
    place_evidence::PlaceEvidence,
    pyramid::Level,
    trajectory::Trajectory,
};
use crate::{
    ColorModelError, LightingTracker, PixelClassifier, PixelLikelihoodParams,
    localizer::{
        LocalizerParams,
        buffer::BufferedFrame,
        camera::CameraLocation,
        estimate::{PLACE_RADIUS, is_same_place},
        filter::{ColorFilter, update_lights},
        frame::Scene,
    },
};

/// The images are searched at a quarter and at half of their resolution.
const SHRINK: [u16; 2] = [4, 2];
/// Rounds of refinement; the first half of them is coarse. Three of four trajectories are dropped after a round, and the others get twice as many moves and frames, in the last
/// round all.
const N_ROUNDS: u32 = 4;
/// Factors of a step along an axis: on after a success, back and half as far after a failure. [Rosenbrock 1960]
const STEP_FACTORS: [f64; 2] = [3.0, -0.5];

/// Global search in several frames at once.
///
/// Under an unknown light some false place explains a single frame better than the true one. The light is common to all frames, so whole trajectories
/// are weighed by all frames under one light. The likelihood is narrow: trajectories are drawn in every cell of its width and where detected landmarks fit, then moved
/// along one axis after the other [Rosenbrock 1960], while the worse ones are dropped again and again [Li et al. 2018]. A place has several peaks, and keeps a trajectory at each
/// until the end: the highest one at first need not be the highest at the end.
pub(crate) struct Search<'a, T> {
    evidence: Evidence<'a, T>,
    area: &'a Area,
    detections: Detections,
    /// Width of a peak of the coarse likelihood along x, y (m) and the heading (rad).
    cell: Vector3<f64>,
}

/// Scale of the first steps of the pose in a round, in cells: half of those of the round before.
fn first_pose_step(round: u32) -> f64 {
    0.5 / f64::from(1 << round)
}

/// A place that explains the frames.
pub(crate) struct Found<T> {
    pub(crate) filter: ColorFilter<T>,
    pub(crate) place: Pose2<f64>,
    /// Of all frames, each by what it adds to the one before, with the prior of the trajectory.
    pub(crate) evidence: PlaceEvidence,
    /// Whether it was the present place before the search.
    pub(crate) is_present: bool,
}

/// As many poses take a minute and a gigabyte.
const MOST_SAMPLES: usize = 1 << 20;

/// Whether a search of an area can end.
pub(crate) fn check_area(
    area: &Area,
    camera: &PinholeCamera,
    params: &LocalizerParams,
) -> Result<(), ColorModelError> {
    let side = camera.width().min(camera.height());
    if params.search.samples_per_place > 0.0 && side < u32::from(SHRINK[0]) {
        return Err(ColorModelError::OutOfRange {
            what: "side of the camera's image (pixels)",
            value: side.into(),
        });
    }
    let n_cells = area.cells(&cell(camera, &params.pixels)).iter().map(|n| *n as f64).product::<f64>();
    let n_samples = params.search.samples_per_place * n_cells;
    if n_samples <= MOST_SAMPLES as f64 {
        return Ok(());
    }
    let [width, depth] = area.size();
    Err(ColorModelError::MapTooLarge { width, depth, n_samples, most: MOST_SAMPLES })
}

/// Size of a cell: a turn by a tile shows other colours in it, and no heading of a cell is farther from its middle.
fn cell(camera: &PinholeCamera, pixels: &PixelLikelihoodParams) -> Vector3<f64> {
    let turn = f64::from(2 * pixels.tile_pixels) / camera.fx();
    Vector3::new(PLACE_RADIUS, PLACE_RADIUS, turn.min(PLACE_RADIUS))
}

impl<'a, T: LightingTracker + Clone + Send + Sync> Search<'a, T> {
    pub(crate) fn new(
        scene: Scene<'a, ()>,
        (area, start): (&'a Area, &'a StartPosePrior),
        params: &'a LocalizerParams,
        lights: [&'a Arc<T>; 2],
        (frames, independent_shares): (Vec<BufferedFrame>, Vec<f64>),
    ) -> Result<Self, ColorModelError> {
        let tile = |shrink: u16| scene.pixels.tile_pixels.div_ceil(shrink);
        let [coarse, fine] = SHRINK.map(|shrink| Level::new(&scene, &frames, shrink, tile(shrink)));
        let levels = [coarse?, fine?];
        let [_, fine] = &levels;
        let mut detections = Detections::new(scene.map);
        let every = lights.iter().flat_map(|light| (0..light.n_lights()).map(|at| light.colors_in(at)));
        for colors in every {
            let classifier = PixelClassifier::new(scene.pixels.shaded(colors?))?;
            for ((at, image), frame) in fine.images.iter().enumerate().zip(&frames) {
                let label =
                    |pixel: &[u8; 3]| classifier.classify_above(*pixel, -fine.nats(scene.background, *pixel));
                let labels: Vec<u8> = image.pixels().iter().map(label).collect();
                detections.add(&labels, at, frame, &fine.camera)?;
            }
        }
        let cell = cell(&scene.camera, scene.pixels);
        Ok(Self {
            evidence: Evidence { scene, start, params, lights, frames, independent_shares, levels },
            area,
            detections,
            cell,
        })
    }

    /// The places that explain the frames best, the best first, among those that the start allows and those of filters, of which the first is at the present place.
    pub(crate) fn run<R: Rng + ?Sized>(
        &self,
        known: &[CameraLocation],
        rng: &mut R,
    ) -> Result<Vec<Found<T>>, ColorModelError> {
        let params = &self.evidence.params.search;
        let rough = Effort { level: 0, n_frames: 1 };
        let drawn = self.drawn(rng).map(|trajectory| self.candidate(trajectory)).collect();
        let mut drawn = ParticleSet::new(drawn)?;
        let fit = |scratch: &mut _, candidate: &mut _, _: &mut _| {
            self.evidence.fit(scratch, candidate, rough, false);
        };
        drawn.propagate_with(|| self.evidence.scratch(), fit, rng);
        let mut candidates = drawn.states().to_vec();
        candidates.extend(known.iter().map(|at| self.known(at)));
        retain_distant(&mut candidates, params.n_refined_trajectories, self.peak_width());
        for round in 0..N_ROUNDS {
            let n_frames = if round + 1 < N_ROUNDS { 2 << round } else { self.evidence.frames.len() };
            let effort = Effort { level: usize::from(2 * round >= N_ROUNDS), n_frames };
            let mut set = ParticleSet::new(candidates)?;
            let improve = |scratch: &mut _, candidate: &mut Candidate, rng: &mut _| {
                self.evidence.fit(scratch, candidate, effort, true);
                if candidate.known.is_some() && effort.n_frames < self.evidence.frames.len() {
                    return; // The filter estimates it from all frames: a part of them would give a wrong pose.
                }
                candidate.steps = Steps::new(first_pose_step(round), self.evidence.frames.len());
                for at in 0..(params.n_first_round_moves as usize) << round {
                    self.refine(scratch, candidate, (effort, at), rng);
                }
                self.evidence.fit(scratch, candidate, effort, true);
            };
            set.propagate_each(|| self.evidence.scratch(), improve, rng);
            candidates = set.states().to_vec();
            let n_kept = params.n_refined_trajectories >> (2 * (round + 1)).min(2 * N_ROUNDS - 2);
            retain_distant(&mut candidates, n_kept, self.peak_width());
        }
        let present = known.first().map(|at| at.body);
        candidates.iter_mut().for_each(|one| one.known = one.known.filter(|place| Some(*place) == present));
        retain_distant(&mut candidates, usize::MAX, PLACE_RADIUS);
        let n_particles = self.evidence.params.max_particles.div_ceil(candidates.len().max(1));
        candidates.iter().map(|candidate| self.found(candidate, n_particles, rng)).collect()
    }

    /// Distance (m and rad) between peaks of the likelihood, several of which may be in one place: the turn that shows other colours in a tile.
    fn peak_width(&self) -> f64 {
        self.cell.z
    }

    /// Trajectories that the start allows, one a cell by default. If that is anywhere: in every cell of a grid, and half as many that show a landmark where a frame does.
    fn drawn<'b, R: Rng + ?Sized>(&'b self, rng: &'b mut R) -> impl Iterator<Item = Trajectory> + 'b {
        let Evidence { levels: [coarse, _], start, params, frames, .. } = &self.evidence;
        let counts = self.area.cells(&self.cell);
        let n_cells = start.n_cells(self.area, &self.cell);
        let n = (params.search.samples_per_place * n_cells as f64).ceil() as usize;
        let newest = coarse.images.len() - 1;
        let n_detected = if matches!(start, StartPosePrior::Anywhere) { n / 2 } else { 0 };
        (0..n + n_detected).filter_map(move |at| {
            let (frame, pose) = match start {
                StartPosePrior::Anywhere if at < n => {
                    (newest, self.area.draw_in(at * n_cells / n, counts, rng))
                }
                StartPosePrior::Anywhere => self.detections.draw(self.area, rng)?,
                StartPosePrior::Near(_) => (0, start.draw(self.area, rng)),
            };
            Some(Trajectory::through(&pose, frame, frames))
        })
    }

    /// A place that a filter tracks.
    fn known(&self, location: &CameraLocation) -> Candidate {
        let Evidence { params, frames, .. } = &self.evidence;
        let trajectory = Trajectory::through(&location.body, frames.len(), frames)
            .with_camera_error(&location.error, &params.camera_pose_noise);
        Candidate { known: Some(location.body), ..self.candidate(trajectory) }
    }

    fn candidate(&self, mut trajectory: Trajectory) -> Candidate {
        self.area.clamp(&mut trajectory.newest);
        Candidate::new(trajectory)
    }

    /// Tries a step of the whole trajectory, and a step of the errors: the `at`-th.
    fn refine(
        &self,
        scratch: &mut Scratch,
        candidate: &mut Candidate,
        (effort, at): (Effort, usize),
        rng: &mut ParticleChunkRng,
    ) {
        let axis = at / 3;
        let Evidence { levels: [_, fine], frames, .. } = &self.evidence;
        let point =
            frames.last().map_or(Vector2::zeros(), |newest| ground_in_view(newest, &fine.camera, rng));
        let step = pose_axes(&point, &self.cell)[at % 3] * candidate.steps.pose[at % 3];
        let trajectory = candidate.trajectory.moved_by(&step);
        candidate.steps.pose[at % 3] *= self.consider(scratch, candidate, effort, trajectory);
        match at % 3 {
            0 => {
                let step = candidate.steps.mount[axis % 4];
                let trajectory = candidate.trajectory.with_mount_off(axis % 4, step);
                candidate.steps.mount[axis % 4] *= self.consider(scratch, candidate, effort, trajectory);
            }
            1 => {
                let frame = rng.random_range(0..self.evidence.frames.len());
                let step = candidate.steps.odometry[frame][axis % 3];
                let trajectory = candidate.trajectory.with_odometry_off(frame, axis % 3, step);
                candidate.steps.odometry[frame][axis % 3] *=
                    self.consider(scratch, candidate, effort, trajectory);
            }
            _ => self.consider_each(scratch, candidate, effort, axis % 4),
        }
    }

    /// Takes a trajectory if it explains the frames better; returns the factor of the next step.
    fn consider(
        &self,
        scratch: &mut Scratch,
        candidate: &mut Candidate,
        effort: Effort,
        mut trajectory: Trajectory,
    ) -> f64 {
        self.area.clamp(&mut trajectory.newest);
        if candidate.known.is_some_and(|known| !is_same_place(&known, &trajectory.newest)) {
            return STEP_FACTORS[1];
        }
        let mut moved = Candidate { trajectory, ..candidate.clone() };
        self.evidence.weigh(scratch, &mut moved, effort);
        let is_better = moved.log_evidence > candidate.log_evidence;
        if is_better {
            *candidate = moved;
        }
        STEP_FACTORS[usize::from(!is_better)]
    }

    /// Tries a step of the camera's error at each frame along an `axis`, and takes those that explain their frame better: in a light that is given, a frame depends on its own
    /// error alone.
    fn consider_each(&self, scratch: &mut Scratch, candidate: &mut Candidate, effort: Effort, axis: usize) {
        let trajectory = candidate.trajectory.with_sway(axis, &candidate.steps.sway);
        let mut moved = Candidate { trajectory, ..candidate.clone() };
        self.evidence.weigh(scratch, &mut moved, effort);
        for (log, new_log) in candidate.log_likelihoods.iter_mut().zip(&moved.log_likelihoods) {
            let at = log.0;
            let prior = |trajectory: &Trajectory| trajectory.log_prior_of_camera(at);
            let gain = new_log.1 + prior(&moved.trajectory) - log.1 - prior(&candidate.trajectory);
            // Two impossible frames have no gain.
            let is_better = gain > 0.0;
            if is_better {
                candidate.trajectory.take_camera_error(&moved.trajectory, at);
                candidate.log_evidence += gain;
                *log = *new_log;
            }
            candidate.steps.sway[at][axis] *= STEP_FACTORS[usize::from(!is_better)];
        }
    }

    /// Particles about a candidate, spread as the last round explores it, with the light that all frames show from there.
    fn found<R: Rng + ?Sized>(
        &self,
        candidate: &Candidate,
        n_particles: usize,
        rng: &mut R,
    ) -> Result<Found<T>, ColorModelError> {
        let Evidence { lights, params, .. } = &self.evidence;
        let locations = self.evidence.locations(candidate);
        let newest = *locations.last().ok_or(ColorModelError::NoPose)?;
        let mut light = T::clone(lights[candidate.light.tracker]);
        let shown = self.evidence.shown(candidate, &locations);
        update_lights(&mut light, candidate.light.light, &shown, params);
        let spread = first_pose_step(N_ROUNDS - 1);
        let location = |_| {
            let mut body = candidate.trajectory.moved(&(self.cell * spread), rng).newest;
            self.area.clamp(&mut body);
            CameraLocation { body, ..newest }
        };
        let filter = ColorFilter::new((0..n_particles).map(location), &Arc::new(light))?;
        Ok(Found {
            filter,
            place: candidate.trajectory.newest,
            evidence: self.evidence.of_tiles(candidate),
            is_present: candidate.known.is_some(),
        })
    }
}
