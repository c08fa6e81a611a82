use std::{collections::BTreeMap, ops::ControlFlow};

use wayfix_condensation::{
    DiscreteFilter, DiscreteStateSpace, GridMove, LearnedMotion, LoggedMove, MeasurementOutcome,
    MostProbableState, PositionGrid, RgbImage, RouteAppearanceModel, RouteAppearanceParams,
    SlipProbabilities, SparseTransition, StateDescriptorTable, View,
};
use wayfix_evaluation::report::{Metric, ReportRun};
use wayfix_sensor_log::EncodedImage;
use wayfix_table_log::{MoveRow, MoveTable, MovedFrameFolder};

use super::{DescriptorKind, ViewsError, ViewsParams, figures::motion_metrics, system::MAX_HYPOTHESES};

/// Beliefs are kept for pictures up to this product of frames and places.
const MAX_SHOWN: usize = 4_000_000;

/// The belief after a picture of a logged drive.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedView {
    /// The most probable place.
    pub best: MostProbableState,
    /// The true place, if the log has it.
    pub truth: Option<usize>,
    /// Belief over the places; `None` for long drives among many places.
    pub belief: Option<Vec<f64>>,
}

/// A logged drive, localized in learned pictures. [Kasprzak & Szynkiewicz, Sec. 2.2]
#[derive(Clone, Debug)]
pub struct LoggedViews {
    /// The places.
    pub grid: PositionGrid,
    /// Features of the places.
    pub learned: StateDescriptorTable,
    /// Transitions and diffusion, if they were learned from logged moves.
    pub motion: Option<LearnedMotion>,
    /// One for each frame that was reached, readable or not.
    pub views: Vec<LoggedView>,
    tolerance: usize,
    events: BTreeMap<String, u64>,
}

impl LoggedViews {
    /// Localizes the frames of a drive among those of a learned one.
    ///
    /// Places are those of the learned table, each with at least one picture, else its frames in order: a route. The noise of the features is learned as
    /// [`RouteAppearanceModel`] does. Moves slip as `moves`, a logged drive with true places, did; without it as `navigator.slip` says.
    /// `done` is called after each frame and may end the drive there.
    ///
    /// # Errors
    /// Returns [`ViewsError::Sizes`], [`ViewsError::TooManyStates`], [`ViewsError::PlacesWithoutPicture`], [`ViewsError::NoMoves`], or an error of the
    /// library.
    pub fn localize(
        learned: &MovedFrameFolder,
        drive: &MovedFrameFolder,
        moves: Option<&MoveTable>,
        feature: DescriptorKind,
        params: &ViewsParams,
        mut done: impl FnMut() -> ControlFlow<()>,
    ) -> Result<Self, ViewsError> {
        let (size, grid, features) = learn(learned, feature, params)?;
        let route = RouteAppearanceParams::default();
        let appearance = RouteAppearanceModel::learn(&features, &route)?;
        let motion = moves.map(|moves| learned_motion(&grid, moves)).transpose()?;
        let transitions = match &motion {
            Some(motion) => motion.transitions().to_vec(),
            None => slipping(&grid, params.navigator.slip)?,
        };
        let anything = SlipProbabilities { stay_probability: 0.0, other_action_probability: 1.0 };
        let anything = anything.transition(&grid, GridMove::STAY)?;
        let keeps_beliefs = drive.frames.len().saturating_mul(grid.n_states()) <= MAX_SHOWN;
        let mut run = Self {
            grid,
            learned: features,
            motion,
            views: Vec::new(),
            tolerance: route.same_place_tolerance,
            events: BTreeMap::new(),
        };
        let mut filter = DiscreteFilter::uniform(grid.n_states())?;
        for frame in &drive.frames {
            let row = frame.row.as_ref();
            if !run.views.is_empty() {
                match row.and_then(|row| row.action) {
                    Some(action) => filter.predict(&transitions[index(action)])?, // Eqs. 3-5
                    None => {
                        run.count("frame_without_action");
                        filter.predict(&anything)?;
                    }
                }
                filter.leak(params.localizer.kidnapping_probability)?;
            }
            match frame.image.as_ref().and_then(decoded) {
                Some(picture) if picture.dimensions() == size => {
                    let measured = extracted(&picture, feature, params)?;
                    let outcome = filter.update(&appearance.log_likelihoods(&measured)?)?; // Eq. 6
                    if outcome == MeasurementOutcome::Impossible {
                        run.count("measurement_impossible");
                    }
                }
                Some(_) => run.count("frame_of_another_size"),
                None => run.count("frame_unreadable"),
            }
            let truth = row.and_then(|row| state(&grid, row));
            let belief = keeps_beliefs.then(|| filter.belief().to_vec());
            run.views.push(LoggedView { best: filter.best(), truth, belief });
            if done().is_break() {
                break;
            }
        }
        Ok(run)
    }

    fn count(&mut self, name: &str) {
        *self.events.entry(name.to_owned()).or_default() += 1;
    }

    /// Moves between the most probable and the true place of each frame with a true one.
    pub fn errors(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.views.iter().enumerate().filter_map(|(frame, view)| {
            let ((x, y), (true_x, true_y)) = (self.grid.place(view.best.state), self.grid.place(view.truth?));
            Some((frame, x.abs_diff(true_x).max(y.abs_diff(true_y))))
        })
    }

    /// Figures and events for the report.
    pub fn summarize(&self, params: &ViewsParams) -> ReportRun {
        let n = self.views.len() as f64;
        let confidence: f64 = self.views.iter().map(|view| view.best.confidence).sum();
        let mut metrics = vec![
            Metric::new("n_frames", n, ""),
            Metric::new("n_places", self.grid.n_states() as f64, ""),
            Metric::new("confidence_mean", confidence / n, ""),
        ];
        let errors: Vec<(usize, usize)> = self.errors().collect();
        let mut events = self.events.clone();
        if !errors.is_empty() {
            let n = errors.len() as f64;
            let found = errors.iter().filter(|(_, error)| *error <= self.tolerance).count();
            let sum: usize = errors.iter().map(|(_, error)| error).sum();
            let largest = errors.iter().map(|(_, error)| *error).max().unwrap_or(0);
            metrics.extend([
                Metric::new("n_frames_with_truth", n, ""),
                Metric::new("localized_frame_share", found as f64 / n, ""),
                Metric::new("place_error_mean", sum as f64 / n, "places"),
                Metric::new("place_error_max", largest as f64, "places"),
            ]);
            let is_certain =
                |frame: usize| self.views[frame].best.confidence >= params.navigator.goal_confidence;
            let wrong = errors.iter().filter(|(frame, error)| *error > self.tolerance && is_certain(*frame));
            events.insert("certain_of_wrong_place".to_owned(), wrong.count() as u64);
        }
        if let Some(motion) = &self.motion {
            metrics.extend(motion_metrics(motion));
        }
        ReportRun { metrics, events, ..ReportRun::default() }
    }
}

/// Size of the pictures, places, and the mean features of the pictures of each place.
fn learn(
    learned: &MovedFrameFolder,
    feature: DescriptorKind,
    params: &ViewsParams,
) -> Result<((u32, u32), PositionGrid, StateDescriptorTable), ViewsError> {
    let usable =
        learned.frames.iter().filter_map(|frame| Some((frame, frame.image.as_ref().and_then(decoded)?)));
    let pictures: Vec<_> = usable.collect();
    let size = pictures.first().map_or((0, 0), |(_, picture)| picture.dimensions());
    let place = |row: Option<&MoveRow>| row.and_then(|row| row.place);
    let is_route = learned.frames.iter().all(|frame| place(frame.row.as_ref()).is_none());
    let places: Vec<Option<[usize; 2]>> = (0..)
        .zip(&pictures)
        .map(|(index, (frame, _))| if is_route { Some([index, 0]) } else { place(frame.row.as_ref()) })
        .collect();
    let side = |axis: usize| places.iter().flatten().map(|place| place[axis] + 1).max().unwrap_or(1);
    let n_states = side(0).saturating_mul(side(1));
    if n_states > MAX_HYPOTHESES {
        return Err(ViewsError::TooManyStates { n_states, n_conditions: 1, max: MAX_HYPOTHESES });
    }
    let grid = PositionGrid::new(side(0), side(1))?;
    let mut sums: Vec<(f64, Vec<f64>)> = vec![(0.0, Vec::new()); grid.n_states()];
    for ((_, picture), place) in pictures.iter().zip(&places) {
        if picture.dimensions() != size {
            let sizes = [size, picture.dimensions()].map(|(width, height)| (width as usize, height as usize));
            return Err(ViewsError::Sizes { learned: sizes[0], real: sizes[1] });
        }
        let Some(state) = place.and_then(|[column, row]| grid.state(column, row)) else { continue };
        let (n, sum) = &mut sums[state];
        let features = extracted(picture, feature, params)?;
        *n += 1.0;
        sum.resize(features.len(), 0.0);
        sum.iter_mut().zip(features).for_each(|(sum, value)| *sum += value);
    }
    let n_without = sums.iter().filter(|(n, _)| *n == 0.0).count();
    if n_without > 0 {
        return Err(ViewsError::PlacesWithoutPicture { n_without, n_places: grid.n_states() });
    }
    let mean = |(n, sum): (f64, Vec<f64>)| sum.into_iter().map(|value| value / n).collect::<Vec<_>>();
    let rows: Vec<Vec<f64>> = sums.into_iter().map(mean).collect();
    Ok((size, grid, StateDescriptorTable::from_rows(&rows)?))
}

/// Transitions and diffusion of a logged drive: each row with a move and a place after a row with a place.
pub(super) fn learned_motion(grid: &PositionGrid, moves: &MoveTable) -> Result<LearnedMotion, ViewsError> {
    let step = |pair: &[Option<MoveRow>]| {
        let (before, after) = (pair[0].as_ref()?, pair[1].as_ref()?);
        let [dx, dy] = after.action?;
        Some(LoggedMove { from: state(grid, before)?, action: GridMove { dx, dy }, to: state(grid, after)? })
    };
    let made: Vec<LoggedMove> = moves.rows.windows(2).filter_map(step).collect();
    if made.is_empty() {
        return Err(ViewsError::NoMoves {
            n_rows: moves.rows.len(),
            columns: grid.columns(),
            rows: grid.rows(),
        });
    }
    Ok(LearnedMotion::learn(grid, &made)?)
}

fn slipping(grid: &PositionGrid, slip: SlipProbabilities) -> Result<Vec<SparseTransition>, ViewsError> {
    Ok(grid.actions().iter().map(|&action| slip.transition(grid, action)).collect::<Result<_, _>>()?)
}

fn state(grid: &PositionGrid, row: &MoveRow) -> Option<usize> {
    row.place.and_then(|[column, row]| grid.state(column, row))
}

fn index([dx, dy]: [i8; 2]) -> usize {
    let wanted = GridMove { dx, dy };
    GridMove::ALL.iter().position(|known| *known == wanted).expect("invariant: tables hold moves of one step")
}

fn extracted(
    picture: &RgbImage,
    feature: DescriptorKind,
    params: &ViewsParams,
) -> Result<Vec<f64>, ViewsError> {
    let feature = feature.feature(params.dominant_gray_criterion);
    let mut features = vec![0.0; feature.n_components()];
    feature.extract(&View::whole(picture)?, &mut features);
    Ok(features)
}

fn decoded(image: &EncodedImage) -> Option<RgbImage> {
    let decoded = image.decode_rgb().ok()?;
    RgbImage::from_raw(decoded.width, decoded.height, decoded.pixels)
}
