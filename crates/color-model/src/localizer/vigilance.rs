use super::LocalizerParams;

/// Watches whether the robot still sees what it should see where it believes to be: a long-term and a short-term average of the fit, as in
/// augmented Monte Carlo localization [Thrun et al. 2005, Table 8.3].
///
/// Particles thrown over the field at random, as there, are too coarse for a likelihood as narrow as an image's. So doubt leads to a search
/// instead, once the frames of a whole search are younger than the doubt.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vigilance {
    averages: Option<(f64, f64)>,
    /// Frames since the doubt arose.
    n_doubtful: usize,
    /// Frames of doubt until the next search: more after each that was in vain.
    patience: usize,
}

/// Share of its usual value below which a fit has fallen.
const FALLEN: f64 = 0.7;

/// Fit, as a multiple of the doubtful one, from which on nothing is doubted.
const SOUND: f64 = 2.0;

/// Most frames of doubt between two searches.
const LONGEST_PATIENCE: usize = 200;

impl Vigilance {
    pub(crate) fn observe(&mut self, fit: f64, params: &LocalizerParams) {
        let fit = fit.clamp(-1.0, 1.0);
        let (slow, fast) = self.averages.unwrap_or((fit, fit));
        let follow = |average: f64, rate: f64| average + rate * (fit - average);
        let (slow, fast) = (follow(slow, params.slow_rate), follow(fast, params.fast_rate));
        self.averages = Some((slow, fast));
        if fast < FALLEN * slow || fast < params.doubtful_fit {
            self.n_doubtful += 1;
        } else {
            (self.n_doubtful, self.patience) = (0, 0);
        }
    }

    /// The short-term average.
    pub(crate) fn recent(&self) -> f64 {
        self.averages.map_or(1.0, |(_, fast)| fast)
    }

    pub(crate) fn is_search_due(&self, params: &LocalizerParams) -> bool {
        let n_frames = params.acquisition.n_frames;
        n_frames > 0 && self.n_doubtful >= self.patience.max(n_frames)
    }

    /// Whether what is seen leaves no doubt of the place, nor of the light that was learned there.
    pub(crate) fn is_sound(&self, params: &LocalizerParams) -> bool {
        self.n_doubtful == 0 && self.recent() >= SOUND * params.doubtful_fit
    }

    /// Begins anew after a search.
    pub(crate) fn after_search(&self, params: &LocalizerParams) -> Self {
        let patience = if self.patience == 0 {
            params.acquisition.n_frames
        } else {
            (2 * self.patience).min(LONGEST_PATIENCE)
        };
        Self { patience, averages: self.averages, n_doubtful: 0 }
    }

    /// How far the doubt is from leading to a search, 0 to 1.
    pub(crate) fn suspicion(&self, params: &LocalizerParams) -> f64 {
        let due = self.patience.max(params.acquisition.n_frames).max(1);
        (self.n_doubtful as f64 / due as f64).min(1.0)
    }
}
