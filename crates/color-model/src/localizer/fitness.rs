use super::LocalizerParams;

/// Whether the robot sees what it used to see where it believes to be: long-term and short-term average of the fit, as in augmented Monte
/// Carlo localization [Thrun et al. 2005, Table 8.3], of the explained share in place of the likelihood, which images make incomparable.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fitness {
    averages: Option<(f64, f64)>,
    suspicion: f64,
}

impl Fitness {
    pub(crate) fn observe(&mut self, fit: f64, params: &LocalizerParams) {
        let fit = fit.clamp(0.0, 1.0);
        let (slow, fast) = self.averages.unwrap_or((fit, fit));
        let follow = |average: f64, rate: f64| average + rate * (fit - average);
        let (slow, fast) = (follow(slow, params.slow_rate), follow(fast, params.fast_rate));
        self.averages = Some((slow, fast));
        let fell = if slow > 0.0 { (1.0 - fast / slow).max(0.0) } else { 1.0 };
        let is_low = if params.lost_fit > 0.0 { 2.0 - 2.0 * fast / params.lost_fit } else { 0.0 };
        // A fit varies by a third from view to view, and newcomers cost a softened filter its place.
        self.suspicion = if fell < 0.4 { 0.0 } else { fell }.max(is_low.clamp(0.0, 1.0));
    }

    /// How far the short-term average fell below the long-term one, 0 to 1.
    pub(crate) fn suspicion(&self) -> f64 {
        self.suspicion
    }
}
