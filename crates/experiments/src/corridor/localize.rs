use anyhow::Result;
use wayfix_condensation::{
    DiscreteFilter, RouteAppearanceModel, RouteAppearanceParams, SparseTransition, StateDescriptorTable,
};

/// Tolerance of a correct place, in frames: the definition of the data set.
pub(super) const TOLERANCE: usize = 2;
/// Share of the belief that is spread uniformly between two frames, as for drives through scenes.
const LEAK: f64 = 1e-3;

/// Method of localization.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Method {
    /// A filter with forward motion: zero, one or two places per frame with these probabilities.
    Filter([f64; 3]),
    /// The same, with neighbouring frames assumed independent.
    Independent([f64; 3]),
    /// Every frame for itself.
    SingleFrame,
}

/// One place a frame, sometimes none or two.
pub(super) const STEADY: [f64; 3] = [0.1, 0.8, 0.1];
/// The same, half of the time only.
pub(super) const VAGUE: [f64; 3] = [0.25, 0.5, 0.25];

/// Belief after every frame.
pub(super) struct LocalizationRun {
    /// One distribution over the places a frame.
    pub(super) beliefs: Vec<Vec<f64>>,
    /// The most probable place.
    pub(super) best: Vec<usize>,
    /// Number of neighbouring frames that count as one.
    pub(super) correlation_length: f64,
}

impl LocalizationRun {
    /// Goes through the frames of one traverse, knowing the other.
    pub(super) fn of(
        learned: &StateDescriptorTable,
        seen: &StateDescriptorTable,
        method: Method,
    ) -> Result<Self> {
        let params =
            RouteAppearanceParams { same_place_tolerance: TOLERANCE, ..RouteAppearanceParams::default() };
        let traverse = RouteAppearanceModel::learn(learned, &params)?;
        let n_places = traverse.n_states();
        let motion = match method {
            Method::Filter(steps) | Method::Independent(steps) => Some(drives_on(n_places, steps)?),
            Method::SingleFrame => None,
        };
        let mut filter = DiscreteFilter::uniform(n_places)?;
        let (mut beliefs, mut best) = (Vec::new(), Vec::new());
        for features in seen.rows() {
            let mut log_likelihoods = traverse.log_likelihoods(features)?;
            if let Method::Independent(_) = method {
                log_likelihoods.iter_mut().for_each(|l| *l *= traverse.correlation_length());
            }
            match &motion {
                Some(motion) if !best.is_empty() => {
                    filter.predict(motion)?;
                    filter.leak(LEAK)?;
                }
                _ => filter = DiscreteFilter::uniform(n_places)?,
            }
            // Finite likelihoods rule out no place, so this updates.
            let _ = filter.update(&log_likelihoods)?;
            best.push(filter.best().state);
            beliefs.push(filter.belief().to_vec());
        }
        Ok(Self { beliefs, best, correlation_length: traverse.correlation_length() })
    }

    /// Errors of the most probable place, in places.
    pub(super) fn errors(&self) -> impl Iterator<Item = usize> + '_ {
        self.best.iter().enumerate().map(|(frame, place)| place.abs_diff(frame))
    }

    /// Share of the frames that are found.
    pub(super) fn share(&self) -> f64 {
        let found = self.errors().filter(|error| *error <= TOLERANCE).count();
        found as f64 / self.best.len() as f64
    }
}

/// None, one or two places on; the end of the corridor stops.
fn drives_on(n_places: usize, steps: [f64; 3]) -> Result<SparseTransition> {
    let row = |place: usize| {
        steps.into_iter().enumerate().map(move |(step, p)| ((place + step).min(n_places - 1), p))
    };
    Ok(SparseTransition::from_rows((0..n_places).map(row))?)
}
