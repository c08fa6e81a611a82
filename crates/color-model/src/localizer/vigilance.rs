use super::LocalizerParams;

/// Watches whether the robot still sees what it should see where it believes to be: a long-term and a short-term average of the fit, as in
/// augmented Monte Carlo localization [Thrun et al. 2005, Table 8.3].
///
/// Particles thrown over the field at random, as there, are too coarse for a likelihood as narrow as an image's. So doubt leads to a search
/// instead: after half as many frames as a search may look at, and, if that did not help, after twice as many, and so on.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Vigilance {
    averages: Option<(f64, f64)>,
    /// Frames since the doubt arose.
    n_doubtful: usize,
}

/// Share of its usual value below which a fit has fallen.
const FALLEN: f64 = 0.7;

/// Fit, as a multiple of the doubtful one, from which on nothing is doubted.
const SOUND: f64 = 2.0;

/// Share of its usual value from which on a fit is as usual.
const USUAL: f64 = 0.9;

/// Fit, as a multiple of the doubtful one, from which on it is good.
const WELL: f64 = 3.0;

impl Vigilance {
    pub(crate) fn observe(&mut self, fit: f64, params: &LocalizerParams) {
        let fit = fit.clamp(-1.0, 1.0);
        let (slow, fast) = self.averages.unwrap_or((fit, fit));
        let follow = |average: f64, rate: f64| average + rate * (fit - average);
        let (slow, fast) = (follow(slow, params.slow_rate), follow(fast, params.fast_rate));
        self.averages = Some((slow, fast));
        let is_doubtful = fast < FALLEN * slow || fast < params.doubtful_fit;
        self.n_doubtful = if is_doubtful { self.n_doubtful + 1 } else { 0 };
    }

    /// The short-term average.
    pub(crate) fn recent(&self) -> f64 {
        self.averages.map_or(1.0, |(_, fast)| fast)
    }

    /// Whether the doubt is as old as it has to be for a search.
    pub(crate) fn is_search_due(&self, params: &LocalizerParams) -> bool {
        let patience = patience(params);
        params.acquisition.n_frames > 0
            && self.n_doubtful.is_multiple_of(patience)
            && (self.n_doubtful / patience).is_power_of_two()
    }

    /// Whether there is doubt that is too young for a search: most of the last frames were seen before it.
    pub(crate) fn is_undecided(&self, params: &LocalizerParams) -> bool {
        (1..patience(params)).contains(&self.n_doubtful)
    }

    /// How many of the last frames tell where the robot is: those since the doubt arose and the one to come, or as many as there are.
    pub(crate) fn n_telling(&self) -> usize {
        if self.n_doubtful > 0 { self.n_doubtful + 1 } else { usize::MAX }
    }

    /// Whether what is seen leaves no doubt of the place, nor of the light that was learned there.
    pub(crate) fn is_sound(&self, params: &LocalizerParams) -> bool {
        self.n_doubtful == 0 && self.recent() >= SOUND * params.doubtful_fit
    }

    /// Whether what is seen fits as well as it usually does, and well.
    pub(crate) fn is_as_usual(&self, params: &LocalizerParams) -> bool {
        let is_usual = self.averages.is_some_and(|(slow, fast)| fast >= USUAL * slow);
        is_usual && self.recent() >= WELL * params.doubtful_fit
    }

    /// How far the doubt is from leading to a search, 0 to 1.
    pub(crate) fn suspicion(&self, params: &LocalizerParams) -> f64 {
        (self.n_doubtful as f64 / patience(params) as f64).min(1.0)
    }
}

/// Frames of doubt until the first search.
fn patience(params: &LocalizerParams) -> usize {
    params.acquisition.n_frames.div_ceil(2).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longer_a_doubt_lasts_the_rarer_the_searches_and_a_fit_as_usual_ends_it() {
        let params = LocalizerParams::default();
        let mut vigilance = Vigilance::default();
        (0..100).for_each(|_| vigilance.observe(0.4, &params));
        assert!(vigilance.is_sound(&params) && vigilance.n_telling() == usize::MAX);
        let mut searches = Vec::new();
        for frame in 1..=80 {
            vigilance.observe(0.02, &params);
            if vigilance.is_search_due(&params) {
                searches.push((frame, vigilance.n_telling()));
                assert_eq!(vigilance.suspicion(&params), 1.0);
            }
        }
        // The short-term average needs two frames of 0.02 to fall below 0.7 of 0.4; then come 8, 16, 32 and 64, and the frame that is looked for in.
        assert_eq!(searches, [(9, 9), (17, 17), (33, 33), (65, 65)]);
        (0..30).for_each(|_| vigilance.observe(0.4, &params));
        assert!(vigilance.is_sound(&params) && vigilance.suspicion(&params) == 0.0);
    }

    #[test]
    fn a_fit_that_leaves_no_doubt_may_still_be_worse_than_usual() {
        let params = LocalizerParams::default();
        let after = |fits: [f64; 2]| {
            let mut vigilance = Vigilance::default();
            (0..100).for_each(|_| vigilance.observe(fits[0], &params));
            (0..10).for_each(|_| vigilance.observe(fits[1], &params));
            (vigilance.is_sound(&params), vigilance.is_as_usual(&params))
        };
        assert_eq!(after([0.4, 0.4]), (true, true));
        assert_eq!(after([0.5, 0.4]), (true, false));
        assert_eq!(after([0.4, 0.5]), (true, true));
        // As always, and never good.
        assert_eq!(after([0.25, 0.25]), (true, false));
    }
}
