use std::{collections::BTreeMap, ops::ControlFlow};

use wayfix_condensation::{
    DiscreteFilter, DiscreteStateSpace, GridMove, LearnedMotion, LoggedMove, MeasurementOutcome,
    MostProbableState, PositionGrid, RgbImage, RouteAppearanceModel, RouteAppearanceParams,
    SlipProbabilities, SparseTransition, StateDescriptorTable, View,
};
use wayfix_evaluation::{
    plot::Decimated,
    report::{Metric, ReportRun},
};
use wayfix_sensor_log::EncodedImage;
use wayfix_system_core::MOST_ESTIMATES;
use wayfix_table_log::{MoveRow, MoveTable, MovedFrameFolder};

use super::{DescriptorKind, ViewsError, ViewsParams, figures::motion_metrics, system::MAX_HYPOTHESES};

/// Pixels of the picture of all beliefs, at most, in each direction.
pub(super) const MAX_SIDE: usize = 1200;

/// The belief after a picture of a logged drive.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedView {
    /// Number of the frame.
    pub number: usize,
    /// The most probable place.
    pub best: MostProbableState,
    /// The true place, if the log has it.
    pub truth: Option<usize>,
    /// Belief over the places.
    pub belief: Vec<f64>,
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
    /// Some of the frames that were reached, readable or not, evenly spaced; none among more than 1,200 places.
    pub(super) beliefs: Decimated<LoggedView>,
    /// Frames, and moves between the most probable and the true place.
    pub(super) errors: Decimated<(usize, usize)>,
    totals: LoggedTotals,
    events: BTreeMap<String, u64>,
}

/// Sums over the frames of a drive.
#[derive(Clone, Copy, Debug, Default)]
struct LoggedTotals {
    n: usize,
    confidence: f64,
    found: usize,
    sum: usize,
    largest: usize,
    certain_of_wrong: u64,
}

impl LoggedViews {
    /// Localizes the frames of a drive among those of a learned one.
    ///
    /// Places are those of the learned table, each with at least one picture, else its frames in order: a route. The noise of the features is learned as
    /// [`RouteAppearanceModel`] does. Moves slip as `moves`, a logged drive with true places, did; without it as `navigator.slip` says.
    /// `done` is called after each frame, with its picture, and may end the drive there.
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
        mut done: impl FnMut(&PositionGrid, &LoggedView, Option<&EncodedImage>) -> ControlFlow<()>,
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
        let mut run = Self {
            grid,
            learned: features,
            motion,
            beliefs: Decimated::new(MAX_SIDE),
            errors: Decimated::new(MOST_ESTIMATES),
            totals: LoggedTotals::default(),
            events: BTreeMap::new(),
        };
        let mut filter = DiscreteFilter::uniform(grid.n_states())?;
        let (mut n_used, mut other_size) = (0, None);
        for (number, frame) in drive.frames.iter().enumerate() {
            let (row, image) = (frame.row.as_ref(), frame.image());
            if number > 0 {
                match row.and_then(|row| row.action) {
                    Some(action) => filter.predict(&transitions[index(action)])?, // Eqs. 3-5
                    None => {
                        run.count("frame_without_action");
                        filter.predict(&anything)?;
                    }
                }
                filter.leak(params.localizer.kidnapping_probability)?;
            }
            match image.as_ref().and_then(decoded) {
                Some(picture) if picture.dimensions() == size => {
                    n_used += 1;
                    let measured = extracted(&picture, feature, params)?;
                    let outcome = filter.update(&appearance.log_likelihoods(&measured)?)?; // Eq. 6
                    if outcome == MeasurementOutcome::Impossible {
                        run.count("measurement_impossible");
                    }
                }
                Some(picture) => {
                    other_size = Some(picture.dimensions());
                    run.count("frame_of_another_size");
                }
                None => run.count("frame_unreadable"),
            }
            let truth = row.and_then(|row| state(&grid, row));
            let view = LoggedView { number, best: filter.best(), truth, belief: filter.belief().to_vec() };
            let flow = done(&grid, &view, image.as_ref());
            run.add(view, route.same_place_tolerance, params.navigator.goal_confidence);
            if flow.is_break() {
                break;
            }
        }
        match other_size {
            Some(real) if n_used == 0 => Err(sizes(size, real)),
            _ => Ok(run),
        }
    }

    fn count(&mut self, name: &str) {
        *self.events.entry(name.to_owned()).or_default() += 1;
    }

    fn add(&mut self, view: LoggedView, tolerance: usize, goal_confidence: f64) {
        let totals = &mut self.totals;
        totals.n += 1;
        totals.confidence += view.best.confidence;
        if let Some(truth) = view.truth {
            let ((x, y), (true_x, true_y)) = (self.grid.place(view.best.state), self.grid.place(truth));
            let error = x.abs_diff(true_x).max(y.abs_diff(true_y));
            totals.found += usize::from(error <= tolerance);
            totals.sum += error;
            totals.largest = totals.largest.max(error);
            totals.certain_of_wrong +=
                u64::from(error > tolerance && view.best.confidence >= goal_confidence);
            self.errors.push((view.number, error));
        }
        if self.grid.n_states() <= MAX_SIDE {
            self.beliefs.push(view);
        }
    }

    /// Figures and events for the report.
    pub fn summarize(&self) -> ReportRun {
        let LoggedTotals { n, confidence, found, sum, largest, certain_of_wrong } = self.totals;
        let n = n as f64;
        let mut metrics = vec![
            Metric::new("n_frames", n, ""),
            Metric::new("n_places", self.grid.n_states() as f64, ""),
            Metric::new("confidence_mean", confidence / n, ""),
        ];
        let mut events = self.events.clone();
        if self.errors.n_seen() > 0 {
            let n = self.errors.n_seen() as f64;
            metrics.extend([
                Metric::new("n_frames_with_truth", n, ""),
                Metric::new("localized_frame_share", found as f64 / n, ""),
                Metric::new("place_error_mean", sum as f64 / n, "places"),
                Metric::new("place_error_max", largest as f64, "places"),
            ]);
            events.insert("certain_of_wrong_place".to_owned(), certain_of_wrong);
        }
        if let Some(motion) = &self.motion {
            metrics.extend(motion_metrics(motion));
        }
        let notes = self.beliefs.note("pictures").into_iter().collect();
        ReportRun { metrics, events, notes, ..ReportRun::default() }
    }
}

/// Size of the pictures, places, and the mean features of the pictures of each place.
fn learn(
    learned: &MovedFrameFolder,
    feature: DescriptorKind,
    params: &ViewsParams,
) -> Result<((u32, u32), PositionGrid, StateDescriptorTable), ViewsError> {
    let place = |row: Option<&MoveRow>| row.and_then(|row| row.place);
    let is_route = learned.frames.iter().all(|frame| place(frame.row.as_ref()).is_none());
    let (mut n_pictures, mut size) = (0, None);
    let mut sums: BTreeMap<[usize; 2], (f64, Vec<f64>)> = BTreeMap::new();
    for frame in &learned.frames {
        let Some(picture) = frame.image().as_ref().and_then(decoded) else { continue };
        let place = if is_route { Some([n_pictures, 0]) } else { place(frame.row.as_ref()) };
        n_pictures += 1;
        let size = *size.get_or_insert(picture.dimensions());
        if picture.dimensions() != size {
            return Err(sizes(size, picture.dimensions()));
        }
        let Some(place) = place else { continue };
        let (n, sum) = sums.entry(place).or_default();
        let features = extracted(&picture, feature, params)?;
        *n += 1.0;
        sum.resize(features.len(), 0.0);
        sum.iter_mut().zip(features).for_each(|(sum, value)| *sum += value);
    }
    let side = |axis: usize| sums.keys().map(|place| place[axis] + 1).max().unwrap_or(1);
    let n_states = side(0).saturating_mul(side(1));
    if n_states > MAX_HYPOTHESES {
        return Err(ViewsError::TooManyStates { n_states, n_conditions: 1, max: MAX_HYPOTHESES });
    }
    if sums.len() < n_states {
        let n_without = n_states - sums.len();
        return Err(ViewsError::PlacesWithoutPicture { n_without, n_places: n_states });
    }
    let grid = PositionGrid::new(side(0), side(1))?;
    let mean = |state: usize| {
        let (column, row) = grid.place(state);
        let (n, sum) = &sums[&[column, row]];
        sum.iter().map(|value| value / n).collect::<Vec<_>>()
    };
    let rows: Vec<Vec<f64>> = (0..n_states).map(mean).collect();
    Ok((size.unwrap_or_default(), grid, StateDescriptorTable::from_rows(&rows)?))
}

fn sizes(learned: (u32, u32), real: (u32, u32)) -> ViewsError {
    let [learned, real] = [learned, real].map(|(width, height)| (width as usize, height as usize));
    ViewsError::Sizes { learned, real }
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
